#include "files/write/gltf_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <sstream>
#include <utility>

#include "files/disk/file.hpp"
#include "model/geom/shapes.hpp"
#include "model/schema/fields.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"

namespace pirsim::io {
namespace {

constexpr int no_target = 0;          ///< of arrays that aren't a mesh's
constexpr std::size_t alignment = 4;  ///< bytes; of every component type that is used

std::vector<float> flattened(const std::vector<Vec3>& values) {
  std::vector<float> flat;
  flat.reserve(3 * values.size());
  for (const Vec3& v : values) {
    for (int axis = 0; axis < 3; ++axis) flat.push_back(static_cast<float>(v[axis]));
  }
  return flat;
}

int index_of_last(std::size_t size) { return static_cast<int>(size) - 1; }

/// A mesh that reaches higher above the origin's plane is a wall or a ceiling and drawn so that one can look in.
constexpr double furniture_height_m = 1.8;
constexpr double wall_opacity = 0.25;
const Vec3 wall_colour(0.85);
const Vec3 furniture_colour(0.6, 0.55, 0.5), leaf_colour(0.55, 0.42, 0.28);

// Okabe and Ito's colours, which colour-blind readers can tell apart; sensors take them in turn.
const std::array<Vec3, 6> palette{Vec3(0.00, 0.45, 0.70), Vec3(0.90, 0.60, 0.00), Vec3(0.00, 0.62, 0.45),
                                  Vec3(0.80, 0.47, 0.65), Vec3(0.34, 0.71, 0.91), Vec3(0.84, 0.37, 0.00)};

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(const Frame& frame) {
  const double length = glm::length(frame.rotation);
  return finite(frame.origin) && std::isfinite(length) && length > 0.0;
}

void check_person(const ExportedPerson& person, std::size_t n_keys, const Where& where, Diagnostics& faults) {
  if (person.present.size() != n_keys) faults.error(where, "person '" + person.id + "' needs one presence a key time");
  for (const ExportedPart& part : person.parts) {
    const std::string name = "'" + person.id + "/" + part.part + "'";
    if (part.world_from_part.size() != n_keys) faults.error(where, name + " needs one pose a key time");
    if (!std::all_of(part.world_from_part.begin(), part.world_from_part.end(),
                     [](const Frame& f) { return finite(f); })) {
      faults.error(where, "a pose of " + name + " isn't finite");
    }
  }
}

void check_geometry(const ExportedRun& run, const Where& where, Diagnostics& faults) {
  for (const TriMesh& mesh : run.meshes) {
    if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const Vec3& p) { return finite(p); })) {
      faults.error(where, "a position of mesh '" + mesh.name + "' isn't finite");
    }
    const auto exists = [&](std::uint32_t index) { return index < mesh.positions.size(); };
    if (!std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const auto& triangle) { return std::all_of(triangle.begin(), triangle.end(), exists); })) {
      faults.error(where, "a triangle of mesh '" + mesh.name + "' names a vertex that doesn't exist");
    }
  }
  for (const ExportedBeams& beams : run.beams) {
    if (!std::all_of(beams.segments.begin(), beams.segments.end(),
                     [](const auto& segment) { return finite(segment.first) && finite(segment.second); })) {
      faults.error(where, "a beam of sensor '" + beams.sensor + "' isn't finite");
    }
  }
}

void check(const ExportedRun& run, const Where& where) {
  Diagnostics faults;
  const std::vector<double>& keys = run.key_times_s;
  if (!run.people.empty() && keys.empty()) faults.error(where, "people need at least one key time");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    // As stored: keys that single precision can't tell apart would not ascend.
    const bool ascending = i == 0 ? keys[i] >= 0.0 : static_cast<float>(keys[i]) > static_cast<float>(keys[i - 1]);
    if (!std::isfinite(keys[i]) || !ascending) {
      faults.error(where, "key times must ascend from 0 or later");
      break;
    }
  }
  for (const ExportedLeaf& leaf : run.leaves) {
    if (keys.empty() || leaf.world_from_leaf.size() != keys.size())
      faults.error(where, "door '" + leaf.door + "' needs one pose a key time");
  }
  for (const ExportedPerson& person : run.people) check_person(person, keys.size(), where, faults);
  check_geometry(run, where, faults);
  faults.throw_if_errors(ErrorCode::usage);
}

tinygltf::Node named(const std::string& name) {
  tinygltf::Node node;
  node.name = name;
  return node;
}

