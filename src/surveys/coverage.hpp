// What coverage studies and walk tests have in common: a scene and its sensors, with the survey's effects in force.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/effects/pipeline.hpp"
#include "engine/rt/tracer.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/run_state.hpp"
#include "engine/study/study_in_force.hpp"
#include "model/core/parallel.hpp"
#include "pirsim/coverage.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/error.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "pirsim/shapes.hpp"
#include "pirsim/survey.hpp"

namespace pirsim::studies {

/// Immutable, shared by threads. Detectors are without noise: the same target at the same place gives the same.
class SurveyBase {
 public:
  /// script: sensing, seed, effects and the trials that the survey has people in. Throws Error(input) for unknown
  /// effects, sensors and meshes.
  SurveyBase(SceneSpec scene, const ScriptSpec& script);

  [[nodiscard]] const SceneSpec& scene() const noexcept { return study_.scene; }
  [[nodiscard]] const SensingInForce& sensing() const noexcept { return study_.sensing; }
  [[nodiscard]] const std::vector<TrialInForce>& trials() const noexcept { return study_.trials; }
  [[nodiscard]] std::uint64_t seed() const noexcept { return study_.seed; }
  [[nodiscard]] const sim::SensorArray& array() const noexcept { return *array_; }
  /// (n_arrays)
  [[nodiscard]] const std::vector<std::shared_ptr<const sim::ThermalArray>>& arrays() const noexcept { return arrays_; }
  [[nodiscard]] const effects::Pipeline& stages() const noexcept { return stages_; }
  [[nodiscard]] sim::Detector make_detector() const { return sim::Detector(*array_); }
  [[nodiscard]] sim::Logger make_logger() const { return {stages_, study_.sensing, array_->n_sensors()}; }

 private:
  StudyInForce study_;
  std::unique_ptr<const sim::SensorArray> array_;
  std::vector<std::shared_ptr<const sim::ThermalArray>> arrays_;
  effects::Pipeline stages_;
};

/// A warning for each of these effects that changes nothing: because of the sensors' response, or in any survey of this
/// kind.
[[nodiscard]] std::vector<Issue> idle_effects(std::span<const EffectSpec> effects, const SurveyBase& survey,
                                              effects::Survey kind);

/// Calls visit(column, row) for each square on the floor, row by row.
template <typename Visit>
void each_square(const FloorGrid& grid, Visit visit) {
  for (std::size_t row = 0; row < grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      if (grid.on_floor(column, row)) visit(column, row);
    }
  }
}

/// What of_row(row) gives for each row of squares, one after the other. Threads change no byte.
template <typename Value, typename OfRow>
[[nodiscard]] std::vector<Value> row_by_row(const FloorGrid& grid, unsigned threads, const RowDone& row_done,
                                            OfRow of_row) {
  std::vector<Value> all;
  std::size_t n_done = 0;
  ordered_parallel<std::vector<Value>>(grid.n_rows(), threads, of_row, [&](std::vector<Value>& values) {
    all.insert(all.end(), values.begin(), values.end());
    if (row_done) row_done(++n_done, grid.n_rows());
  });
  return all;
}

// The turning crosses of a coverage study: posed once for all squares, and traced ray by ray against all poses at once.

/// Bars that turn about a common middle.
struct TurningCross {
  Vec3 middle{0.0};                         ///< relative to the square's centre on the floor
  double reach_m = 0.0;                     ///< from the middle to the farthest surface point
  Capsule bar;                              ///< every bar's solid
  std::vector<std::vector<Quat>> rotation;  ///< (n_bars x n_poses) world from bar
};

/// What turns alike in every square. Poses repeat after n_poses() ticks.
class TurningTarget {
 public:
  /// Poses of the ticks [0, n_ticks]; fewer if they repeat exactly before. n_ticks > 0.
  TurningTarget(const XShapesSpec& spec, int tick_rate_hz, std::int64_t n_ticks);

  [[nodiscard]] const std::vector<TurningCross>& crosses() const noexcept { return crosses_; }
  [[nodiscard]] std::size_t n_poses() const noexcept { return n_poses_; }
  /// World-space solids at a tick: what a tracer is given. `foot`: the square's centre on the floor.
  [[nodiscard]] std::vector<PosedShape> solids(const Vec3& foot, std::int64_t tick) const;

 private:
  std::vector<TurningCross> crosses_;
  std::size_t n_poses_ = 0;
};

// One ray against all poses of a bar, several poses at a time.

/// All poses of one capsule as posed by place(), laid out for lanes of poses; padded to whole lanes.
struct BarPoses {
  std::vector<float> ax, ay, az, bx, by, bz;
  float radius = 0.0F;
};

/// Half axes of a bar, relative to its middle, computed once: (n_poses).
[[nodiscard]] std::vector<Vec3> half_axes(const Capsule& bar, const std::vector<Quat>& rotation);
/// The poses of a bar with its middle at `middle`, the same bits as place() of each.
void pose_bar(const std::vector<Vec3>& half_axes, const Vec3& middle, double radius, BarPoses& poses);

/// Lanes of poses in a row of `n_poses`: how long `active` below is.
[[nodiscard]] std::size_t padded(std::size_t n_poses) noexcept;

/// active[pose] becomes 1 where entry_distance(ray, capsule of the pose, range) has a value. (padded n_poses)
void mark_active(const Ray& ray, float range, const BarPoses& poses, std::vector<std::uint8_t>& active) noexcept;

/// Whether the ray passes through a sphere within its range; a millimetre is added to be on the safe side of rounding.
[[nodiscard]] bool may_hit(const Ray& ray, float range, const Vec3& middle, double reach_m) noexcept;

// Coverage: where each sensor sees a target that turns on the spot, in figures too.

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

  /// Columns of the map: sensors, then arrays, whose counts are of windows that end with a frame in which they see it.
  [[nodiscard]] std::size_t n_counted() const noexcept { return scene().sensors.size() + scene().arrays.size(); }
  /// (n_counted) counts of the target at one point of the floor.
  [[nodiscard]] std::vector<MotionCount> counts_at(const Vec2& point) const;
  /// (n_columns x n_counted) counts of a row of squares; zeros off the floor.
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
