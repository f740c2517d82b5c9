#include "geom/floor_distance.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace pirsim {

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

}  // namespace pirsim
