#include "geom/floor_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace pirsim {
namespace {

/// Of an outline, from its lower to its higher z.
struct Edge {
  Vec2 from, to;
  int owner;  ///< 0 or 1
  [[nodiscard]] double x_at(double z) const noexcept {
    return from.x + (z - from.y) * (to.x - from.x) / (to.y - from.y);
  }
  [[nodiscard]] bool spans(double z) const noexcept { return from.y <= z && z < to.y; }
};

/// Those that have a part between two z; level ones bound nothing of a strip along x.
void add_edges(const FloorArea& area, int owner, double from_z, double to_z, std::vector<Edge>& edges) {
  for (const std::vector<Vec2>& loop : area.loops()) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      Vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
      if (a.y > b.y) std::swap(a, b);
      if (a.y < b.y && a.y < to_z && b.y > from_z) edges.push_back({a, b, owner});
    }
  }
}

/// Where two edges that both span some z cross, if they do.
std::optional<double> z_of_crossing(const Edge& a, const Edge& b) noexcept {
  const double from_z = std::max(a.from.y, b.from.y), to_z = std::min(a.to.y, b.to.y);
  if (from_z >= to_z) return std::nullopt;
  const double before = a.x_at(from_z) - b.x_at(from_z), after = a.x_at(to_z) - b.x_at(to_z);
  if (!((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0))) return std::nullopt;
  return from_z + (to_z - from_z) * before / (before - after);
}

/// Of the line along x at this z, how much is inside both.
double common_m(const std::vector<Edge>& edges, double z, std::vector<std::pair<double, int>>& crossed) {
  crossed.clear();
  for (const Edge& edge : edges) {
    if (edge.spans(z)) crossed.emplace_back(edge.x_at(z), edge.owner);
  }
  std::ranges::sort(crossed);
  bool inside[2] = {false, false};
  double length = 0.0, since = 0.0;
  for (const auto& [x, owner] : crossed) {
    if (inside[0] && inside[1]) length += x - since;
    inside[owner] = !inside[owner];
    since = x;
  }
  return length;
}

}  // namespace

double common_m2(const FloorArea& a, const FloorArea& b) {
  if (a.empty() || b.empty()) return 0.0;
  const double from_z = std::max(a.lower().y, b.lower().y), to_z = std::min(a.upper().y, b.upper().y);
  if (from_z >= to_z || a.lower().x >= b.upper().x || b.lower().x >= a.upper().x) return 0.0;
  std::vector<Edge> edges;
  add_edges(a, 0, from_z, to_z, edges);
  const auto n_of_a = static_cast<std::ptrdiff_t>(edges.size());
  add_edges(b, 1, from_z, to_z, edges);

  // Between two neighbouring heights no edge begins, ends or crosses one of the other area: what is common there is
  // made of trapezoids, whose widths at half height tell their area.
  std::vector<double> heights{from_z, to_z};
  for (const Edge& edge : edges) heights.insert(heights.end(), {edge.from.y, edge.to.y});
  for (auto of_a = edges.begin(); of_a != edges.begin() + n_of_a; ++of_a) {
    for (auto of_b = edges.begin() + n_of_a; of_b != edges.end(); ++of_b) {
      if (const auto z = z_of_crossing(*of_a, *of_b)) heights.push_back(*z);
    }
  }
  std::erase_if(heights, [&](double z) { return z < from_z || z > to_z; });
  std::ranges::sort(heights);
  std::vector<std::pair<double, int>> crossed;
  double sum = 0.0;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    const double high = heights[i] - heights[i - 1];
    if (high > 0.0) sum += high * common_m(edges, heights[i - 1] + 0.5 * high, crossed);
  }
  return sum;
}

}  // namespace pirsim
