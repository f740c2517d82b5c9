// What a comparison of placements shows: maps of all sensors of a set, with the seats where nobody is noticed.
#pragma once

#include <optional>
#include <vector>

#include "pirsim/look.hpp"
#include "show/report.hpp"

namespace pirsim::studies {

/// One set of sensors in the room.
struct PlacementView {
  io::MapChart map;  ///< of all sensors, rings round the seats where nobody at work is noticed
  SeatsAtWork at_work;
  std::vector<std::string> target_unseen;  ///< seats where no sensor reports motion of a turning target
  double seen_area_m2 = 0.0;
  std::size_t n_sensors = 0;
};

struct PlacementViews {
  std::optional<PlacementView> before;  ///< the scene's own sensors; none: it has no sensors
  std::optional<PlacementView> after;   ///< the best set; none: it is the scene's own, or there is no set
};

/// scene: as it was compared. Throws as run_placements() does.
[[nodiscard]] PlacementViews views_of(const SceneSpec& scene, const PlacementSpec& spec, const PlacementReport& report,
                                      unsigned threads = 0);

[[nodiscard]] io::Report placement_report(const SceneSpec& scene, const PlacementSpec& spec,
                                          const PlacementReport& report, const PlacementViews& views);

}  // namespace pirsim::studies
