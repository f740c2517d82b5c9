#include "io/write/scene_writer.hpp"

#include <algorithm>
#include <array>

#include "io/write/gltf_builder.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "schema/fields.hpp"

namespace pirsim::io {
namespace {

using Value = tinygltf::Value;

tinygltf::Node placed_node(const std::string& name, const Frame& frame, Value mark) {
  tinygltf::Node node;
  node.name = name;
  const Vec3& p = frame.origin;
  const Quat& q = frame.rotation;
  node.translation = {p.x, p.y, p.z};
  if (q != Quat(1.0, 0.0, 0.0, 0.0)) node.rotation = {q.x, q.y, q.z, q.w};
  node.extras = std::move(mark);
  return node;
}

/// Materials by what a mesh seems to be, made when first used; looks only.
class Materials {
 public:
  explicit Materials(GltfBuilder& document) : document_(document) {}
  int of(const TriMesh& mesh, double floor_y) {
    const auto reaches = [&](double height) {
      return std::ranges::any_of(mesh.positions, [&](const Vec3& p) { return p.y > floor_y + height; });
    };
    constexpr double ground_m = 0.05, furniture_m = 2.05;
    if (!reaches(ground_m)) return once(0, "floor", {0.45, 0.47, 0.50}, 1.0);
    if (reaches(furniture_m)) return once(1, "wall", {0.90, 0.90, 0.88}, 0.25);
    return once(2, "furniture", {0.65, 0.48, 0.32}, 1.0);
  }

 private:
  int once(std::size_t which, const std::string& name, const Vec3& colour, double opacity) {
    if (known_[which] < 0) known_[which] = document_.add_material(name, colour, opacity);
    return known_[which];
  }
  GltfBuilder& document_;
  std::array<int, 3> known_{-1, -1, -1};
};

void add_outline(GltfBuilder& document, const std::string& name, const std::string& type, const FloorArea& outline,
                 Value::Object mark, const Where& where) {
  if (outline.loops().size() != 1) {
    throw Error(
        ErrorCode::usage, where,
        "only " + std::string(type == "area" ? "an area" : "a floor") + " of one polygon without holes can be written");
  }
  Value::Array corners;
  for (const Vec2& p : outline.loops().front()) corners.emplace_back(Value::Array{Value(p.x), Value(p.y)});
  mark.emplace("polygon_xz_m", Value(std::move(corners)));
  document.add_node(
      placed_node(name, {Quat(1, 0, 0, 0), Vec3(0.0, outline.height_m(), 0.0)}, pirsim_extras(type, std::move(mark))));
}

void add_mesh(GltfBuilder& document, const TriMesh& mesh, int material) {
  tinygltf::Node node;
  node.name = mesh.name;
  node.mesh = document.add_mesh(mesh, material);
  if (mesh.temperature_c) node.extras = pirsim_extras("surface", {{"temperature_c", Value(*mesh.temperature_c)}});
  document.add_node(std::move(node));
}

/// A node with the names and numbers of what is there.
template <typename Spec>
void add_mark(GltfBuilder& document, const char* type, const Spec& spec, const Frame& frame) {
  Value::Object members;
  each_field<Spec>([&](const auto& field) {
    using FieldValue = std::remove_cvref_t<decltype(spec.*field.member)>;
    if constexpr (std::same_as<FieldValue, std::optional<std::string>>) {
      if (spec.*field.member) members[field.name] = Value(*(spec.*field.member));
    } else if constexpr (std::same_as<FieldValue, std::vector<std::string>>) {
      Value::Array words(spec.uses.begin(), spec.uses.end());
      if (!words.empty()) members["for"] = Value(std::move(words));
    } else if constexpr (Worded<FieldValue>) {
      members[field.name] = Value(std::string(word_of(spec.*field.member)));
    } else if constexpr (!std::same_as<FieldValue, Frame>) {
      members[field.name] = Value(spec.*field.member);
    }
  });
  if constexpr (std::same_as<Spec, SensorSpec>) {
    if (spec.gain == SensorSpec{}.gain) members.erase("gain");  // hardly a sensor has another
  }
  document.add_node(placed_node(spec.id, frame, pirsim_extras(type, std::move(members))));
}

GltfBuilder document_of(const SceneSpec& scene, const Where& where) {
  GltfBuilder document(scene.name);
  Materials materials(document);
  add_outline(document, "floor area", "floor", scene.floor, {}, where);
  for (const AreaSpec& area : scene.areas)
    add_outline(document, area.id, "area", area.outline, {{"id", Value(area.id)}}, where);
  for (const TriMesh& mesh : scene.meshes) add_mesh(document, mesh, materials.of(mesh, scene.floor.height_m()));
  for (const EntranceSpec& door : scene.entrances) add_mark(document, "entrance", door, door.world_from_entrance);
  for (const DoorSpec& door : scene.doors) add_mark(document, "door", door, door.world_from_door);
  for (const SensorSpec& sensor : scene.sensors) add_mark(document, "sensor", sensor, sensor.world_from_sensor);
  for (const SeatSpec& seat : scene.seats) add_mark(document, "seat", seat, seat.world_from_seat);
  for (const PlaceSpec& place : scene.places) add_mark(document, "place", place, place.world_from_place);
  return document;
}

}  // namespace

std::string scene_text(const SceneSpec& scene, const Where& where) {
  return document_of(scene, where).bytes(GltfBuilder::Container::text, where, "scene");
}

void write_scene(const std::filesystem::path& file, const SceneSpec& scene) {
  document_of(scene, Where{file.string()}).write(file, "scene");
}

}  // namespace pirsim::io
