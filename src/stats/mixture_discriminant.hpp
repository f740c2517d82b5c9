// Discriminant analysis of classes that are several things each.
#pragma once

#include <span>
#include <vector>

#include "stats/discriminant.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {

/// Each class is a mixture of subclasses, normal distributions that all have one covariance. A class that moves its
/// rows one way as often as the other has the mean of no class, and its subclasses have their own. Ref:
/// [HastieTibshirani1996], with subclasses that are given
class MixtureDiscriminant {
 public:
  MixtureDiscriminant() = default;
  /// features: (n_rows x n_columns), finite; labels: (n_rows) in [0, n_classes), each at least once; subclasses:
  /// (n_rows) in [0, n), each at least once and within one class.
  [[nodiscard]] static MixtureDiscriminant fit(const Matrix<float>& features, std::span<const int> labels,
                                               int n_classes, std::span<const int> subclasses);

  /// Between the subclasses: its coordinates part these.
  [[nodiscard]] const Discriminant& discriminant() const noexcept { return discriminant_; }
  /// place: a row as projected by discriminant(). (n_classes) probabilities, classes equally likely beforehand; too
  /// sure of themselves: calibrate.
  [[nodiscard]] std::vector<double> probabilities_at(std::span<const double> place) const;

 private:
  Discriminant discriminant_;
  std::size_t n_classes_ = 0;
  std::vector<std::size_t> class_of_;  ///< (n_subclasses)
  std::vector<double> log_share_;      ///< (n_subclasses) of its class's rows
};

}  // namespace pirsim::stats
