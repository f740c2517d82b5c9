// What the datasets of one entry of the table say about its parameters.
#pragma once

#include <span>
#include <vector>

#include "pirsim/effects/catalogue.hpp"
#include "pirsim/reconcile/feature_map.hpp"
#include "pirsim/reconcile/reference_table.hpp"
#include "pirsim/stats/posterior.hpp"

namespace pirsim::reconcile {

/// Parameters are guessed on the scale on which their prior is flat.
[[nodiscard]] double to_flat(const effects::ParameterInfo& info, double value);
/// Whole where it must be, and within what is accepted.
[[nodiscard]] double from_flat(const effects::ParameterInfo& info, double value);

/// Some of an entry's datasets, as features.
struct EntryDatasets {
  EntryDatasets(const ReferenceTable& table, const FeatureMap& map, std::span<const std::size_t> of, unsigned threads)
      : rows(of.begin(), of.end()), features(map.features(table.statistics.select_rows(of), threads)) {}
  std::vector<std::size_t> rows;  ///< (n) of the table
  stats::Matrix<float> features;  ///< (n x n_features)
};

/// A linear guess of the parameters that vary, learnt from the training datasets and made of the held-back ones, whose
/// guesses err as that of measured data does.
class EntryGuess {
 public:
  /// entry: 1 or more; held_back: of it, outside the training part.
  EntryGuess(const ReferenceTable& table, std::size_t entry, const EntryDatasets& training,
             const EntryDatasets& held_back);

  [[nodiscard]] const std::vector<const effects::ParameterInfo*>& infos() const noexcept { return infos_; }
  [[nodiscard]] std::vector<stats::Interval> bounds() const;
  /// (n_parameters) of a dataset's features, flat.
  [[nodiscard]] std::vector<double> of(std::span<const float> features) const;
  /// (n x n_parameters) of the held-back datasets, flat.
  [[nodiscard]] const stats::Matrix<double>& parameters() const noexcept { return parameters_; }
  /// (n x n_parameters) what is guessed of them.
  [[nodiscard]] const stats::Matrix<double>& guesses() const noexcept { return guesses_; }

 private:
  std::vector<const effects::ParameterInfo*> infos_;
  stats::ParameterGuess guess_;
  stats::Matrix<double> parameters_, guesses_;
};

}  // namespace pirsim::reconcile
