// Marks beside a model. What is accepted is finite, in range, and closed in itself; the model lacks nothing of it.
#include <cmath>

#include "fuzz_target.hpp"
#include "pirsim/io.hpp"

namespace {

/// A floor and two boxes without meshes of their own, which patterns may find.
constexpr const char* model = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}], "nodes": [
  {"name": "Slab", "extras": {"pirsim": {"type": "floor", "polygon_xz_m": [[0, 0], [4, 0], [4, -3], [0, -3]]}}},
  {"name": "front_glass", "children": [2], "mesh": 0}, {"name": "Radiator.001", "mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

void check(const pirsim::SceneSpec& scene) {
  for (const pirsim::TriMesh& mesh : scene.meshes) {
    for (const pirsim::Vec3& p : mesh.positions) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
    }
  }
  for (const pirsim::SensorSpec& sensor : scene.sensors) {
    if (!scene.sensor_models.contains(sensor.model)) std::abort();
    if (!std::isfinite(sensor.world_from_sensor.forward().x)) std::abort();
  }
  if (scene.floor.empty() || scene.files.size() < 2) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pirsim::test::read_as_file(data, size, ".yaml", [](const std::filesystem::path& file) {
    const std::filesystem::path scene = std::filesystem::path(file).replace_extension(".gltf");
    std::ofstream(scene, std::ios::binary | std::ios::trunc) << model;
    check(pirsim::io::read_scene(scene, {{}, {PIRSIM_DATA_DIR}, file}));
  });
}
