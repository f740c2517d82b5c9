// Do simulation and measurement disagree, and where?
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/feature_map.hpp"

namespace pirsim::reconcile {

/// plain: statistics of simulated datasets of the model in question (n x n_statistics).
[[nodiscard]] Location locate(const StudyFrame& frame, const FeatureMap& map, const stats::Matrix<float>& plain,
                              std::span<const float> measured, double alpha, const Context& context);

/// What the global test looks at of features that are known: (n_tested_statistics) of a dataset, (n_datasets x
/// n_tested_statistics) of many.
[[nodiscard]] std::vector<double> tested_features(const FeatureMap& map, std::span<const float> features);
[[nodiscard]] stats::Matrix<double> tested_features(const FeatureMap& map, const stats::Matrix<float>& features);
/// What the global test looks at of datasets' statistics.
[[nodiscard]] std::vector<double> tested_statistics(const FeatureMap& map, std::span<const float> statistics);
[[nodiscard]] stats::Matrix<double> tested_statistics(const FeatureMap& map, const stats::Matrix<float>& statistics,
                                                      unsigned threads);

/// Statistics of the datasets of one hypothesis, all or those of training or calibration realizations.
enum class Part { all, training, calibration };
[[nodiscard]] std::vector<std::size_t> rows_of(const ReferenceTable& table, std::size_t hypothesis, Part part);
/// Of an effect that is in the table.
[[nodiscard]] std::size_t hypothesis_of(const ReferenceTable& table, const std::string& effect);

}  // namespace pirsim::reconcile
