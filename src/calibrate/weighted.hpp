// Means, quantiles and ranks of weighted values.
#pragma once

#include <span>

#include "pirsim/interval.hpp"

namespace pirsim::calibrate {

// Weights are at least 0, and not all 0.

[[nodiscard]] double weighted_mean(std::span<const double> values, std::span<const double> weights);
[[nodiscard]] double weighted_sd(std::span<const double> values, std::span<const double> weights);
/// From 5 to 95 %.
[[nodiscard]] Interval weighted_interval(std::span<const double> values, std::span<const double> weights);
/// Spearman's, ties sharing their middle rank; 0 of fewer than three or of values that are all the same.
[[nodiscard]] double rank_correlation(std::span<const double> x, std::span<const double> y);

}  // namespace pirsim::calibrate
