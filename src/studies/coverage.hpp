// A coverage study, compiled and computed row by row.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pirsim/coverage.hpp"
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
};

/// A map without counts yet.
[[nodiscard]] CoverageMap empty_map(const CoverageStudy& study);

/// Computes the rows [first_row, n_rows) and hands each to `consume` in order, from one thread at a time.
/// threads 0: all cores; changes no byte.
void run_rows(const CoverageStudy& study, std::size_t first_row, unsigned threads,
              const std::function<void(std::size_t row, const std::vector<MotionCount>& counts)>& consume);
/// All rows, in memory.
[[nodiscard]] CoverageMap run_coverage(const CoverageStudy& study, unsigned threads = 0);

}  // namespace pirsim::studies
