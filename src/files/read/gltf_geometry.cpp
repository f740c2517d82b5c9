#include "files/read/gltf_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "files/read/reader_parts.hpp"
#include "model/core/text.hpp"
#include "model/geom/shapes.hpp"
#include "model/schema/checks.hpp"
#include "model/schema/fields.hpp"

namespace pirsim::io::detail {
namespace {

/// Corners of triangle t in a list, strip or fan; strips turn every second triangle (glTF 2.0 section 3.7.2.1).
std::array<std::size_t, 3> corners(int mode, std::size_t t) {
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {t, t + 1 + t % 2, t + 2 - t % 2};
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {t + 1, t + 2, 0};
  return {3 * t, 3 * t + 1, 3 * t + 2};
}

class MeshReader {
 public:
  MeshReader(const GltfDocument& document, int mesh, std::span<const std::optional<double>> temperatures_c,
             GeometryBudget& budget, Diagnostics& faults, GroupedWarnings& warnings)
      : document_(document),
        mesh_(mesh),
        temperatures_c_(temperatures_c),
        budget_(budget),
        faults_(faults),
        warnings_(warnings),
        accessors_(document, faults),
        name_(mesh_label(document.model, mesh)) {}

  std::vector<TriMesh> read() {
    const tinygltf::Mesh& given = document_.model.meshes[static_cast<std::size_t>(mesh_)];
    for (std::size_t i = 0; i < given.primitives.size(); ++i) {
      const std::string pointer = "/meshes/" + std::to_string(mesh_) + "/primitives/" + std::to_string(i);
      add_primitive(given.primitives[i], pointer);
    }
    return std::move(parts_);
  }

 private:
  void add_primitive(const tinygltf::Primitive& primitive, const std::string& pointer) {
    if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) return error(pointer + "/mode", "unknown primitive mode");
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) return warn(pointer, "points and lines don't occlude; left out");
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) return warn(pointer, "a primitive without POSITION; left out");
    if (!primitive.targets.empty()) warn(pointer, "morph targets are left at rest");

    const std::size_t n_vertices = accessors_.count(position->second);
    const std::size_t n_indices = primitive.indices >= 0 ? accessors_.count(primitive.indices) : n_vertices;
    const std::size_t n_triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ? n_indices / 3 : n_indices;  // or less
    if (!budget_.take(n_vertices + n_triangles)) {
      const int larger = primitive.indices >= 0 && n_indices > n_vertices ? primitive.indices : position->second;
      const std::string place = "/accessors/" + std::to_string(larger) + "/count";
      return error(place,
                   "the scene has too many vertices: " + std::to_string(std::max(n_vertices, n_indices)) + " here");
    }
    const std::vector<Vec3> vertices = accessors_.positions(position->second);
    if (vertices.empty()) return;  // told already
    std::vector<std::uint32_t> indices;
    if (primitive.indices >= 0) {
      indices = accessors_.indices(primitive.indices);
      if (indices.empty() || !all_below(indices, n_vertices, primitive.indices)) return;
    }
    add_triangles(primitive, pointer, vertices, indices);
  }

  bool all_below(const std::vector<std::uint32_t>& indices, std::size_t n_vertices, int accessor) {
    const auto bad = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= n_vertices; });
    if (bad == indices.end()) return true;
    error("/accessors/" + std::to_string(accessor), "index " + std::to_string(*bad) +
                                                        " is out of range: the primitive has " +
                                                        std::to_string(n_vertices) + " vertices");
    return false;
  }

  void add_triangles(const tinygltf::Primitive& primitive, const std::string& pointer,
                     const std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& indices) {
    const std::size_t n_corners = primitive.indices >= 0 ? indices.size() : vertices.size();
    const bool is_list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    if (n_corners < 3 || (is_list && n_corners % 3 != 0)) {
      return error(pointer, std::to_string(n_corners) + " corners don't make whole triangles");
    }
    TriMesh& part = part_of(primitive);
    const auto base = static_cast<std::uint32_t>(part.positions.size());
    part.positions.insert(part.positions.end(), vertices.begin(), vertices.end());
    const std::size_t n_triangles = is_list ? n_corners / 3 : n_corners - 2;
    for (std::size_t t = 0; t < n_triangles; ++t) {
      auto& triangle = part.triangles.emplace_back();
      const auto corner = corners(primitive.mode, t);
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = base + (primitive.indices >= 0 ? indices[corner[k]] : static_cast<std::uint32_t>(corner[k]));
      }
    }
  }

  TriMesh& part_of(const tinygltf::Primitive& primitive) {
    const auto material = static_cast<std::size_t>(primitive.material);  // -1, for none, becomes the largest
    const auto temperature_c = material < temperatures_c_.size() ? temperatures_c_[material] : std::nullopt;
    const auto known = std::find_if(parts_.begin(), parts_.end(),
                                    [&](const TriMesh& part) { return part.temperature_c == temperature_c; });
    if (known != parts_.end()) return *known;
    TriMesh& part = parts_.emplace_back();
    part.name = name_;
    part.temperature_c = temperature_c;
    return part;
  }

  void error(const std::string& pointer, const std::string& message) {
    faults_.error(document_.text.where(pointer), name_ + ": " + message);
  }
  void warn(const std::string& pointer, const std::string& message) {
    warnings_.add(message, document_.text.where(pointer), name_, name_ + ": " + message);
  }

  const GltfDocument& document_;
  int mesh_;
  std::span<const std::optional<double>> temperatures_c_;
  GeometryBudget& budget_;
  Diagnostics& faults_;
  GroupedWarnings& warnings_;
  AccessorReader accessors_;
  std::string name_;
  std::vector<TriMesh> parts_;
};

