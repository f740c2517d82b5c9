// Linear discriminant analysis with a shrunk covariance: a classifier, and the directions that part the classes.
#pragma once

#include <cstdint>
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
  /// Log densities of a row that has been projected.
  [[nodiscard]] std::vector<double> log_densities_at(std::span<const double> place) const;
  /// (n_directions <= n_classes - 1) coordinates along the directions that part the class means best, within-class
  /// variance 1, ordered by how much they part them.
  [[nodiscard]] std::vector<double> project(std::span<const float> features) const;
  /// (n_rows x n_coordinates <= n_directions) the first of them.
  [[nodiscard]] Matrix<double> project(const Matrix<float>& features, std::size_t n_coordinates,
                                       unsigned threads = 0) const;
  [[nodiscard]] std::size_t n_directions() const noexcept { return directions_.rows(); }

 private:
  std::vector<double> centre_;  ///< (n_columns) taken off first
  Matrix<double> directions_;   ///< (n_directions x n_columns)
  Matrix<double> class_means_;  ///< (n_classes x n_directions) projected
};

// Classes as layers of normal distributions: how likely is a row in each class, and is it likely at all.

struct NormalLayersSettings {
  std::size_t layers = 3;        ///< of each class but the first; 1, 2 and 3 were tried: 3 part classes best
  std::size_t fewest_rows = 60;  ///< of a layer, assumed: a class with few rows has fewer layers
};

/// A class whose rows run from "hardly another than the first class" to "far away" isn't one normal distribution. Its
/// rows are sorted by their distance from the first class and cut into layers of equal size; each layer is normal with
/// a shrunk covariance, and the class is the even mixture of its layers. Places are a discriminant's coordinates.
class NormalLayers {
 public:
  NormalLayers() = default;
  /// places: (n_rows x n_coordinates), finite; labels: (n_rows) in [0, n_classes), each class ten times or more.
  [[nodiscard]] static NormalLayers fit(const Matrix<double>& places, std::span<const int> labels, int n_classes,
                                        const NormalLayersSettings& settings = {});
  /// (n_classes) log of the classes' densities at the place, up to a number that all share.
  [[nodiscard]] std::vector<double> log_densities(std::span<const double> place) const;

  struct Layer {
    std::vector<double> mean;      ///< (n_coordinates)
    Matrix<double> whitening;      ///< (n_coordinates x n_coordinates) inverse of the covariance's Cholesky factor
    double log_determinant = 0.0;  ///< of the whitening
  };

 private:
  std::vector<std::vector<Layer>> classes_;
};

// Discriminant analysis of classes that are several things each.

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

// Can this class have made this row at all: the distance of a row from the rows a class is known to make.

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
