// A reference table as it looks in some of the trials: its datasets' features, and what the global test says of them.
#pragma once

#include <span>
#include <vector>

#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/feature_map.hpp"
#include "stats/envelope.hpp"

namespace pirsim::reconcile {

/// Everything that doesn't depend on which effects are candidates, worked out once. Immutable.
class TableView {
 public:
  /// scene, frame and table must outlive it. trials: those that are looked at (sorted).
  TableView(const SceneSpec& scene, const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge,
            const ReferenceTable& table, std::vector<std::size_t> trials, unsigned threads);

  [[nodiscard]] const SceneSpec& scene() const noexcept { return scene_; }
  [[nodiscard]] const StudyFrame& frame() const noexcept { return frame_; }
  [[nodiscard]] const ReferenceTable& table() const noexcept { return table_; }
  [[nodiscard]] const FeatureMap& map() const noexcept { return map_; }
  /// (n_rows x n_features) of the table's rows.
  [[nodiscard]] const stats::Matrix<float>& features() const noexcept { return features_; }
  /// (n_plain_datasets x n_statistics)
  [[nodiscard]] const stats::Matrix<float>& plain() const noexcept { return plain_; }
  /// The global test's p for a dataset's statistics.
  [[nodiscard]] double p(std::span<const float> statistics) const;
  /// The same for a row of the table that has an effect and is held back for calibration; 1 for any other row.
  [[nodiscard]] double p_of_row(std::size_t row) const { return p_of_rows_[row]; }

 private:
  const SceneSpec& scene_;
  const StudyFrame& frame_;
  const ReferenceTable& table_;
  FeatureMap map_;
  stats::Matrix<float> features_;
  stats::Matrix<float> plain_;
  stats::EnvelopeReference plain_reference_;  ///< of what the global test looks at
  std::vector<double> p_of_rows_;             ///< (n_rows)
};

}  // namespace pirsim::reconcile