/// 0 for anything that glTF doesn't know.
std::size_t component_size(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

template <typename T>
double load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // glTF is little-endian, as are all machines that Embree runs on
  return static_cast<double>(value);
}

double load_component(const unsigned char* bytes, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load<std::int8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load<std::int16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(bytes);
    default:
      return load<float>(bytes);
  }
}

/// glTF 2.0 section 3.6.2.2: f = c / largest, for signed types no less than -1.
double normalised(double c, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return std::max(c / 127.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return c / 255.0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return std::max(c / 32767.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return c / 65535.0;
    default:
      return c;
  }
}

std::string accessor_pointer(int accessor) { return "/accessors/" + std::to_string(accessor); }

constexpr double smallest_scale = 1e-9;  // assumed: a scale below turns a kilometre into a micrometre

std::string node_pointer(int node) { return "/nodes/" + std::to_string(node); }

class Placement {
 public:
  Placement(const GltfDocument& document, Diagnostics& remarks, Reach reach)
      : document_(document), remarks_(remarks), reach_(reach), seen_(document.model.nodes.size(), false) {}

  PlacedNodes run(const glm::dmat4& world_from_file) {
    origin_ = -Vec3(world_from_file[3]);
    const tinygltf::Model& model = document_.model;
    if (model.scenes.empty()) {
      remarks_.error(document_.text.where(""), "the file has no 'scenes'");
      return {};
    }
    const int scene = std::max(model.defaultScene, 0);
    const std::string pointer = "/scenes/" + std::to_string(scene) + "/nodes";
    pending_.clear();
    push(model.scenes[static_cast<std::size_t>(scene)].nodes, world_from_file, pointer);
    while (!pending_.empty() && n_faults_ < max_faults) {
      const Pending next = std::move(pending_.back());
      pending_.pop_back();
      visit(next);
    }
    return std::move(placed_);
  }

 private:
  struct Pending {
    int node;
    glm::dmat4 world_from_parent;
    std::string pointer;  ///< where the node is listed
  };

  /// A stack rather than recursion: chains of nodes may be as long as the file allows.
  void push(const std::vector<int>& nodes, const glm::dmat4& world_from_parent, const std::string& pointer) {
    for (std::size_t i = nodes.size(); i-- > 0;) {
      pending_.push_back({nodes[i], world_from_parent, pointer + '/' + std::to_string(i)});
    }
  }

  /// False, and a fault, for a node that was met before.
  bool see(const Pending& pending) {
    const auto index = static_cast<std::size_t>(pending.node);
    if (!seen_[index]) return seen_[index] = true;
    ++n_faults_;
    remarks_.error(document_.text.where(pending.pointer),
                   node_label(document_.model, pending.node) + " is its own ancestor or has two parents");
    return false;
  }

  /// What is below a hidden node is hidden with it, wherever it is.
  void hide(int node) {
    HiddenNode& hidden = placed_.hidden.emplace_back(HiddenNode{node});
    const std::size_t others = pending_.size();
    const auto push_children = [&](int parent) {
      push(document_.model.nodes[static_cast<std::size_t>(parent)].children, {}, node_pointer(parent) + "/children");
    };
    push_children(node);
    while (pending_.size() > others) {
      const Pending next = std::move(pending_.back());
      pending_.pop_back();
      if (!see(next)) continue;
      hidden.below.push_back(next.node);
      push_children(next.node);
    }
  }

  void visit(const Pending& pending) {
    const auto index = static_cast<std::size_t>(pending.node);
    const tinygltf::Node& node = document_.model.nodes[index];
    if (!see(pending)) return;
    const glm::dmat4 world_from_node = pending.world_from_parent * local(node, pending.node);
    if (is_hidden(pending.node) || is_nothing(world_from_node)) return hide(pending.node);
    if (!sane(world_from_node, pending.node)) return;
    placed_.shown.push_back({pending.node, world_from_node});
    push(node.children, world_from_node, node_pointer(pending.node) + "/children");
  }

  /// Has it a mesh or a mark?
  [[nodiscard]] bool is_something(int node) const {
    const nlohmann::json& given = document_.text.root()["nodes"][static_cast<std::size_t>(node)];
    const auto extras = given.find("extras");
    return given.contains("mesh") || (extras != given.end() && extras->is_object() && extras->contains("pirsim"));
  }
  [[nodiscard]] bool is_hidden(int node) const {
    const nlohmann::json& given = document_.text.root()["nodes"][static_cast<std::size_t>(node)];
    const auto extensions = given.find("extensions");
    if (extensions == given.end()) return false;
    const auto visibility = extensions->find(visibility_extension);
    return visibility != extensions->end() && visibility->value("visible", true) == false;
  }
  /// "When the scale is zero on all three axes", glTF 2.0 lets programs leave out the node and all below it.
  [[nodiscard]] static bool is_nothing(const glm::dmat4& m) {
    return glm::length(Vec3(m[0])) + glm::length(Vec3(m[1])) + glm::length(Vec3(m[2])) < smallest_scale;
  }

  glm::dmat4 local(const tinygltf::Node& node, int index) {
    glm::dmat4 result(1.0);
    if (!node.matrix.empty()) {
      const auto& given = document_.text.root()["nodes"][static_cast<std::size_t>(index)];
      for (const char* other : {"translation", "rotation", "scale"}) {
        if (given.contains(other))
          fault(index, std::string("/") + other, std::string("it has both 'matrix' and '") + other + "'");
      }
      for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
      const bool affine = result[0][3] == 0.0 && result[1][3] == 0.0 && result[2][3] == 0.0 && result[3][3] == 1.0;
      if (!affine) fault(index, "/matrix", "its matrix is not affine: the last row must be 0 0 0 1");
      return result;
    }
    const auto& t = node.translation;
    const auto& r = node.rotation;
    const auto& s = node.scale;
    if (!t.empty()) result = glm::translate(result, Vec3(t[0], t[1], t[2]));
    if (!r.empty()) {
      const Quat rotation(r[3], r[0], r[1], r[2]);
      // assumed: exporters round to 6 digits or more; what is farther off is no rotation
      if (std::abs(glm::length(rotation) - 1.0) > 1e-3)
        fault(index, "/rotation", "its rotation is not a unit quaternion");
      result *= glm::mat4_cast(glm::normalize(rotation));
    }
    if (!s.empty()) result = glm::scale(result, Vec3(s[0], s[1], s[2]));
    return result;
  }

  bool sane(const glm::dmat4& m, int node) {
    const auto finite = [](const glm::dvec4& v) { return std::isfinite(v.x + v.y + v.z + v.w); };
    if (!finite(m[0]) || !finite(m[1]) || !finite(m[2]) || !finite(m[3])) {
      return fault(node, "", "its transform is not finite");
    }
    if (reach_ == Reach::world && is_something(node) && !is_in_world(Vec3(m[3]))) {
      const auto limit_m = static_cast<int>(accepted::in_world_m.max);
      return fault(
          node, "/translation",
          "it lies more than " + std::to_string(limit_m) + " m from the origin" + brought_here(origin_ + Vec3(m[3])));
    }
    // Volume of the unit axes, so that small models (in millimetres, say) are no worse than large ones.
    const Vec3 x(m[0]), y(m[1]), z(m[2]);
    const double lengths = glm::length(x) * glm::length(y) * glm::length(z);
    const double shortest = std::min({glm::length(x), glm::length(y), glm::length(z)});
    if (shortest < smallest_scale || std::abs(glm::dot(glm::cross(x, y), z)) < 1e-9 * lengths) {
      const auto& given = document_.model.nodes[static_cast<std::size_t>(node)];
      return fault(node, given.matrix.empty() ? "/scale" : "/matrix",
                   "its transform is singular: a scale of zero along one axis makes it flat");
    }
    return true;
  }

  bool fault(int node, const std::string& member, const std::string& message) {
    ++n_faults_;
    remarks_.error(document_.text.where(node_pointer(node) + member),
                   node_label(document_.model, node) + ": " + message);
    return false;
  }

  const GltfDocument& document_;
  Diagnostics& remarks_;
  Reach reach_;
  Vec3 origin_{0.0};  ///< what is taken away from all places
  std::vector<bool> seen_;
  std::vector<Pending> pending_;
  PlacedNodes placed_;
  std::size_t n_faults_ = 0;
};

/// What is left of a node's transform within its own frame: scale and mirroring.
glm::dmat4 scale_of(const glm::dmat4& world_from_node) {
  const Frame node_from_world = inverse(rigid_frame(world_from_node));
  return glm::translate(glm::dmat4(1.0), node_from_world.origin) * glm::mat4_cast(node_from_world.rotation) *
         world_from_node;
}

class BodyBuilder {
 public:
  BodyBuilder(const std::filesystem::path& file, Diagnostics& faults)
      : faults_(faults), document_(load_gltf(file, faults)) {}

  [[nodiscard]] const std::vector<InputFile>& files() const noexcept { return document_.files; }
  BodyMeshes build() {
    const PlacedNodes nodes = place_nodes(document_, faults_);
    for (const PlacedNode& placed : nodes.shown) {
      if (document_.model.nodes[static_cast<std::size_t>(placed.node)].mesh >= 0) add_part(placed);
    }
    for (const HiddenNode& hidden : nodes.hidden) error(hidden.node, "", "it is hidden, and a body's parts can't be");
    warnings_.tell(faults_);
    if (meshes_.empty() && !faults_.has_errors()) faults_.error(document_.text.where(""), "no node has a mesh");
    return std::move(meshes_);
  }

 private:
  void add_part(const PlacedNode& placed) {
    const auto& node = document_.model.nodes[static_cast<std::size_t>(placed.node)];
    const std::string name_fault = body_part_fault(node.name);
    if (!name_fault.empty()) return error(placed.node, node.name.empty() ? "" : "/name", name_fault);
    if (meshes_.contains(node.name)) return error(placed.node, "/name", "a second mesh for this part");
    const TriMesh local = read_mesh(document_, node.mesh, budget_, faults_, warnings_);
    TriMesh part = clean(transformed(local, scale_of(placed.world_from_node), node.name)).mesh;
    if (part.triangles.empty()) return error(placed.node, "/mesh", "its mesh has no triangle with an area");
    const std::string size_fault = body_mesh_fault(part);
    if (!size_fault.empty()) return error(placed.node, "/mesh", size_fault);
    meshes_[node.name] = MeshSolid{std::make_shared<const TriangleSurface>(std::move(part))};
  }

  void error(int node, const std::string& member, const std::string& message) {
    faults_.error(document_.text.where("/nodes/" + std::to_string(node) + member),
                  node_label(document_.model, node) + ": " + message);
  }

  Diagnostics& faults_;
  GltfDocument document_;
  GeometryBudget budget_;
  GroupedWarnings warnings_;
  BodyMeshes meshes_;
};

}  // namespace

