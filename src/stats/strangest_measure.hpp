// How strange a row is among others by the strangest of several measures.
#pragma once

#include <span>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::stats {

/// Share of the calibration scores and the score itself that are at least as great (strange) as the score. If the score
/// and the calibration scores are exchangeable, P(p <= a) <= a. Ref: [Vovk2005]
[[nodiscard]] double conformal_p(std::span<const double> calibration, double score);

/// How far a measure reaches upwards, from its median to its 95 % quantile, is taken from the known rows and the one
/// that is asked for together. Taken from the known ones alone, a row that stretches a scale would be less strange
/// among them than it is by itself, and p too small.
class StrangestMeasure {
 public:
  /// known: (n_rows x n_measures), one row or more; the greater, the stranger.
  explicit StrangestMeasure(const Matrix<double>& known);
  /// row: (n_measures). If it and the known ones are exchangeable, P(p <= a) <= a.
  [[nodiscard]] double p(std::span<const double> row) const;

 private:
  Matrix<double> known_;                     ///< (n_measures x n_rows)
  std::vector<std::vector<double>> sorted_;  ///< (n_measures) each (n_rows), ascending
};

}  // namespace pirsim::stats
