// How well an ensemble predicts what was observed, and how far two samples lie apart.
#pragma once

#include <span>

#include "stats/matrix.hpp"

namespace pirsim::stats {

/// Continuous ranked probability score of an ensemble (at least one member): mean |x - y| - 1/2 mean |x - x'|, over
/// all pairs of members, each with itself too. 0 is perfect; with one member it is the absolute error.
/// In the unit of the values. Ref: [Gneiting2007] equation 21.
[[nodiscard]] double crps(std::span<const double> ensemble, double observed);

/// The same for vectors, with Euclidean distances: the energy score. ensemble: (n_members x n_entries); scale the
/// entries first if their units differ. Ref: [Gneiting2007] equation 22.
[[nodiscard]] double energy_score(const Matrix<double>& ensemble, std::span<const double> observed);

/// Area between two empirical distribution functions (1-Wasserstein distance), in the unit of the values; the samples
/// may differ in size, neither may be empty.
[[nodiscard]] double area_between(std::span<const double> a, std::span<const double> b);

}  // namespace pirsim::stats