bool GeometryBudget::take(std::size_t elements) noexcept {
  if (elements > left_) return false;
  left_ -= elements;
  return true;
}

TriMesh read_mesh(const GltfDocument& document, int mesh, GeometryBudget& budget, Diagnostics& faults,
                  GroupedWarnings& warnings) {
  return joined(MeshReader(document, mesh, {}, budget, faults, warnings).read());
}

std::vector<TriMesh> read_mesh_parts(const GltfDocument& document, int mesh,
                                     std::span<const std::optional<double>> temperatures_c, GeometryBudget& budget,
                                     Diagnostics& faults, GroupedWarnings& warnings) {
  return MeshReader(document, mesh, temperatures_c, budget, faults, warnings).read();
}

TriMesh joined(const std::vector<TriMesh>& parts) {
  if (parts.empty()) return {};
  TriMesh whole = parts.front();
  if (parts.size() > 1) whole.temperature_c.reset();
  for (auto part = parts.begin() + 1; part != parts.end(); ++part) {
    const auto base = static_cast<std::uint32_t>(whole.positions.size());
    whole.positions.insert(whole.positions.end(), part->positions.begin(), part->positions.end());
    for (const auto& [a, b, c] : part->triangles) whole.triangles.push_back({base + a, base + b, base + c});
  }
  return whole;
}

