// What areas must hold among each other and on their floor.
#include <algorithm>
#include <cmath>

#include "core/text.hpp"
#include "geom/floor_overlap.hpp"
#include "schema/areas.hpp"
#include "schema/check_specs.hpp"
#include "schema/limits.hpp"

namespace pirsim {
namespace {

constexpr double least_common_m2 = 1e-4;  // assumed: less is rounding along a common border (1e-6 to 1e-3 would do)
constexpr double flat_m = 0.1;            // assumed: areas may be drawn a little above the floor, to be seen (0.02-0.2)

std::string named(const AreaSpec& area) { return "area '" + area.id + "'"; }

/// Of one that is on no floor. A message or none.
std::string off_floor_fault(const AreaSpec& area, const FloorArea& floor) {
  const double up_m = area.outline.height_m() - floor.height_m();
  if (std::abs(up_m) > flat_m)
    return named(area) + " lies " + fixed(std::abs(up_m), 2) + " m " + (up_m > 0.0 ? "above" : "below") + " the floor";
  return common_m2(area.outline, floor) < least_common_m2 ? named(area) + " lies off the floor" : "";
}

}  // namespace

std::string area_id_fault(const std::string& id) {
  if (id == elsewhere) return "area id '" + id + "' is what pirsim calls the floor that is in no area";
  return column_fault(id, "area");
}

std::string area_fault(const SensorSpec& sensor, const std::vector<AreaSpec>& areas) {
  if (!sensor.area || std::ranges::find(areas, *sensor.area, &AreaSpec::id) != areas.end()) return {};
  return "there is no area '" + *sensor.area + "'" +
         (areas.empty() ? ": the scene has none" : near_or_all(*sensor.area, ids_of(areas)));
}

void check_together(const std::vector<AreaSpec>& areas, const FloorArea& floor,
                    const std::function<void(std::size_t, const std::string&)>& tell) {
  std::size_t n_corners = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    for (const auto& loop : areas[i].outline.loops()) n_corners += loop.size();
    if (n_corners > limits::floor_corners) return tell(i, too_many_corners("area"));
  }
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const std::string fault = off_floor_fault(areas[i], floor);
    if (!fault.empty()) tell(i, fault);
    for (std::size_t k = 0; k < i; ++k) {
      const double common = common_m2(areas[k].outline, areas[i].outline);
      if (common < least_common_m2) continue;
      tell(i, named(areas[i]) + " overlaps " + named(areas[k]) + " by " + fixed(common, common < 0.01 ? 4 : 2) + " m2");
      break;  // the first is enough to find the fault
    }
  }
}

}  // namespace pirsim
