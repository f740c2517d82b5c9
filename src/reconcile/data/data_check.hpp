// A look at the measured rows themselves, before any statistics: can sensors have said this?
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {

/// Runs of each of some datasets.
using WholeDatasets = std::function<std::vector<std::vector<Series>>()>;

/// What is wrong or odd with these rows, strongest kind first. pilot: runs of the base model, a run of every trial for
/// each realization, one after the other; what its runs do themselves is never told. periodic: simulates datasets with
/// as many runs as were measured, of what comes back by itself; asked for only where rows seem to stand twice, which a
/// fan beside somebody's steady work does too. Sums tell nothing here.
[[nodiscard]] std::vector<DataFinding> check_data(const StudyFrame& frame, const Measured& measured,
                                                  std::span<const Series> pilot, const WholeDatasets& periodic = {});
/// Whether one of them says that sensors can't have said these rows.
[[nodiscard]] bool any_impossible(std::span<const DataFinding> findings) noexcept;

}  // namespace pirsim::reconcile
