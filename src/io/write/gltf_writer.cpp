#include "io/write/gltf_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "io/write/gltf_builder.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

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

}  // namespace

void write_gltf(const std::filesystem::path& file, const ExportedRun& run) {
  document_of(run, Where{file.string()}).write(file, "run");
}

std::string to_glb(const ExportedRun& run) {
  const Where where{run.title};
  return document_of(run, where).bytes(GltfBuilder::Container::binary, where, "run");
}

}  // namespace pirsim::io
