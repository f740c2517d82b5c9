// Shares as text and as squares of a chart. Private to reconcile.
#pragma once

#include <string>
#include <vector>

#include "io/charts.hpp"
#include "reconcile/validation/selftest.hpp"

namespace pirsim::reconcile {

/// "95 % (75 % to 100 %, 19 of 20)".
[[nodiscard]] std::string with_interval(const Rate& rate);
/// Of the probabilities, with three digits; "no case" if none was judged.
[[nodiscard]] std::string calibration_error(const SelftestResult& result);
/// A square with the share in percent; an empty one without any case.
[[nodiscard]] io::GridChart::Cell share_cell(const Rate& rate);
/// What was hidden (rows) against what it was taken for (columns). shares: (n_hypotheses x n_hypotheses) of each row; a
/// row of zeros has no case and stays empty. Title and note are the caller's.
[[nodiscard]] io::GridChart confusion_grid(const std::vector<std::string>& hypotheses,
                                           const std::vector<std::vector<double>>& shares);

}  // namespace pirsim::reconcile
