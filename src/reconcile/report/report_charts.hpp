// A reconciliation in pictures. Private to reconcile.
#pragma once

#include "io/charts.hpp"
#include "reconcile/inference/outcome.hpp"

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

/// A statistic's name for a reader who doesn't know the program.
[[nodiscard]] std::string in_plain_words(const std::string& statistic);

}  // namespace pirsim::reconcile
