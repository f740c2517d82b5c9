// Which effects of the catalogue can have made these data?
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "effects/catalogue.hpp"
#include "reconcile/inference/reference_study.hpp"
#include "stats/conformal.hpp"
#include "stats/pooled_classifier.hpp"

namespace pirsim::reconcile {

/// (n_hypotheses) Datasets (rows of the table) that nothing is learnt from and in which the global test sees something,
/// as in data that a name is given to; or, of few, the likeliest to be seen.
using SeenRows = std::vector<std::vector<std::size_t>>;

/// Of these rows of a table, those that the catalogue without an effect makes; empty: of the whole.
[[nodiscard]] std::vector<std::size_t> still_made(const ReferenceTable& table, std::vector<std::size_t> rows,
                                                  const std::string& left_out);

/// alpha: level of the global test.
[[nodiscard]] SeenRows seen_rows(const TableView& view, double alpha, const std::string& left_out = {});

struct ClassifierSettings {
  double alpha = 0.05;  ///< level of the global test
  std::size_t trees = 300;
  std::string left_out = {};  ///< effect that the catalogue is made to lack; empty: none
};

/// Rows of the table that its hypotheses are told apart by, with their classes. Hypotheses without enough datasets are
/// none.
struct LabelledRows {
  /// Throws Error(infeasible) without rows of nothing.
  LabelledRows(const ReferenceTable& table, const SeenRows& seen, const std::string& left_out);
  /// (n_classes) -> (n_hypotheses); what is no candidate has 0.
  [[nodiscard]] std::vector<double> by_hypothesis(std::span<const double> of_classes) const;

  std::vector<std::size_t> rows;        ///< (n) of the table
  std::vector<int> labels;              ///< (n)
  std::vector<int> kinds;               ///< (n) finer classes of the training rows: datasets that are alike; else -1
  stats::Split split;                   ///< training realizations and seen rows, by place in `rows`
  std::vector<std::size_t> hypotheses;  ///< (n_classes)
  std::size_t n_hypotheses = 0;
};

/// How probable each hypothesis is, seen in some of the trials only, without a test of whether it can have made the
/// data.
class HypothesisProbabilities {
 public:
  /// map must outlive it.
  HypothesisProbabilities(const ReferenceTable& table, const FeatureMap& map, const SeenRows& seen,
                          const stats::PooledClassifierSettings& settings);
  /// (n_hypotheses) of a dataset's statistics.
  [[nodiscard]] std::vector<double> of(std::span<const float> statistics) const;

 private:
  const FeatureMap* map_;
  LabelledRows data_;
  stats::PooledClassifier classifier_;
};

/// Trained on the training realizations of a table, calibrated on the others. Names are given only where the global
/// test sees a disagreement, so an effect is calibrated on those of its datasets in which the test sees one: weak
/// datasets, which look like anything, would make every effect hard to rule out.
class HypothesisClassifier {
 public:
  /// view must outlive it. The p of what is no candidate is 0.
  HypothesisClassifier(const TableView& view, const ClassifierSettings& settings, const Context& context);

  /// (n_hypotheses) of a dataset's statistics; nothing first.
  [[nodiscard]] std::vector<HypothesisScore> judge(std::span<const float> statistics) const;
  /// (n_hypotheses) probabilities only.
  [[nodiscard]] std::vector<double> probabilities(std::span<const float> statistics) const;
  [[nodiscard]] const SeenRows& seen_rows() const noexcept { return seen_rows_; }
  /// How well the probabilities of the calibration datasets mean what they say.
  [[nodiscard]] const stats::Reliability& reliability() const noexcept { return reliability_; }
  /// Names of the features with the greatest share in the trees' decisions.
  [[nodiscard]] std::vector<FeatureName> telling_features(std::size_t n) const;

 private:
  const FeatureMap* map_;
  std::vector<std::string> names_;  ///< of all hypotheses
  SeenRows seen_rows_;
  LabelledRows data_;
  stats::ConformalClassifier classifier_;
  stats::ImpostorTests impostors_;
  stats::Reliability reliability_;
};

}  // namespace pirsim::reconcile