void add_room(GltfBuilder& document, const std::vector<TriMesh>& meshes) {
  int walls = -1;
  int furniture = -1;
  for (const TriMesh& mesh : meshes) {
    if (mesh.triangles.empty()) continue;
    const bool tall = std::any_of(mesh.positions.begin(), mesh.positions.end(),
                                  [](const Vec3& p) { return p.y > furniture_height_m; });
    int& material = tall ? walls : furniture;
    if (material < 0) {
      material = tall ? document.add_material("wall", wall_colour, wall_opacity)
                      : document.add_material("furniture", furniture_colour, 1.0);
    }
    tinygltf::Node node = named(mesh.name);
    node.mesh = document.add_mesh(mesh, material);
    document.add_node(std::move(node));
  }
}

struct DescribeShape {
  using Value = tinygltf::Value;
  Value::Object operator()(const Sphere& sphere) const {
    return {{"primitive", Value(std::string("sphere"))}, {"radius_m", Value(sphere.radius)}};
  }
  Value::Object operator()(const Capsule& capsule) const {
    return {{"primitive", Value(std::string("capsule"))},
            {"radius_m", Value(capsule.radius)},
            {"half_length_m", Value(capsule.half_length)}};
  }
  Value::Object operator()(const Box& box) const {
    const Vec3& h = box.half_extents;
    return {{"primitive", Value(std::string("box"))},
            {"half_extents_m", Value(Value::Array{Value(h.x), Value(h.y), Value(h.z)})}};
  }
  Value::Object operator()(const MeshSolid&) const { return {{"primitive", Value(std::string("mesh"))}}; }
};

int add_solid(GltfBuilder& document, const std::string& name, const Shape& shape, int material) {
  const SolidMesh solid = tessellated(shape);
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = document.add_positions(solid.positions);
  primitive.attributes["NORMAL"] = document.add_normals(solid.normals);
  primitive.indices = document.add_indices(solid.indices);
  primitive.material = material;
  return document.add_mesh(name, primitive);
}

/// Unit rotations, each on the same side of the sphere of quaternions as the one before: q and -q are the same
/// rotation, but viewers interpolate the numbers.
std::vector<Quat> continuous_rotations(const std::vector<Frame>& frames) {
  std::vector<Quat> rotations;
  for (const Frame& frame : frames) {
    const Quat rotation = glm::normalize(frame.rotation);
    const bool opposite = !rotations.empty() && glm::dot(rotations.back(), rotation) < 0.0;
    rotations.push_back(opposite ? -rotation : rotation);
  }
  return rotations;
}

/// frames: (n_keys) of the node.
void animate(GltfBuilder& document, int node, const std::vector<Frame>& frames, int key_times) {
  std::vector<Vec3> origins;
  for (const Frame& frame : frames) origins.push_back(frame.origin);
  document.animate(node, "translation", key_times, document.add_track(origins), "LINEAR");
  document.animate(node, "rotation", key_times, document.add_track(continuous_rotations(frames)), "LINEAR");
}

/// As it is at the first key.
void stand(tinygltf::Node& node, const Frame& frame) {
  const Quat rotation = glm::normalize(frame.rotation);
  node.translation = {frame.origin.x, frame.origin.y, frame.origin.z};
  node.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
}

void add_part(GltfBuilder& document, const ExportedPart& part, const std::string& person, int parent, int material,
              int key_times) {
  const std::string name = person + "/" + part.part;
  tinygltf::Value::Object about = std::visit(DescribeShape{}, part.shape);
  about["person"] = tinygltf::Value(person);
  about["part"] = tinygltf::Value(part.part);
  tinygltf::Node node = named(name);
  node.mesh = add_solid(document, name, part.shape, material);
  stand(node, part.world_from_part.front());
  node.extras = pirsim_extras("body_part", std::move(about));
  animate(document, document.add_node(std::move(node), parent), part.world_from_part, key_times);
}

void add_leaves(GltfBuilder& document, const ExportedRun& run) {
  if (run.leaves.empty()) return;
  const int key_times = document.add_key_times(run.key_times_s);
  const int material = document.add_material("leaf", leaf_colour, 1.0);
  for (const ExportedLeaf& leaf : run.leaves) {
    tinygltf::Node node = named(leaf.door);
    node.mesh = add_solid(document, leaf.door, leaf.shape, material);
    stand(node, leaf.world_from_leaf.front());
    node.extras = pirsim_extras("leaf", {{"door", tinygltf::Value(leaf.door)}});
    animate(document, document.add_node(std::move(node)), leaf.world_from_leaf, key_times);
  }
}

