// How sure a number is: intervals of shares and of means, and the sign test.
#pragma once

#include <cstddef>
#include <span>

#include "pirsim/interval.hpp"

namespace pirsim::stats {

/// Quantile of a sample that needn't be sorted, linear between order statistics (type 7 of [Hyndman1996]).
/// probability in [0, 1]. Throws Error(usage) for an empty sample.
[[nodiscard]] double quantile(std::span<const double> sample, double probability);
/// The same of an ascending sample.
[[nodiscard]] double sorted_quantile(std::span<const double> sample, double probability);

/// Exact interval of a probability after `hits` of `trials` (1 or more), at least `confidence` sure.
/// Ref: [ClopperPearson1934]
[[nodiscard]] Interval clopper_pearson(std::size_t hits, std::size_t trials, double confidence = 0.95);

/// P(at least `positive` of `positive + negative` signs are positive) if both signs are equally likely; zeros are to be
/// left out by the caller. 1 without any sign.
[[nodiscard]] double sign_test_greater(std::size_t positive, std::size_t negative);

/// Student's interval of the mean of independent values (2 or more), `confidence` sure if they are normally
/// distributed.
[[nodiscard]] Interval mean_interval(std::span<const double> values, double confidence = 0.95);

}  // namespace pirsim::stats
