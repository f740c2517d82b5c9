// Classes as layers of normal distributions: how likely is a row in each class, and is it likely at all.
#pragma once

#include <span>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::stats {

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

}  // namespace pirsim::stats
