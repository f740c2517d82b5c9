// A coverage study's maps and figures as a page for a reader.
#pragma once

#include "io/report.hpp"
#include "studies/coverage.hpp"

namespace pirsim::studies {

/// One sensor's map with the walls, the sensor and, dashed, what was taken out of the room.
[[nodiscard]] io::MapChart map_chart(const CoverageStudy& study, const CoverageMap& map, std::size_t sensor);

[[nodiscard]] io::Report coverage_report(const CoverageStudy& study, const CoverageMap& map,
                                         const CoverageFigures& figures);

}  // namespace pirsim::studies
