// What lies around the rooms of a model: the ground that it stands on, a sky.
#include <algorithm>
#include <array>
#include <map>

#include "core/text.hpp"
#include "io/read/marks_file.hpp"
#include "studies/suggested_parts.hpp"

namespace pirsim::studies {
namespace {

/// Of a node's own mesh.
struct Body {
  int node = 0;
  Extent extent;
  [[nodiscard]] double longest() const {
    const Vec3 size = extent.size();
    return std::max({size.x, size.y, size.z});
  }
};

void widen(Extent& extent, const Extent& by) {
  extent.least = glm::min(extent.least, by.least), extent.most = glm::max(extent.most, by.most);
}

/// A sheet that is much larger than all the rest along two axes, or a shell along all three, of which a dome may end
/// above the lowest of the rest. No unit and no axis is known yet.
bool lies_around(const Body& body, const Extent& rest) {
  constexpr double times = 1.5, thin = 0.1;  // assumed (1.3-1.8; 0.05-0.2, of its length: hilly ground)
  constexpr double short_of = 0.05;          // assumed (0.02-0.1, of its length)
  const double slack = short_of * body.longest();
  const Vec3 size = body.extent.size(), rest_size = rest.size();
  int n_around = 0;
  bool is_thin = false;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_around = size[axis] >= times * rest_size[axis] &&
                           body.extent.least[axis] <= rest.least[axis] + slack &&
                           body.extent.most[axis] >= rest.most[axis] - slack;
    n_around += is_around ? 1 : 0;
    is_thin = is_thin || (!is_around && size[axis] <= thin * body.longest());
  }
  return n_around == 3 || (n_around == 2 && is_thin);
}

}  // namespace

std::vector<int> surroundings_of(const io::ModelParts& model) {
  std::map<int, std::vector<const TriMesh*>> meshes;
  for (const io::ModelPart& part : model.parts) meshes[part.node].push_back(&part.mesh);
  std::vector<Body> bodies;
  for (const auto& [node, own] : meshes) bodies.push_back({node, extent_of(own)});
  std::ranges::stable_sort(bodies, std::greater{}, &Body::longest);
  // Of all from the k-th on
  std::vector<Extent> rests(bodies.size());
  for (std::size_t k = bodies.size(); k-- > 0;) {
    rests[k] = bodies[k].extent;
    if (k + 1 < bodies.size()) widen(rests[k], rests[k + 1]);
  }
  constexpr std::size_t most = 10;  // assumed: ground, sky, sun, water
  std::vector<int> nodes;
  for (std::size_t n = 1; n <= most && n < bodies.size(); ++n) {
    if (!std::ranges::all_of(bodies.begin(), bodies.begin() + static_cast<std::ptrdiff_t>(n),
                             [&](const Body& body) { return lies_around(body, rests[n]); }))
      continue;
    nodes.clear();
    for (std::size_t k = 0; k < n; ++k) nodes.push_back(bodies[k].node);
  }
  return nodes;
}

void leave_out(io::ModelParts& model, const std::vector<int>& nodes) {
  std::erase_if(model.parts, [&](const io::ModelPart& part) { return std::ranges::count(nodes, part.node) > 0; });
}

void ignore(io::ModelParts& model, const std::vector<std::string>& patterns) {
  std::vector<int> nodes;
  for (const std::string& text : patterns) {
    const io::detail::NodePattern pattern{text, {}};
    bool is_found = false;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
      const bool matches = pattern.matches(model.nodes[i].name);
      is_found = is_found || matches;
      if (matches || std::ranges::count(nodes, model.nodes[i].parent) > 0) nodes.push_back(static_cast<int>(i));
    }
    if (is_found) continue;
    std::vector<std::string> names;
    for (const io::ModelNode& node : model.nodes) names.push_back(node.name);
    throw Error(ErrorCode::usage, "--ignore: no node of the scene is called '" + text + "'" + near_or_all(text, names));
  }
  leave_out(model, nodes);
}

}  // namespace pirsim::studies
