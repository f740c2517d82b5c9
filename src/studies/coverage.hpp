// Coverage: where each sensor sees a target that turns on the spot, in figures too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/coverage.hpp"
#include "pirsim/shapes.hpp"
#include "pirsim/survey.hpp"
#include "rt/culling.hpp"
#include "studies/survey_base.hpp"
#include "studies/turning_target.hpp"

namespace pirsim::studies {

/// A compiled coverage study: immutable, shared by threads. The crosses have stood at tick 0, so appearing isn't
/// motion.
class CoverageStudy {
 public:
  /// Takes the things of `spec.without` out of the scene. Throws Error(input) for a name that no mesh has.
  CoverageStudy(SceneSpec scene, CoverageSpec spec);

  /// With the effects in force and without what was taken out.
  [[nodiscard]] const SurveyBase& survey() const noexcept { return survey_; }
  [[nodiscard]] const SceneSpec& scene() const noexcept { return survey_.scene(); }
  [[nodiscard]] const CoverageSpec& spec() const noexcept { return spec_; }
  [[nodiscard]] const FloorGrid& grid() const noexcept { return grid_; }
  [[nodiscard]] const TurningTarget& target() const noexcept { return target_; }
  /// (n_zones) Round the clipped rays of each zone.
  [[nodiscard]] const std::vector<rt::ViewCone>& zone_cones() const noexcept { return zone_cones_; }
  [[nodiscard]] int n_windows() const noexcept { return n_windows_; }
  [[nodiscard]] const std::vector<TriMesh>& taken_out() const noexcept { return taken_out_; }
  /// Effects that a coverage study can't show.
  [[nodiscard]] std::vector<Issue> warnings() const;

  /// (n_sensors) counts of the target at one point of the floor.
  [[nodiscard]] std::vector<MotionCount> counts_at(const Vec2& point) const;
  /// (n_columns x n_sensors) counts of a row of squares; zeros off the floor.
  [[nodiscard]] std::vector<MotionCount> counts_of_row(std::size_t row) const;

 private:
  CoverageSpec spec_;
  std::vector<TriMesh> taken_out_;
  SurveyBase survey_;
  FloorGrid grid_;
  int n_windows_ = 0;
  TurningTarget target_;
  std::vector<rt::ViewCone> zone_cones_;
};

/// A map without counts yet.
[[nodiscard]] CoverageMap empty_map(const CoverageStudy& study);

/// threads 0: all cores; changes no byte.
[[nodiscard]] CoverageMap run_coverage(const CoverageStudy& study, unsigned threads = 0, const RowDone& row_done = {});

// What a coverage map says in a few numbers.

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

/// Of the squares whose centres are in one area.
struct AreaCoverage {
  std::string area;  ///< with its sensors in brackets
  std::size_t squares = 0;
  double blind_fraction = 0.0;               ///< to all sensors
  std::optional<double> blind_to_its_own{};  ///< to the sensors that watch it; none: it has none
};
/// Empty for a scene without areas.
[[nodiscard]] std::vector<AreaCoverage> area_figures_of(const CoverageMap& map, const SceneSpec& scene);

/// x_m, z_m and one column a sensor; a line a square on the floor.
[[nodiscard]] std::string to_csv(const CoverageMap& map);
/// Aligned, for a terminal.
[[nodiscard]] std::string to_text(const CoverageMap& map, const CoverageFigures& figures,
                                  const std::vector<AreaCoverage>& areas = {});

}  // namespace pirsim::studies
