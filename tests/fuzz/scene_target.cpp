// Rooms: glTF as JSON and as .glb, with markup. What is accepted is finite, in range, and closed in itself. Of any
// model marks may be proposed.
#include <cmath>

#include "fuzz_target.hpp"
#include "pirsim/io.hpp"
#include "rooms/suggested_marks.hpp"

namespace {

void check(const pirsim::SceneSpec& scene) {
  for (const pirsim::TriMesh& mesh : scene.meshes) {
    for (const pirsim::Vec3& p : mesh.positions) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
    }
    for (const auto& triangle : mesh.triangles) {
      for (int corner = 0; corner < 3; ++corner) {
        if (triangle[corner] >= mesh.positions.size()) std::abort();
      }
    }
  }
  for (const pirsim::SensorSpec& sensor : scene.sensors) {
    if (!scene.sensor_models.contains(sensor.model)) std::abort();
  }
  if (scene.floor.empty()) std::abort();
}

void propose(const std::filesystem::path& file) {
  try {
    const auto proposed = pirsim::studies::suggest(pirsim::io::read_model_parts(file), {}, "model");
    if (proposed.floors.empty() || pirsim::studies::to_yaml(proposed, "model").empty()) std::abort();
  } catch (const pirsim::Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pirsim::test::read_as_file(data, size, ".gltf", [](const std::filesystem::path& file) {
    propose(file);
    check(pirsim::io::read_scene(file, {{}, {PIRSIM_DATA_DIR}, {}}));
  });
}
