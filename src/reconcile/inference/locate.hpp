// Do simulation and measurement disagree, and where?
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/feature_map.hpp"

namespace pirsim::reconcile {

/// One trial x sensor.
struct LocatedCell {
  std::string trial, sensor;
  double measured_s = 0.0;           ///< seconds with motion a run
  double expected_s = 0.0;           ///< mean of the simulated datasets
  double low_s = 0.0, high_s = 0.0;  ///< 95 % of the simulated datasets lie between
  double adjusted_p = 1.0;           ///< of the global test: below alpha, the cell differs whatever the others do
};

/// One number of the envelope: a feature with its band.
struct EnvelopeFeature {
  std::string name;
  double observed = 0.0, median = 0.0, lower = 0.0, upper = 0.0;  ///< in the feature's own scale
  double adjusted_p = 1.0;
};

struct Location {
  double p = 1.0;  ///< of the whole comparison
  std::vector<LocatedCell> cells;
  std::vector<EnvelopeFeature> envelope;
  double band_s = 0.0;  ///< half the width of the mean cell's 95 % band: what this experiment can't see
  std::size_t n_simulated = 0;
};

struct LocateSettings {
  double alpha = 0.05;
  std::uint64_t seed = 0;
  unsigned threads = 0;
};

/// plain: statistics of simulated datasets of the model in question (n x n_statistics).
[[nodiscard]] Location locate(const StudyFrame& frame, const FeatureMap& map, const stats::Matrix<float>& plain,
                              std::span<const float> measured, const LocateSettings& settings);

/// What the global test looks at of features that are known: (n_tested_statistics) of a dataset, (n_datasets x
/// n_tested_statistics) of many.
[[nodiscard]] std::vector<double> tested_features(const FeatureMap& map, std::span<const float> features);
[[nodiscard]] stats::Matrix<double> tested_features(const FeatureMap& map, const stats::Matrix<float>& features);
/// The same from statistics.
[[nodiscard]] std::vector<double> tested_statistics(const FeatureMap& map, std::span<const float> statistics);
[[nodiscard]] stats::Matrix<double> tested_statistics(const FeatureMap& map, const stats::Matrix<float>& statistics,
                                                      unsigned threads);

/// Statistics of the datasets of one hypothesis, all or those of training or calibration realizations.
enum class Part { all, training, calibration };
[[nodiscard]] std::vector<std::size_t> rows_of(const ReferenceTable& table, std::size_t hypothesis, Part part);
/// Of an effect that is in the table.
[[nodiscard]] std::size_t hypothesis_of(const ReferenceTable& table, const std::string& effect);

}  // namespace pirsim::reconcile
