#include "model/geom/floor.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim {
namespace {

double signed_area(const std::vector<Vec2>& loop) noexcept {
  double twice = 0.0;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    twice += loop[j].x * loop[i].y - loop[i].x * loop[j].y;
  }
  return 0.5 * twice;
}

/// Just inside the loop, beside the middle of its first edge: unlike a corner it isn't on the edge of a neighbour.
Vec2 point_inside(const std::vector<Vec2>& loop) noexcept {
  const Vec2 along = loop[1 % loop.size()] - loop[0];
  const Vec2 left(-along.y, along.x);
  return loop[0] + 0.5 * along + (signed_area(loop) > 0.0 ? 1e-6 : -1e-6) * left;
}

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

constexpr double least_rest_m2 = 0.01;  // assumed: less is rounding along the borders (0.001-0.05 would do)
constexpr double gap_m = 0.001;         // assumed: as narrow a gap between two parts is rounding, too

bool box_holds(const FloorArea& area, const Vec2& p) noexcept {
  return area.lower().x <= p.x && p.x <= area.upper().x && area.lower().y <= p.y && p.y <= area.upper().y;
}

}  // namespace

FloorArea::FloorArea(std::vector<std::vector<Vec2>> loops, double height_m)
    : loops_(std::move(loops)), height_m_(height_m) {
  if (loops_.empty() || loops_.front().empty()) return;
  lower_ = upper_ = loops_.front().front();
  for (const auto& loop : loops_) {
    for (const Vec2& p : loop) {
      lower_ = glm::min(lower_, p);
      upper_ = glm::max(upper_, p);
    }
  }
}

bool FloorArea::contains(const Vec2& point) const noexcept {
  bool inside = false;
  for (const auto& loop : loops_) {
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
      const Vec2& a = loop[i];
      const Vec2& b = loop[j];
      if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x) {
        inside = !inside;
      }
    }
  }
  return inside;
}

double FloorArea::area_m2() const {
  // By the even-odd rule a loop adds where an even number of others contain it, and takes away otherwise.
  double total = 0.0;
  for (const auto& loop : loops_) {
    int depth = 0;
    for (const auto& other : loops_) {
      if (&other != &loop && FloorArea({other}, height_m_).contains(point_inside(loop))) ++depth;
    }
    total += (depth % 2 == 0 ? 1.0 : -1.0) * std::abs(signed_area(loop));
  }
  return total;
}

FloorGrid::FloorGrid(const FloorArea& floor, double spacing_m)
    : spacing_m_(spacing_m), middle_(0.5 * (floor.lower() + floor.upper())) {
  constexpr double most_squares = 2e7;
  const Vec2 size = (floor.upper() - floor.lower()) / spacing_m;
  if (size.x * size.y > most_squares) throw Error(ErrorCode::infeasible, "the grid has more than 20 million squares");
  n_columns_ = static_cast<std::size_t>(std::ceil(size.x));
  n_rows_ = static_cast<std::size_t>(std::ceil(size.y));
  for (std::size_t row = 0; row < n_rows_; ++row) {
    for (std::size_t column = 0; column < n_columns_; ++column) {
      on_floor_.push_back(floor.contains(centre(column, row)) ? 1 : 0);
    }
  }
  n_squares_ = static_cast<std::size_t>(std::ranges::count(on_floor_, 1));
}

Vec2 FloorGrid::centre(std::size_t column, std::size_t row) const noexcept {
  const auto from_middle = [](std::size_t index, std::size_t count) {
    return static_cast<double>(index) - (static_cast<double>(count) - 1.0) / 2.0;
  };
  return {middle_.x + spacing_m_ * from_middle(column, n_columns_), middle_.y + spacing_m_ * from_middle(row, n_rows_)};
}

double distance_to_edge_m(const FloorArea& floor, const Vec2& place) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const std::vector<Vec2>& loop : floor.loops()) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 along = loop[(i + 1) % loop.size()] - loop[i];
      const double length2 = glm::dot(along, along);
      const double share = length2 > 0.0 ? glm::clamp(glm::dot(place - loop[i], along) / length2, 0.0, 1.0) : 0.0;
      nearest_m = std::min(nearest_m, glm::distance(place, loop[i] + share * along));
    }
  }
  return nearest_m;
}

Vec2 roomiest_point(const FloorArea& area) {
  constexpr int n_steps = 24;  // along either side; near enough for a name
  const Vec2 size = area.upper() - area.lower();
  Vec2 best = 0.5 * (area.lower() + area.upper());
  double most_m = area.contains(best) ? distance_to_edge_m(area, best) : 0.0;
  for (int i = 0; i < n_steps * n_steps; ++i) {
    const Vec2 place = area.lower() + size * (Vec2(i % n_steps, i / n_steps) + 0.5) / static_cast<double>(n_steps);
    if (!area.contains(place)) continue;
    const double away_m = distance_to_edge_m(area, place);
    if (away_m <= most_m + 1e-9) continue;  // of equals the middle, or the first
    best = place;
    most_m = away_m;
  }
  return best;
}

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

FloorParts::FloorParts(const FloorArea& floor, std::vector<FloorArea> parts) : parts_(std::move(parts)) {
  if (parts_.empty()) return;
  for (const FloorArea& part : parts_) areas_m2_.push_back(common_m2(floor, part));
  const double rest_m2 = floor.area_m2() - std::accumulate(areas_m2_.begin(), areas_m2_.end(), 0.0);
  if (rest_m2 < least_rest_m2) return;
  rest_m2_ = rest_m2;
  areas_m2_.push_back(rest_m2);
}

std::size_t FloorParts::at(const Vec2& point) const noexcept {
  const auto holds = [&](const FloorArea& part) { return box_holds(part, point) && part.contains(point); };
  const auto found = std::ranges::find_if(parts_, holds);
  if (found != parts_.end()) return static_cast<std::size_t>(found - parts_.begin());
  std::size_t nearest = parts_.size();
  double least_m = has_rest() ? gap_m : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const double away_m = distance_to_edge_m(parts_[i], point);
    if (away_m > least_m || (away_m == least_m && nearest < parts_.size())) continue;
    nearest = i;
    least_m = away_m;
  }
  return nearest;
}

}  // namespace pirsim
