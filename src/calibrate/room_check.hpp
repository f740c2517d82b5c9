// Is a room one of these, by statistics of its motion?
#pragma once

#include <span>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::calibrate {

/// Share of the rows, and the vector, that are at least as unlike all others as the vector is: a conformal p value,
/// valid at any number of rows if the vector is one more of them. Unlikeness is Mahalanobis' distance from the mean of
/// the others. rows: (rooms x statistics), more than one.
[[nodiscard]] double unlike_share(const stats::Matrix<double>& rows, std::span<const double> vector);
/// The same of one entry: by its distance from the median.
[[nodiscard]] double unlike_share(std::span<const double> values, double value);

}  // namespace pirsim::calibrate
