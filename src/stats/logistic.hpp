// Logistic regression: what a yes or no depends on, and how surely.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::stats {

struct LogisticSettings {
  /// Half of it times the sum of squared slopes is added to the loss; 0 or more.
  double ridge = 0.0;
  /// Half of it times the intercept's square is added too; keeps it finite if all outcomes are equal.
  double intercept_ridge = 0.0;
  /// (n_rows) added to the log-odds, not fitted; empty: none.
  std::span<const double> offset = {};
  /// (n_rows) rows with one number depend on each other (a trial, say), and the standard errors are the sandwich's;
  /// empty: all rows are independent. Ref: [LiangZeger1986]
  std::span<const int> cluster = {};
};

struct LogisticFit {
  std::vector<double> coefficients;     ///< (1 + n_columns) intercept, then slopes, in log-odds per unit of the column
  std::vector<double> standard_errors;  ///< (1 + n_columns)
  double log_likelihood = 0.0;          ///< without the ridge's part
  int iterations = 0;
};

/// outcomes: (n_rows) of 0 and 1; columns: (n_rows x n_columns). Maximum (penalised) likelihood by Newton's method.
/// Throws Error(usage) for sizes that differ, other outcomes, or if there is no maximum because the classes are
/// separable and a ridge is 0.
[[nodiscard]] LogisticFit fit_logistic(const Matrix<double>& columns, std::span<const std::uint8_t> outcomes,
                                       const LogisticSettings& settings = {});

}  // namespace pirsim::stats