TriMesh transformed(const TriMesh& mesh, const glm::dmat4& transform, std::string name) {
  TriMesh result = mesh;
  result.name = std::move(name);
  for (Vec3& p : result.positions) p = Vec3(transform * glm::dvec4(p, 1.0));
  if (glm::determinant(glm::dmat3(transform)) < 0.0) {
    for (auto& triangle : result.triangles) std::swap(triangle[1], triangle[2]);  // mirroring turns the triangles over
  }
  return result;
}

std::size_t AccessorReader::count(int accessor) const {
  return document_.model.accessors[static_cast<std::size_t>(accessor)].count;
}

std::vector<Vec3> AccessorReader::positions(int accessor) {
  std::vector<double> values;
  if (!check_type(accessor, TINYGLTF_TYPE_VEC3, "positions must be VEC3")) return {};
  if (!read_components(accessor, 3, values)) return {};
  std::vector<Vec3> result(values.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    if (std::isfinite(result[i].x) && std::isfinite(result[i].y) && std::isfinite(result[i].z)) continue;
    fault(accessor_pointer(accessor), "position " + std::to_string(i) + " is not a finite number");
    return {};
  }
  return result;
}

std::vector<std::uint32_t> AccessorReader::indices(int accessor) {
  const tinygltf::Accessor& given = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const bool whole = given.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                     given.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                     given.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!check_type(accessor, TINYGLTF_TYPE_SCALAR, "indices must be SCALAR")) return {};
  if (!whole || given.normalized) {
    fault(accessor_pointer(accessor), "indices must be unsigned integers of 8, 16 or 32 bit");
    return {};
  }
  std::vector<double> values;
  if (!read_components(accessor, 1, values)) return {};
  std::vector<std::uint32_t> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), [](double v) { return static_cast<std::uint32_t>(v); });
  return result;
}

