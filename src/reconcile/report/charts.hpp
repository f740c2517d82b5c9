// Results in pictures.
#pragma once

#include <string>
#include <vector>

#include "io/charts.hpp"
#include "pirsim/reconcile.hpp"
#include "reconcile/validation/selftest.hpp"

namespace pirsim::reconcile {

/// Trials by sensors: measured less expected seconds; cells that the global test flags are framed.
[[nodiscard]] io::GridChart difference_chart(const Location& location, double alpha);
/// Every number that the global test looked at, beside the band that it has to leave to be refused.
[[nodiscard]] io::BandChart envelope_chart(const Location& location, double alpha);
/// All hypotheses of the catalogue by probability; those kept stand out.
[[nodiscard]] io::BarChart ranking_chart(const Outcome& outcome);
/// One a parameter: twenty equally likely values within the range looked at.
[[nodiscard]] std::vector<io::DotsChart> posterior_charts(const FittedEffect& fitted);
/// Distance of model and trials set aside: before, after, with another effect instead, and at best.
[[nodiscard]] io::BarChart held_out_chart(const Verification& verification, const std::string& named);

/// Hypotheses by hypotheses: how often the column's was the likeliest where the row's was hidden.
[[nodiscard]] io::GridChart confusion_chart(const SelftestResult& result);
/// How often an effect is seen, and is then in the set, against its strength.
[[nodiscard]] io::LineChart power_chart(const SelftestResult& result, const std::string& effect);
/// The same of all effects in one picture.
[[nodiscard]] io::GridChart power_grid(const SelftestResult& result);
/// How often the likeliest hypothesis was right, against the probability that it was given.
[[nodiscard]] io::LineChart reliability_chart(const SelftestResult& result);
/// Effect by effect: how often the 90 % intervals hold the truth.
[[nodiscard]] io::BarChart coverage_chart(const SelftestResult& result);

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

/// A statistic's name for a reader who doesn't know the program.
[[nodiscard]] std::string in_plain_words(const std::string& statistic);

}  // namespace pirsim::reconcile
