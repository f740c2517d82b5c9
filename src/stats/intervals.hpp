// Numbers about samples: quantiles, intervals of shares and of means, the sign test; how well an ensemble predicts what
// was observed, and how far two samples lie apart.
#pragma once

#include <cstddef>
#include <span>

#include "pirsim/interval.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {

/// Quantile of a sample that needn't be sorted, linear between order statistics (type 7 of [Hyndman1996]).
/// probability in [0, 1]. Throws Error(usage) for an empty sample.
[[nodiscard]] double quantile(std::span<const double> sample, double probability);
/// Quantile of an ascending sample.
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

// How well an ensemble predicts what was observed, and how far two samples lie apart.

/// Continuous ranked probability score of an ensemble (at least one member): mean |x - y| - 1/2 mean |x - x'|, over
/// all pairs of members, each with itself too. 0 is perfect; with one member it is the absolute error.
/// In the unit of the values. Ref: [Gneiting2007] equation 21.
[[nodiscard]] double crps(std::span<const double> ensemble, double observed);

/// The energy score: the CRPS of vectors, by Euclidean distances. ensemble: (n_members x n_entries); scale the
/// entries first if their units differ. Ref: [Gneiting2007] equation 22.
[[nodiscard]] double energy_score(const Matrix<double>& ensemble, std::span<const double> observed);

/// Area between two empirical distribution functions (1-Wasserstein distance), in the unit of the values; the samples
/// may differ in size, neither may be empty.
[[nodiscard]] double area_between(std::span<const double> a, std::span<const double> b);

}  // namespace pirsim::stats
