// Rows by their class: what discriminants and class shapes begin with.
#pragma once

#include <span>

#include "stats/linear_algebra.hpp"

namespace pirsim::stats::detail {

/// Throws Error(usage) unless there are rows and columns, as many labels as rows, all in [0, n_classes), each class at
/// least `fewest` times, and all features finite.
void check_labelled(const Matrix<float>& features, std::span<const int> labels, int n_classes, int fewest);

struct Groups {
  Eigen::MatrixXd means;      ///< (n_classes x n_columns)
  Eigen::MatrixXd residuals;  ///< (n_rows x n_columns) rows less the mean of their class
};
[[nodiscard]] Groups group(const Matrix<float>& features, std::span<const int> labels, int n_classes);

/// Divides each column by its root mean square; one that is all but 0 becomes 0. Returns what was multiplied with.
Eigen::RowVectorXd scale_columns(Eigen::MatrixXd& residuals);

}  // namespace pirsim::stats::detail
