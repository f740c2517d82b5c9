// Which second effect may explain, beside a first one, what no effect explains alone?
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "reconcile/inference/reference_study.hpp"

namespace pirsim::reconcile {

struct Partner {
  std::string effect;
  double p = 0.0;  ///< of "the two together made the data"
};
/// Effects with which the first one may have made the data, the likeliest first. No pair is simulated: in a realization
/// that has a dataset of either effect, what each changes in the features is added up. A partner is told if these
/// superposed datasets are often enough as strange among themselves as the data are (p above the level, as in the
/// absolute test of the classifier). A superposition is no simulation (docs/validation.md tells how often it
/// finds the true partner). first: hypothesis, 1 or more. measured: statistics.
[[nodiscard]] std::vector<Partner> partners_of(const TableView& view, std::size_t first,
                                               std::span<const float> measured, double level, const Context& context);

}  // namespace pirsim::reconcile
