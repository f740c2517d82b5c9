// Parameters of a simulator from data, without a likelihood: regression-adjusted ABC.
#pragma once

#include <span>
#include <vector>

#include "stats/intervals.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {

/// Statistics chosen for the parameters: the best linear estimate of each parameter from many statistics (ridge
/// regression, its strength by generalised cross-validation). Estimates are few, so ABC on them loses least.
/// Ref: [FearnheadPrangle2012]
class ParameterEstimator {
 public:
  ParameterEstimator() = default;
  /// statistics: (n_rows x n_statistics); parameters: (n_rows x n_parameters); two rows or more.
  [[nodiscard]] static ParameterEstimator fit(const Matrix<double>& statistics, const Matrix<double>& parameters);
  [[nodiscard]] std::vector<double> estimate(std::span<const double> statistics) const;  ///< (n_parameters)
  [[nodiscard]] Matrix<double> estimate(const Matrix<double>& statistics) const;         ///< (n_rows x n_parameters)

 private:
  std::vector<double> intercept_;
  Matrix<double> slopes_;  ///< (n_parameters x n_statistics)
};

struct AbcSettings {
  double accepted = 0.2;              ///< share of rows nearest to the observed statistics that are kept; (0, 1]
  std::vector<Interval> bounds = {};  ///< per parameter, its prior's range, never left; empty: no bounds
};

/// A weighted sample of the posterior.
struct AbcPosterior {
  Matrix<double> values;        ///< (n_accepted x n_parameters) after regression adjustment
  std::vector<double> weights;  ///< (n_accepted) Epanechnikov's kernel of the distance; sum 1
  [[nodiscard]] double mean(std::size_t parameter) const;
  [[nodiscard]] double quantile(std::size_t parameter, double probability) const;
  /// Equal tails; `widening` stretches the interval about the median (1: as it is).
  [[nodiscard]] Interval interval(std::size_t parameter, double confidence, double widening = 1.0) const;
};

/// Local-linear regression adjustment. parameters: (n_rows x n_parameters) drawn from the prior; statistics: (n_rows x
/// n_statistics) simulated with them, few (use ParameterEstimator); observed: (n_statistics). Bounded parameters are
/// adjusted on the logit scale of their range. Throws Error(usage) for sizes that differ or fewer than
/// n_statistics + 2 accepted rows. Ref: [Beaumont2002]
[[nodiscard]] AbcPosterior abc_posterior(const Matrix<double>& parameters, const Matrix<double>& statistics,
                                         std::span<const double> observed, const AbcSettings& settings = {});

}  // namespace pirsim::stats
