// Can this class have made this row at all: the distance of a row from the rows a class is known to make.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::stats {

struct ClassShapesSettings {
  std::size_t subspace =
      10;  ///< directions in which a class is taken to vary; a quarter of the rows and of the columns at most
  std::size_t curved = 4;  ///< of these, the first ones along which its other features may bend (squares, products)
  std::uint64_t seed = 0;  ///< of the random projections that find the directions
  unsigned threads = 0;    ///< 0: all cores; never changes the result
};

/// Each class by itself: its mean and standard deviations, the directions in which it varies most, how it bends along
/// the first of them, and the covariance of the rest.
class ClassShapes {
 public:
  ClassShapes() = default;
  /// features: (n_rows x n_columns), finite; labels: (n_rows) in [0, n_classes), each class ten times or more.
  [[nodiscard]] static ClassShapes fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                       const ClassShapesSettings& settings = {});
  /// features: (n_columns). Squared Mahalanobis distance from the class's curved directions under the residuals' shrunk
  /// covariance. Great means strange; compare with that of rows that the class did make and that weren't fitted on
  /// (conformal_p), never across classes.
  [[nodiscard]] double strangeness(std::span<const float> features, std::size_t class_index) const;
  [[nodiscard]] std::size_t n_classes() const noexcept { return classes_.size(); }

  struct Shape {
    std::vector<double> mean, scale;  ///< (n_columns) of the features; scale is one over the standard deviation
    Matrix<float> directions;         ///< (n_directions x n_columns) orthonormal, of the standardised features
    std::vector<double> spread;       ///< (n_directions) standard deviations
    Matrix<float> bend;               ///< (1 + n_products x n_columns) see products()
    Matrix<float> precision;          ///< (n_columns x n_columns) inverse covariance of the residual
  };

 private:
  std::size_t curved_ = 0;
  std::vector<Shape> classes_;
};

}  // namespace pirsim::stats
