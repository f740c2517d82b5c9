// What residuals may depend on: who and when.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reconcile/inference/reference_study.hpp"

namespace pirsim::reconcile {

/// Cells (trial x sensor).
struct Who {
  ResidualDriver::Who who = ResidualDriver::Who::all_sensors;
  std::string name;                 ///< of the sensor or the trial
  std::vector<std::uint8_t> cells;  ///< (n_cells) 1: looked at
};
/// Weight of each row of a trial's main part.
struct When {
  ResidualDriver::When when = ResidualDriver::When::always;
  double from = 0.0, to = 0.0;
  std::vector<std::vector<double>> weight;  ///< (n_trials x n_main)

  [[nodiscard]] bool is_always() const noexcept { return when == ResidualDriver::When::always; }
  /// It rises and falls; others have two values.
  [[nodiscard]] bool is_wave() const noexcept { return when == ResidualDriver::When::wave; }
};

[[nodiscard]] std::vector<Who> all_who(const ReferenceStudy& reference);
[[nodiscard]] std::vector<When> all_when(const ReferenceStudy& reference);

}  // namespace pirsim::reconcile
