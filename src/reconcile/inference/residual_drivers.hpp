// What residuals may depend on: who, when and how.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reconcile/inference/reconcile.hpp"

namespace pirsim::reconcile {

/// Cells (trial x sensor).
struct Who {
  std::string name;
  std::vector<std::uint8_t> cells;  ///< (n_cells) 1: looked at
  bool any_seat = true;
};
/// Weight of each row of a trial's main part.
struct When {
  std::string name;                         ///< empty: always
  bool is_wave = false;                     ///< rises and falls; others have two values
  std::vector<std::vector<double>> weight;  ///< (n_trials x n_main)
};
enum class How { more, more_where_little, more_where_much, opposite, beside };

[[nodiscard]] std::vector<Who> all_who(const ReferenceStudy& reference);
[[nodiscard]] std::vector<When> all_when(const ReferenceStudy& reference);
/// up: the weight of the driver is positive; other: name of the sensor beside which it acts.
[[nodiscard]] std::string in_words(How how, bool up, const std::string& other);

}  // namespace pirsim::reconcile
