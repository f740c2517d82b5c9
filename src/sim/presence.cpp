#include "sim/presence.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "body/footprint.hpp"

namespace pirsim::sim {

double distance(const Vec2& point, const Stadium& stadium) {
  return body::distance(point, stadium.a, stadium.b) - stadium.radius_m;
}

void append_discs(const Stadium& stadium, double more_m, std::vector<body::Disc>& discs) {
  constexpr double spacing_m = 0.2;
  const double length = glm::distance(stadium.a, stadium.b);
  const int n_more = static_cast<int>(std::ceil(length / spacing_m));
  for (int i = 0; i <= n_more; ++i) {
    const double share = n_more == 0 ? 0.0 : static_cast<double>(i) / n_more;
    discs.push_back({stadium.a + share * (stadium.b - stadium.a), stadium.radius_m + more_m});
  }
}

}  // namespace pirsim::sim
