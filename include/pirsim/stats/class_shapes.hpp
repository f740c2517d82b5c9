// Can this class have made this row at all: several distances of a row from the rows a class is known to make.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/stats/binary.hpp"
#include "pirsim/stats/matrix.hpp"

namespace pirsim::stats {

struct ClassShapesSettings {
  std::size_t subspace = 10;   ///< directions in which a class is taken to vary; fewer for a class with few rows
  std::size_t curved = 4;      ///< of these, the first ones along which its other features may bend (squares, products)
  std::size_t neighbours = 5;  ///< of the class, whose mean distance counts
  std::uint64_t seed = 0;      ///< of the random projections that find the directions
  unsigned threads = 0;        ///< 0: all cores; never changes the result
};

/// Great means strange; compare with the same measure of rows that the class did make and that weren't fitted on
/// (conformal_p), never across classes or measures.
struct Strangeness {
  double neighbour = 0.0;    ///< mean distance to the nearest rows of the class, within its directions
  double mahalanobis = 0.0;  ///< squared distance from the curved directions under the residuals' shrunk covariance
  double largest = 0.0;      ///< greatest entry of that residual in its standard deviations
  [[nodiscard]] std::array<double, 3> values() const noexcept { return {neighbour, mahalanobis, largest}; }
};

/// Each class by itself: its mean and standard deviations, the directions in which it varies most, how it bends along
/// the first of them, and the covariance of the rest.
class ClassShapes {
 public:
  ClassShapes() = default;
  /// features: (n_rows x n_columns), finite; labels: (n_rows) in [0, n_classes), each class ten times or more.
  [[nodiscard]] static ClassShapes fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                       const ClassShapesSettings& settings = {});
  /// features: (n_columns).
  [[nodiscard]] Strangeness strangeness(std::span<const float> features, std::size_t class_index) const;
  [[nodiscard]] std::size_t n_classes() const noexcept { return classes_.size(); }

  void write(BinaryWriter& out) const;
  [[nodiscard]] static ClassShapes read(BinaryReader& in);
  bool operator==(const ClassShapes&) const = default;

  struct Shape {
    std::vector<double> mean, scale;  ///< (n_columns) of the features; scale is one over the standard deviation
    Matrix<float> directions;         ///< (n_directions x n_columns) orthonormal, of the standardised features
    std::vector<double> spread;       ///< (n_directions) standard deviations
    Matrix<float> bend;               ///< (1 + n_products x n_columns) see products()
    Matrix<float> precision;          ///< (n_columns x n_columns) inverse covariance of the residual
    std::vector<double> residual_sd;  ///< (n_columns)
    Matrix<float> members;            ///< (n_rows of the class x n_directions) where its rows lie
    bool operator==(const Shape&) const = default;
  };

 private:
  std::size_t neighbours_ = 1, curved_ = 0;
  std::vector<Shape> classes_;
};

}  // namespace pirsim::stats