void add_people(GltfBuilder& document, const ExportedRun& run) {
  if (run.people.empty()) return;
  const int key_times = document.add_key_times(run.key_times_s);
  for (std::size_t i = 0; i < run.people.size(); ++i) {
    const ExportedPerson& person = run.people[i];
    std::vector<Vec3> scales;
    for (const std::uint8_t present : person.present) scales.emplace_back(present != 0 ? 1.0 : 0.0);
    tinygltf::Node node = named(person.id);
    node.scale = {scales.front().x, scales.front().y, scales.front().z};
    node.extras = pirsim_extras("person", {{"id", tinygltf::Value(person.id)}});
    const int index = document.add_node(std::move(node));
    document.animate(index, "scale", key_times, document.add_track(scales), "STEP");
    if (person.parts.empty()) continue;
    const int material = document.add_material(person.id, person_colour(person.number), 1.0);
    for (const ExportedPart& part : person.parts) add_part(document, part, person.id, index, material, key_times);
  }
}

void add_beams(GltfBuilder& document, const std::vector<ExportedBeams>& all_beams) {
  for (std::size_t i = 0; i < all_beams.size(); ++i) {
    const ExportedBeams& beams = all_beams[i];
    if (beams.segments.empty()) continue;
    std::vector<Vec3> ends;
    for (const auto& [from, to] : beams.segments) ends.insert(ends.end(), {from, to});
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_LINE;
    primitive.attributes["POSITION"] = document.add_positions(ends);
    primitive.material = document.add_material(beams.sensor, palette[i % palette.size()], 1.0);
    const std::string name = beams.sensor + "/beams";
    tinygltf::Node node = named(name);
    node.mesh = document.add_mesh(name, primitive);
    node.extras = pirsim_extras("beams", {{"sensor", tinygltf::Value(beams.sensor)}});
    document.add_node(std::move(node));
  }
}

GltfBuilder document_of(const ExportedRun& run, const Where& where) {
  check(run, where);
  GltfBuilder document(run.title.empty() ? "run" : run.title);
  add_room(document, run.meshes);
  add_leaves(document, run);
  add_people(document, run);
  add_beams(document, run.beams);
  return document;
}

constexpr std::uint32_t sectors = 24;       ///< round the axis
constexpr std::uint32_t quarter_rings = 6;  ///< from a pole to the equator

/// A circle of vertices about the Y axis.
struct Ring {
  double polar;   ///< angle of its normals from +Y
  double offset;  ///< of the centre of its cap along Y
};

std::vector<Ring> rings_of(double half_length) {
  std::vector<Ring> rings;
  const double step = 0.5 * std::numbers::pi / quarter_rings;
  for (std::uint32_t i = 1; i <= quarter_rings; ++i) rings.push_back({i * step, half_length});
  // The equator is there twice if a cylinder lies between.
  for (std::uint32_t i = half_length > 0.0 ? 0 : 1; i < quarter_rings; ++i) {
    rings.push_back({0.5 * std::numbers::pi + i * step, -half_length});
  }
  return rings;
}

void add_vertex(SolidMesh& mesh, double radius, double offset, const Vec3& normal) {
  mesh.positions.push_back(radius * normal + Vec3(0.0, offset, 0.0));
  mesh.normals.push_back(normal);
}

/// A capsule along Y, or with half_length 0 a sphere.
SolidMesh round_solid(double radius, double half_length) {
  SolidMesh mesh;
  const std::vector<Ring> rings = rings_of(half_length);
  for (const Ring& ring : rings) {
    for (std::uint32_t i = 0; i < sectors; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / sectors;
      const double across = std::sin(ring.polar);
      add_vertex(mesh, radius, ring.offset,
                 {across * std::sin(azimuth), std::cos(ring.polar), across * std::cos(azimuth)});
    }
  }
  const auto top = static_cast<std::uint32_t>(mesh.positions.size());
  add_vertex(mesh, radius, half_length, {0.0, 1.0, 0.0});
  add_vertex(mesh, radius, -half_length, {0.0, -1.0, 0.0});
  const auto last_ring = static_cast<std::uint32_t>(rings.size() - 1) * sectors;
  for (std::uint32_t i = 0; i < sectors; ++i) {
    const std::uint32_t next = (i + 1) % sectors;
    mesh.indices.insert(mesh.indices.end(), {top, i, next});
    for (std::uint32_t ring = 0; ring < last_ring; ring += sectors) {
      const std::uint32_t below = ring + sectors;
      mesh.indices.insert(mesh.indices.end(), {ring + i, below + i, below + next, ring + i, below + next, ring + next});
    }
    mesh.indices.insert(mesh.indices.end(), {top + 1, last_ring + next, last_ring + i});
  }
  return mesh;
}

