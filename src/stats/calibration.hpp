// Making class probabilities mean what they say, and measuring whether they do.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::stats {

/// Several classifiers' probabilities as one: p_k proportional to the product over sources of p_(source,k)^weight.
/// With one source this is temperature scaling, weight = 1 / temperature. Ref: [Guo2017]
class LogPool {
 public:
  LogPool() = default;
  explicit LogPool(std::vector<double> weights) : weights_(std::move(weights)) {}
  /// The weights of least log loss; the problem is convex. sources: per source (n_rows x n_classes) probabilities of
  /// rows that the sources were not fitted on; labels: (n_rows) in [0, n_classes).
  [[nodiscard]] static LogPool fit(std::span<const Matrix<double>> sources, std::span<const int> labels);
  /// Per source (n_classes) probabilities -> (n_classes).
  [[nodiscard]] std::vector<double> combine(std::span<const std::vector<double>> sources) const;
  [[nodiscard]] const std::vector<double>& weights() const noexcept { return weights_; }  ///< (n_sources)

 private:
  std::vector<double> weights_;
};

/// One bin of a reliability diagram: rows whose greatest probability lies in it.
struct ReliabilityBin {
  std::size_t rows = 0;
  double mean_probability = 0.0;  ///< of the likeliest class
  double share_right = 0.0;       ///< how often the likeliest class was the true one
};
struct Reliability {
  std::vector<ReliabilityBin> bins;         ///< of equal width from 0 to 1; an empty bin has zeros
  double expected_calibration_error = 0.0;  ///< mean over rows of |mean_probability - share_right| of their bin
};
/// probabilities: (n_rows x n_classes), labels: (n_rows). Ref: [Guo2017]
[[nodiscard]] Reliability reliability(const Matrix<double>& probabilities, std::span<const int> labels,
                                      std::size_t n_bins = 15);

}  // namespace pirsim::stats
