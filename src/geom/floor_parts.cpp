#include "geom/floor_parts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "geom/floor_distance.hpp"
#include "geom/floor_overlap.hpp"

namespace pirsim {
namespace {

constexpr double least_rest_m2 = 0.01;  // assumed: less is rounding along the borders (0.001-0.05 would do)
constexpr double gap_m = 0.001;         // assumed: as narrow a gap between two parts is rounding, too

bool box_holds(const FloorArea& area, const Vec2& p) noexcept {
  return area.lower().x <= p.x && p.x <= area.upper().x && area.lower().y <= p.y && p.y <= area.upper().y;
}

}  // namespace

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
