// Linear discriminant analysis with a shrunk covariance: a classifier, and the directions that part the classes.
#pragma once

#include <span>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::stats {

/// Covariance of the rows around their mean, (1 - shrinkage) of it plus `shrinkage` of its mean variance times the
/// identity; the shrinkage that is best in mean square, estimated from the rows. Ref: [LedoitWolf2004]
struct ShrunkCovariance {
  std::vector<double> mean;   ///< (n_columns)
  Matrix<double> covariance;  ///< (n_columns x n_columns)
  double shrinkage = 0.0;     ///< in [0, 1]
};
/// rows: (n_rows x n_columns), two rows or more.
[[nodiscard]] ShrunkCovariance ledoit_wolf(const Matrix<double>& rows);

/// Classes as normal distributions with one covariance, equally likely beforehand. Columns are standardised first;
/// those that don't vary within classes are left out.
class Discriminant {
 public:
  Discriminant() = default;
  /// features: (n_rows x n_columns), finite; labels: (n_rows) in [0, n_classes), each class at least once.
  [[nodiscard]] static Discriminant fit(const Matrix<float>& features, std::span<const int> labels, int n_classes);

  /// (n_classes) log of the class densities up to a common number.
  [[nodiscard]] std::vector<double> log_densities(std::span<const float> features) const;
  /// The same of a row that has been projected.
  [[nodiscard]] std::vector<double> log_densities_at(std::span<const double> place) const;
  /// (n_classes) softmax of log_densities(); too sure of itself where the classes aren't normal: calibrate.
  [[nodiscard]] std::vector<double> probabilities(std::span<const float> features) const;
  /// (n_directions <= n_classes - 1) coordinates along the directions that part the class means best, within-class
  /// variance 1, ordered by how much they part them.
  [[nodiscard]] std::vector<double> project(std::span<const float> features) const;
  /// (n_rows x n_coordinates <= n_directions) the first of them.
  [[nodiscard]] Matrix<double> project(const Matrix<float>& features, std::size_t n_coordinates,
                                       unsigned threads = 0) const;
  [[nodiscard]] std::size_t n_directions() const noexcept { return directions_.rows(); }
  [[nodiscard]] double shrinkage() const noexcept { return shrinkage_; }

 private:
  std::vector<double> centre_;  ///< (n_columns) taken off first
  Matrix<double> directions_;   ///< (n_directions x n_columns)
  Matrix<double> class_means_;  ///< (n_classes x n_directions) projected
  double shrinkage_ = 0.0;
};

}  // namespace pirsim::stats