SolidMesh box(const Vec3& half_extents) {
  SolidMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 normal(0.0);
      Vec3 across(0.0);
      Vec3 along(0.0);
      normal[axis] = side;
      across[(axis + 1) % 3] = 1.0;
      along[(axis + 2) % 3] = side;  // so that normal = across x along
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const Vec3& corner : {-across - along, across - along, across + along, along - across}) {
        mesh.positions.push_back(half_extents * (normal + corner));
        mesh.normals.push_back(normal);
      }
      mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
  }
  return mesh;
}

/// The triangles as they are, each with corners of its own.
SolidMesh flat_shaded(const TriMesh& given) {
  SolidMesh mesh;
  for (const auto& [a, b, c] : given.triangles) {
    const std::array<Vec3, 3> corners{given.positions[a], given.positions[b], given.positions[c]};
    const Vec3 facing = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double length = glm::length(facing);
    if (length == 0.0) continue;
    for (const Vec3& corner : corners) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corner);
      mesh.normals.push_back(facing / length);
    }
  }
  return mesh;
}

struct Tessellation {
  SolidMesh operator()(const Sphere& sphere) const { return round_solid(sphere.radius, 0.0); }
  SolidMesh operator()(const Capsule& capsule) const { return round_solid(capsule.radius, capsule.half_length); }
  SolidMesh operator()(const Box& solid) const { return box(solid.half_extents); }
  SolidMesh operator()(const MeshSolid& solid) const { return flat_shaded(solid.surface->mesh()); }
};

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
  for (const SensorSpec& array : scene.arrays) add_mark(document, "sensor", array, array.world_from_sensor);
  for (const SeatSpec& seat : scene.seats) add_mark(document, "seat", seat, seat.world_from_seat);
  for (const PlaceSpec& place : scene.places) add_mark(document, "place", place, place.world_from_place);
  return document;
}

}  // namespace

GltfBuilder::GltfBuilder(const std::string& title) {
  model_.asset.version = "2.0";
  model_.asset.generator = "pirsim";
  model_.defaultScene = 0;
  model_.scenes.emplace_back().name = title;
}

