#include "geom/mesh_section.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

namespace pirsim {
namespace {

using Segment = std::pair<Vec2, Vec2>;
using Key = std::pair<double, double>;
Key key_of(const Vec2& p) { return {p.x, p.y}; }

/// Where an edge meets the plane: the same bits from both triangles that share it.
Vec2 crossing(Vec3 a, Vec3 b, double height_m) {
  if (std::tie(a.x, a.y, a.z) > std::tie(b.x, b.y, b.z)) std::swap(a, b);
  return floor_point(glm::mix(a, b, (height_m - a.y) / (b.y - a.y)));
}

std::vector<Segment> segments_of(const TriMesh& mesh, double height_m) {
  std::vector<Segment> segments;
  for (const auto& triangle : mesh.triangles) {
    std::vector<Vec2> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = mesh.positions[triangle[i]], &b = mesh.positions[triangle[(i + 1) % 3]];
      if ((a.y > height_m) == (b.y > height_m)) continue;
      ends.insert(a.y > height_m ? ends.end() : ends.begin(), crossing(a, b, height_m));  // from up to down
    }
    if (ends.size() == 2 && ends[0] != ends[1]) segments.emplace_back(ends[0], ends[1]);
  }
  return segments;
}

/// Segments put together end to end.
class Chains {
 public:
  explicit Chains(std::vector<Segment> segments) : segments_(std::move(segments)), used_(segments_.size()) {
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      at_[key_of(segments_[i].first)].push_back(i);
      at_[key_of(segments_[i].second)].push_back(i);
    }
  }

  MeshSection put_together() {
    MeshSection section;
    const auto add = [&](std::vector<Vec2> chain) {
      if (chain.front() != chain.back()) return section.lines.push_back(std::move(chain));
      chain.pop_back();
      if (chain.size() >= 3) section.loops.push_back(std::move(chain));
    };
    // Lines begin at their ends; what is left then are loops.
    for (const auto& [place, meeting] : at_) {
      if (meeting.size() % 2 == 1 && !used_[meeting.front()]) add(follow({place.first, place.second}));
    }
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (!used_[i]) add(follow(segments_[i].first));
    }
    return section;
  }

 private:
  std::vector<Vec2> follow(const Vec2& from) {
    std::vector<Vec2> chain{from};
    while (true) {
      const std::vector<std::size_t>& meeting = at_.at(key_of(chain.back()));
      const auto next = std::ranges::find_if(meeting, [&](std::size_t i) { return !used_[i]; });
      if (next == meeting.end()) return chain;
      used_[*next] = true;
      const auto& [a, b] = segments_[*next];
      chain.push_back(chain.back() == a ? b : a);
    }
  }

  std::vector<Segment> segments_;
  std::vector<bool> used_;
  std::map<Key, std::vector<std::size_t>> at_;
};

}  // namespace

MeshSection section_of(const TriMesh& mesh, double height_m) {
  return Chains(segments_of(mesh, height_m)).put_together();
}

double mean_thickness_m(const std::vector<std::vector<Vec2>>& loops) {
  double length = 0.0;
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) length += glm::distance(loop[i], loop[(i + 1) % loop.size()]);
  }
  return length > 0.0 ? FloorArea(loops, 0.0).area_m2() / (0.5 * length) : 0.0;
}

}  // namespace pirsim