bool AccessorReader::check_type(int accessor, int type, const char* what) {
  const tinygltf::Accessor& given = document_.model.accessors[static_cast<std::size_t>(accessor)];
  if (given.type != type) return fault(accessor_pointer(accessor) + "/type", what);
  if (component_size(given.componentType) == 0) {
    return fault(accessor_pointer(accessor) + "/componentType",
                 "component type " + std::to_string(given.componentType) + " is not one of glTF's");
  }
  return true;
}

bool AccessorReader::locate(int view_index, std::size_t byte_offset, std::size_t element_size, std::size_t count,
                            const std::string& pointer, Range& range) {
  const tinygltf::BufferView& view = document_.model.bufferViews[static_cast<std::size_t>(view_index)];
  const std::vector<unsigned char>& buffer = document_.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const std::string view_name = "buffer view " + std::to_string(view_index);
  // All numbers are below 2^31 (check_structure), so that no sum or product passes 64 bits.
  if (view.byteOffset + view.byteLength > buffer.size()) {
    return fault("/bufferViews/" + std::to_string(view_index), view_name + " ends at byte " +
                                                                   std::to_string(view.byteOffset + view.byteLength) +
                                                                   ", its buffer has " + std::to_string(buffer.size()));
  }
  if (view.byteStride % 4 != 0 || view.byteStride > 252) {  // glTF 2.0 section 5.11.4
    return fault("/bufferViews/" + std::to_string(view_index) + "/byteStride",
                 view_name + ": stride " + std::to_string(view.byteStride) + " is not a multiple of 4 up to 252");
  }
  range.stride = view.byteStride == 0 ? element_size : view.byteStride;
  if (range.stride < element_size) {
    return fault("/bufferViews/" + std::to_string(view_index) + "/byteStride",
                 view_name + ": stride " + std::to_string(range.stride) + " is shorter than an element of " +
                     std::to_string(element_size) + " bytes");
  }
  const std::size_t end = byte_offset + (count - 1) * range.stride + element_size;
  if (end > view.byteLength) {
    return fault(pointer, std::to_string(count) + " elements need " + std::to_string(end) + " bytes, " + view_name +
                              " has " + std::to_string(view.byteLength));
  }
  range.data = buffer.data() + view.byteOffset + byte_offset;
  return true;
}

