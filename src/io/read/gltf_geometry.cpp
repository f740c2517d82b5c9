#include "io/read/gltf_geometry.hpp"

#include <algorithm>
#include <array>
#include <glm/matrix.hpp>
#include <utility>

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

}  // namespace pirsim::io::detail
