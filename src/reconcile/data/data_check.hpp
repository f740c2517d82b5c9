// A look at the measured rows themselves, before any statistics: can sensors have said this?
#pragma once

#include <span>
#include <vector>

#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {

/// What is wrong or odd with these rows, strongest kind first. pilot: runs of the base model, a run of every trial for
/// each realization, one after the other; what its runs do themselves is never told. Sums tell nothing here.
[[nodiscard]] std::vector<DataFinding> check_data(const StudyFrame& frame, const Measured& measured,
                                                  std::span<const Series> pilot);
/// Whether one of them says that sensors can't have said these rows.
[[nodiscard]] bool any_impossible(std::span<const DataFinding> findings) noexcept;

}  // namespace pirsim::reconcile
