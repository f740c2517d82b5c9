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

}  // namespace pirsim