int GltfBuilder::add_positions(const std::vector<Vec3>& positions) {
  return add_floats(flattened(positions), TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
}

int GltfBuilder::add_normals(const std::vector<Vec3>& normals) { return add_positions(normals); }

int GltfBuilder::add_indices(const std::vector<std::uint32_t>& indices) {
  tinygltf::Accessor accessor{};
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.type = TINYGLTF_TYPE_SCALAR;
  accessor.count = indices.size();
  return add_accessor(indices.data(), indices.size() * sizeof(std::uint32_t), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                      std::move(accessor));
}

int GltfBuilder::add_key_times(const std::vector<double>& seconds) {
  return add_floats({seconds.begin(), seconds.end()}, TINYGLTF_TYPE_SCALAR, no_target);
}

int GltfBuilder::add_track(const std::vector<Vec3>& values) {
  return add_floats(flattened(values), TINYGLTF_TYPE_VEC3, no_target);
}

int GltfBuilder::add_track(const std::vector<Quat>& values) {
  std::vector<float> flat;
  flat.reserve(4 * values.size());
  for (const Quat& q : values) {
    for (const double component : {q.x, q.y, q.z, q.w}) flat.push_back(static_cast<float>(component));
  }
  return add_floats(flat, TINYGLTF_TYPE_VEC4, no_target);
}

int GltfBuilder::add_floats(const std::vector<float>& values, int type, int target) {
  const auto width = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  tinygltf::Accessor accessor{};
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.type = type;
  accessor.count = values.size() / width;
  for (std::size_t component = 0; component < width; ++component) {
    float least = values[component];
    float most = least;
    for (std::size_t i = component; i < values.size(); i += width) {
      least = std::min(least, values[i]);
      most = std::max(most, values[i]);
    }
    accessor.minValues.push_back(static_cast<double>(least));
    accessor.maxValues.push_back(static_cast<double>(most));
  }
  return add_accessor(values.data(), values.size() * sizeof(float), target, std::move(accessor));
}

int GltfBuilder::add_accessor(const void* data, std::size_t bytes, int target, tinygltf::Accessor accessor) {
  if (model_.buffers.empty()) model_.buffers.emplace_back();
  std::vector<unsigned char>& buffer = model_.buffers.front().data;
  static_assert(sizeof(float) == alignment && sizeof(std::uint32_t) == alignment);
  tinygltf::BufferView& view = model_.bufferViews.emplace_back();
  view.buffer = 0;
  view.byteOffset = buffer.size();
  view.byteLength = bytes;
  view.target = target;
  const auto* begin = static_cast<const unsigned char*>(data);
  buffer.insert(buffer.end(), begin, begin + bytes);
  accessor.bufferView = index_of_last(model_.bufferViews.size());
  model_.accessors.push_back(std::move(accessor));
  return index_of_last(model_.accessors.size());
}

int GltfBuilder::add_material(const std::string& name, const Vec3& colour, double opacity) {
  tinygltf::Material& material = model_.materials.emplace_back();
  material.name = name;
  material.pbrMetallicRoughness.baseColorFactor = {colour.x, colour.y, colour.z, opacity};
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.pbrMetallicRoughness.roughnessFactor = 0.9;
  material.alphaMode = opacity < 1.0 ? "BLEND" : "OPAQUE";
  material.doubleSided = true;
  return index_of_last(model_.materials.size());
}

int GltfBuilder::add_mesh(const std::string& name, const tinygltf::Primitive& primitive) {
  tinygltf::Mesh& mesh = model_.meshes.emplace_back();
  mesh.name = name;
  mesh.primitives.push_back(primitive);
  return index_of_last(model_.meshes.size());
}

int GltfBuilder::add_mesh(const TriMesh& mesh, int material) {
  std::vector<std::uint32_t> indices;
  for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = add_positions(mesh.positions);
  primitive.indices = add_indices(indices);
  primitive.material = material;
  return add_mesh(mesh.name, primitive);
}

int GltfBuilder::add_node(tinygltf::Node node, int parent) {
  model_.nodes.push_back(std::move(node));
  const int index = index_of_last(model_.nodes.size());
  auto& siblings = parent < 0 ? model_.scenes.front().nodes : model_.nodes[static_cast<std::size_t>(parent)].children;
  siblings.push_back(index);
  return index;
}

void GltfBuilder::animate(int node, const std::string& path, int key_times, int track,
                          const std::string& interpolation) {
  if (model_.animations.empty()) model_.animations.emplace_back().name = model_.scenes.front().name;
  tinygltf::Animation& animation = model_.animations.front();
  tinygltf::AnimationSampler& sampler = animation.samplers.emplace_back();
  sampler.input = key_times;
  sampler.output = track;
  sampler.interpolation = interpolation;
  tinygltf::AnimationChannel& channel = animation.channels.emplace_back();
  channel.sampler = index_of_last(animation.samplers.size());
  channel.target_node = node;
  channel.target_path = path;
}

std::string GltfBuilder::bytes(Container container, const Where& where, const std::string& what) const {
  std::ostringstream out;
  const bool binary = container == Container::binary;
  try {
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, out, !binary, binary);
  } catch (const std::exception& fault) {  // the JSON writer refuses names that aren't UTF-8
    throw Error(ErrorCode::usage, where, "the " + what + " can't be written as glTF: " + fault.what());
  }
  return std::move(out).str();
}

void GltfBuilder::write(const std::filesystem::path& file, const std::string& what) const {
  const Container container = file.extension() == ".glb" ? Container::binary : Container::text;
  write_text_file(file, bytes(container, Where{file.string()}, what));
}

tinygltf::Value pirsim_extras(const std::string& type, tinygltf::Value::Object members) {
  members["type"] = tinygltf::Value(type);
  return tinygltf::Value(tinygltf::Value::Object{{"pirsim", tinygltf::Value(std::move(members))}});
}

void write_gltf(const std::filesystem::path& file, const ExportedRun& run) {
  document_of(run, Where{file.string()}).write(file, "run");
}

std::string to_glb(const ExportedRun& run) {
  const Where where{run.title};
  return document_of(run, where).bytes(GltfBuilder::Container::binary, where, "run");
}

SolidMesh tessellated(const Shape& shape) { return std::visit(Tessellation{}, shape); }

std::string scene_text(const SceneSpec& scene, const Where& where) {
  return document_of(scene, where).bytes(GltfBuilder::Container::text, where, "scene");
}

void write_scene(const std::filesystem::path& file, const SceneSpec& scene) {
  document_of(scene, Where{file.string()}).write(file, "scene");
}

}  // namespace pirsim::io
