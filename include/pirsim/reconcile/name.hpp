// Which effects of the catalogue can have made these data?
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/reconcile/feature_map.hpp"
#include "pirsim/reconcile/reference_table.hpp"
#include "pirsim/stats/calibration.hpp"
#include "pirsim/stats/discriminant.hpp"
#include "pirsim/stats/extra_trees.hpp"

namespace pirsim::reconcile {

/// How one entry of the table fits the data.
struct EntryScore {
  std::string entry;
  double probability = 0.0;  ///< calibrated, among all entries, each as likely as the others beforehand
  double p_relative = 0.0;   ///< share of the entry's own datasets that another entry explains as well
  double p_absolute = 0.0;   ///< share of the entry's own datasets that lie as far from the rest of them
  double p = 0.0;            ///< of both: min(1, 2 min)
};

struct NamerSettings {
  std::size_t trees = 300;
  std::uint64_t seed = 0;
  unsigned threads = 0;
};

/// Trained on the training worlds of a table, calibrated on the others.
class Namer {
 public:
  /// Entries without enough datasets are never candidates: their p is 0.
  Namer(const ReferenceTable& table, const FeatureMap& map, const NamerSettings& settings);

  /// (n_entries) of a dataset's statistics; nothing first.
  [[nodiscard]] std::vector<EntryScore> judge(std::span<const float> statistics) const;
  /// (n_entries) probabilities only.
  [[nodiscard]] std::vector<double> probabilities(std::span<const float> statistics) const;
  /// How well the probabilities of the calibration datasets mean what they say.
  [[nodiscard]] const stats::Reliability& reliability() const noexcept { return reliability_; }
  /// Names of the features with the greatest share in the trees' decisions.
  [[nodiscard]] std::vector<std::string> telling_features(std::size_t n) const;

 private:
  struct Distances;
  /// An entry's training datasets, to be near to, and what is usual for its calibration datasets.
  struct EntryModel {
    stats::Matrix<float> features;      ///< (n x n_features) of training
    stats::Matrix<double> projections;  ///< (n x n_directions) of training
    std::vector<double> relative;       ///< (n_calibration) sorted scores
    std::vector<double> absolute;
    std::vector<double> usual, spread;  ///< (n_distances) over calibration datasets
  };
  struct Judged {
    std::vector<float> features;
    std::vector<double> projection, log_probabilities;
  };
  [[nodiscard]] Judged look_at(std::span<const float> statistics) const;
  [[nodiscard]] Judged look_at_features(std::vector<float> features) const;
  [[nodiscard]] std::vector<double> distances(const EntryModel& model, const Judged& data) const;
  [[nodiscard]] double absolute_score(const EntryModel& model, const std::vector<double>& distances) const;
  void train(const ReferenceTable& table, const NamerSettings& settings);
  void calibrate(const ReferenceTable& table);

  const FeatureMap* map_;
  std::vector<std::string> names_;
  std::vector<std::size_t> trained_;  ///< entries with datasets enough: the classifiers' classes
  stats::Discriminant discriminant_;
  stats::ExtraTrees trees_;
  stats::LogPool pool_;
  stats::Reliability reliability_;
  std::vector<EntryModel> entries_;
  unsigned threads_ = 0;
};

}  // namespace pirsim::reconcile
