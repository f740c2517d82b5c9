// What a coverage map says in a few numbers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "studies/coverage.hpp"

namespace pirsim::studies {

/// Neighbours are squares that share a side. Ref: [Stefansson2021] section 4.2, which gives the first two.
struct MapFigures {
  double mean_step = 0.0;       ///< mean |difference| between neighbours that both have motion; 0 without such pairs
  int greatest_step = 0;        ///< between any two neighbours
  std::size_t pairs = 0;        ///< neighbours that both have motion
  double blind_fraction = 0.0;  ///< of the squares
  double seen_area_m2 = 0.0;    ///< of the squares with motion
};

struct CoverageFigures {
  std::vector<MapFigures> sensors;  ///< (n_sensors)
  MapFigures all;                   ///< steps: pairs of all sensors together; areas: seen by at least one sensor
};

[[nodiscard]] CoverageFigures figures_of(const CoverageMap& map);

/// x_m, z_m and one column a sensor; a line a square on the floor.
[[nodiscard]] std::string to_csv(const CoverageMap& map);
/// Aligned, for a terminal.
[[nodiscard]] std::string to_text(const CoverageMap& map, const CoverageFigures& figures);

}  // namespace pirsim::studies