bool AccessorReader::read_components(int accessor, std::size_t n_components, std::vector<double>& values) {
  const tinygltf::Accessor& given = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const std::string pointer = accessor_pointer(accessor);
  const std::size_t size = component_size(given.componentType);
  if (given.count == 0) return fault(pointer + "/count", "an accessor without elements");
  Range range;
  if (given.bufferView >= 0) {
    if (!locate(given.bufferView, given.byteOffset, size * n_components, given.count, pointer, range)) return false;
  }
  values.assign(given.count * n_components, 0.0);  // without a buffer view all are zero
  for (std::size_t i = 0; range.data != nullptr && i < given.count; ++i) {
    for (std::size_t c = 0; c < n_components; ++c) {
      const double value = load_component(range.data + i * range.stride + c * size, given.componentType);
      values[i * n_components + c] = given.normalized ? normalised(value, given.componentType) : value;
    }
  }
  return !given.sparse.isSparse || apply_sparse(accessor, n_components, values);
}

bool AccessorReader::apply_sparse(int accessor, std::size_t n_components, std::vector<double>& values) {
  const tinygltf::Accessor& given = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const std::string pointer = accessor_pointer(accessor) + "/sparse";
  const auto count = static_cast<std::size_t>(given.sparse.count);
  const int index_type = given.sparse.indices.componentType;
  const std::size_t size = component_size(given.componentType);
  if (count == 0 || count > given.count) {
    return fault(pointer + "/count", "must be between 1 and the accessor's count, " + std::to_string(given.count));
  }
  if (component_size(index_type) == 0 || index_type == TINYGLTF_COMPONENT_TYPE_FLOAT) {
    return fault(pointer + "/indices/componentType", "sparse indices must be unsigned integers");
  }
  Range indices, replacements;
  if (!locate(given.sparse.indices.bufferView, static_cast<std::size_t>(given.sparse.indices.byteOffset),
              component_size(index_type), count, pointer + "/indices", indices) ||
      !locate(given.sparse.values.bufferView, static_cast<std::size_t>(given.sparse.values.byteOffset),
              size * n_components, count, pointer + "/values", replacements)) {
    return false;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const double index = load_component(indices.data + k * indices.stride, index_type);
    if (index < 0.0 || index >= static_cast<double>(given.count)) {
      return fault(pointer + "/indices", "sparse index " + std::to_string(static_cast<long long>(index)) +
                                             " is out of range: the accessor has " + std::to_string(given.count) +
                                             " elements");
    }
    for (std::size_t c = 0; c < n_components; ++c) {
      const double value = load_component(replacements.data + k * replacements.stride + c * size, given.componentType);
      values[static_cast<std::size_t>(index) * n_components + c] =
          given.normalized ? normalised(value, given.componentType) : value;
    }
  }
  return true;
}

bool AccessorReader::fault(const std::string& pointer, const std::string& message) {
  faults_.error(document_.text.where(pointer), pointer + ": " + message);
  return false;
}

std::string brought_here(const Vec3& place) {
  const Vec3 origin = glm::floor(place);
  return ": a marks file (--marks) with `origin_m: [" + fixed(origin.x, 0) + ", " + fixed(origin.y, 0) + ", " +
         fixed(origin.z, 0) + "]` brings it here";
}

PlacedNodes place_nodes(const GltfDocument& document, Diagnostics& remarks, const glm::dmat4& world_from_file,
                        Reach reach) {
  return Placement(document, remarks, reach).run(world_from_file);
}

Frame rigid_frame(const glm::dmat4& world_from_node) {
  const Vec3 back = glm::normalize(Vec3(world_from_node[2]));
  const Vec3 given_up(world_from_node[1]);
  const Vec3 up = glm::normalize(given_up - back * glm::dot(back, given_up));
  const glm::dmat3 axes(glm::cross(up, back), up, back);
  return {glm::normalize(glm::quat_cast(axes)), Vec3(world_from_node[3])};
}

BodyMeshes BodyMeshReader::read(const std::string& file, const Where& where, Diagnostics& faults) {
  if (file.empty()) return {};
  const auto [known, is_first] = known_.try_emplace(file);
  if (!is_first) return known->second;
  const NamedFile named = beside_.find(file, DataKind::rooms);
  if (!named.fault.empty()) {
    faults.error(where, "body_mesh: " + named.fault);
    return {};
  }
  try {
    BodyBuilder body(named.path, faults);
    files_.insert(files_.end(), body.files().begin(), body.files().end());
    known->second = body.build();
  } catch (const Error& fault) {
    for (const Issue& issue : fault.issues()) faults.error(issue.where, issue.message);
  }
  return known->second;
}

}  // namespace pirsim::io::detail
