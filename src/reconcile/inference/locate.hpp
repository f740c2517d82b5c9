// Do simulation and measurement disagree, and where?
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/feature_map.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {

/// plain: statistics of simulated datasets of the model in question (n x n_statistics).
[[nodiscard]] Location locate(const StudyFrame& frame, const FeatureMap& map, const stats::Matrix<float>& plain,
                              std::span<const float> measured, double alpha, const Context& context);

/// "p = 0.013"; "p <= 0.0099" if no data give a smaller one than `least_p`.
[[nodiscard]] std::string p_in_words(double p, double least_p = 0.0);

/// What the global test looks at of features: (n_tested_statistics) of a dataset, (n_datasets x
/// n_tested_statistics) of many.
[[nodiscard]] std::vector<double> tested_features(const FeatureMap& map, std::span<const float> features);
[[nodiscard]] stats::Matrix<double> tested_features(const FeatureMap& map, const stats::Matrix<float>& features);

/// Statistics of the datasets of one hypothesis, all or those of training or calibration realizations.
enum class Subset { all, training, calibration };
[[nodiscard]] std::vector<std::size_t> rows_of(const ReferenceTable& table, std::size_t hypothesis, Subset subset);
/// The number of an effect that is in the table.
[[nodiscard]] std::size_t hypothesis_of(const ReferenceTable& table, const std::string& effect);

class TableView;

/// A study with the reference table that its data, of one shape, are compared with.
struct ReferenceStudy {
  RealizationSource source;
  StudyFrame frame;
  std::vector<CellKnowledge> knowledge;
  DataShape shape;
  ReferenceTable table;

  /// What the plain model's training datasets say of these trials (sorted).
  [[nodiscard]] FeatureMap map(std::vector<std::size_t> trials) const;
  /// The table as it looks in these trials (sorted); must not outlive the study.
  [[nodiscard]] std::shared_ptr<const TableView> view(std::vector<std::size_t> trials, unsigned threads) const;
};

/// How the table looks in some of the trials: its datasets' features, and what the global test says of them. The study
/// must outlive it. Everything that doesn't depend on which effects are candidates, worked out once: what only a
/// classifier asks for, at its first question, since data that agree with the model need none. Immutable to whoever
/// looks at it.
class TableView {
 public:
  /// trials: those that are looked at (sorted).
  TableView(const ReferenceStudy& study, std::vector<std::size_t> trials, unsigned threads);

  [[nodiscard]] const ReferenceStudy& study() const noexcept { return study_; }
  [[nodiscard]] const ReferenceTable& table() const noexcept { return study_.table; }
  [[nodiscard]] const FeatureMap& map() const noexcept { return map_; }
  /// (n_rows x n_features) of the table's rows.
  [[nodiscard]] const stats::Matrix<float>& features() const { return rows().features; }
  /// (n_plain_datasets x n_statistics)
  [[nodiscard]] const stats::Matrix<float>& plain() const noexcept { return plain_; }
  /// The global test's p for a dataset's statistics.
  [[nodiscard]] double p(std::span<const float> statistics) const;
  /// The global test's p for a row of the table that has an effect and is held back for calibration; 1 for others.
  [[nodiscard]] double p_of_row(std::size_t row) const { return rows().p[row]; }

 private:
  /// What the table's rows are in this view.
  struct Rows {
    stats::Matrix<float> features;  ///< (n_rows x n_features)
    std::vector<double> p;          ///< (n_rows)
  };
  [[nodiscard]] const Rows& rows() const;

  const ReferenceStudy& study_;
  FeatureMap map_;
  unsigned threads_;
  stats::Matrix<float> plain_;
  stats::EnvelopeReference plain_reference_;  ///< of what the global test looks at
  mutable std::once_flag rows_known_;
  mutable Rows rows_;
};

[[nodiscard]] ReferenceStudy make_reference_study(
    const SceneSpec& scene, const ScriptSpec& script, const Settings& settings,
    const std::function<DataShape(const StudyFrame&, std::span<const Series> pilot)>& shape_of_data,
    const Context& context = {});

/// The same for full data: n_replicates runs of every trial.
[[nodiscard]] ReferenceStudy make_full_study(const SceneSpec& scene, const ScriptSpec& script, const Settings& settings,
                                             Measured::Kind kind, int n_replicates, const Context& context = {});

}  // namespace pirsim::reconcile
