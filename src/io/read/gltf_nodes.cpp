#include "io/read/gltf_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "schema/check_specs.hpp"
#include "schema/fields.hpp"

namespace pirsim::io::detail {
namespace {

constexpr double smallest_scale = 1e-9;  // assumed: a scale below turns a kilometre into a micrometre

std::string node_pointer(int node) { return "/nodes/" + std::to_string(node); }

class Placement {
 public:
  Placement(const GltfDocument& document, Diagnostics& remarks)
      : document_(document), remarks_(remarks), seen_(document.model.nodes.size(), false) {}

  PlacedNodes run(const glm::dmat4& world_from_file) {
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
    if (!is_in_world(Vec3(m[3]))) {
      const auto limit_m = static_cast<int>(accepted::in_world_m.max);
      return fault(node, "/translation", "it lies more than " + std::to_string(limit_m) + " m from the origin");
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
  std::vector<bool> seen_;
  std::vector<Pending> pending_;
  PlacedNodes placed_;
  std::size_t n_faults_ = 0;
};

}  // namespace

PlacedNodes place_nodes(const GltfDocument& document, Diagnostics& remarks, const glm::dmat4& world_from_file) {
  return Placement(document, remarks).run(world_from_file);
}

Frame rigid_frame(const glm::dmat4& world_from_node) {
  const Vec3 back = glm::normalize(Vec3(world_from_node[2]));
  const Vec3 given_up(world_from_node[1]);
  const Vec3 up = glm::normalize(given_up - back * glm::dot(back, given_up));
  const glm::dmat3 axes(glm::cross(up, back), up, back);
  return {glm::normalize(glm::quat_cast(axes)), Vec3(world_from_node[3])};
}

}  // namespace pirsim::io::detail
