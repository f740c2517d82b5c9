// From a dataset's statistics to what classifiers and tests look at.
#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/reconcile_outcome.hpp"
#include "reconcile/data/statistics.hpp"
#include "stats/matrix.hpp"

namespace pirsim::reconcile {

/// What the simulator knows about a cell and the data don't tell.
struct CellKnowledge {
  double distance_m = 0.0;  ///< from the sensor to the first seat that the trial's first person takes; 0 without one
  double facing = 0.0;      ///< cosine between where the sitter faces and the way to the sensor; 0 without a seat
};
/// (n_cells), by trial, then sensor.
[[nodiscard]] std::vector<CellKnowledge> cell_knowledge(const SceneSpec& scene, const ScriptSpec& script);

/// Statistics as deviations from the plain model, cell by cell, and what sums them up: means over sensors and trials,
/// greatest and least, slopes on what the simulator knows, order of the sensors, likeness to permuted rooms.
class FeatureMap {
 public:
  /// plain: statistics of datasets of the plain model (n x n_statistics); trials: those that are looked at (sorted).
  /// Statistics that are NaN in all of them are unknown and left out; so are those of single datasets.
  FeatureMap(const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge, const stats::Matrix<float>& plain,
             std::vector<std::size_t> trials);

  [[nodiscard]] const std::vector<FeatureName>& names() const noexcept { return names_; }
  [[nodiscard]] const std::vector<std::size_t>& trials() const noexcept { return trials_; }
  [[nodiscard]] bool knows_cell(std::size_t trial, std::size_t sensor) const {
    return known(trial, sensor, CellStatistic::seconds);
  }
  /// What the global test looks at: first the cells' seconds, by trial, then sensor; then the sensors' means, what
  /// sensors lose together, the means and sizes over all cells, and how far each sensor and trial is off as a whole.
  [[nodiscard]] const std::vector<std::size_t>& envelope_columns() const noexcept { return envelope_columns_; }
  /// Columns of one kind each: cells, sensors, trials, time, pairs of sensors, contrasts over all cells, likeness to
  /// permuted rooms.
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& blocks() const noexcept { return blocks_; }
  [[nodiscard]] std::vector<float> features(std::span<const float> statistics) const;
  [[nodiscard]] stats::Matrix<float> features(const stats::Matrix<float>& statistics, unsigned threads = 0) const;

 private:
  struct Writer;
  using Scaled = Statistics<std::vector<double>>;
  void learn_scales(const stats::Matrix<float>& plain);
  void learn_covariates(const std::vector<CellKnowledge>& knowledge);
  [[nodiscard]] Scaled scaled(const DatasetStatistics& data) const;
  /// The sum, and of how many cells.
  [[nodiscard]] std::pair<double, double> sum_over(const Scaled& data, std::span<const std::size_t> trials,
                                                   std::span<const std::size_t> sensors, CellStatistic statistic) const;
  void write_cells(const Scaled& data, Writer& out) const;
  void write_sensors(const Scaled& data, Writer& out) const;
  void write_trials(const Scaled& data, Writer& out) const;
  void write_shifts(const Scaled& data, Writer& out) const;
  void write_time(const DatasetStatistics& data, Writer& out) const;
  void write_pairs(const DatasetStatistics& data, Writer& out) const;
  void write_contrasts(const Scaled& data, Writer& out) const;
  void write_wholes(const Scaled& data, Writer& out) const;
  void write_permutations(const DatasetStatistics& data, Writer& out) const;
  void write_all(const DatasetStatistics& statistics, Writer& out) const;
  template <typename Of>
  [[nodiscard]] std::optional<double> total(const DatasetStatistics& data, const Of& of) const;
  [[nodiscard]] bool known(std::size_t trial, std::size_t sensor, CellStatistic statistic) const {
    return known_.cell(trial, sensor, statistic) != 0;
  }
  [[nodiscard]] double likeness(std::span<const double> values, std::span<const std::size_t> trial_order,
                                std::span<const std::size_t> sensor_order) const;

  StudyFrame frame_;
  std::vector<std::size_t> trials_;
  Statistics<std::vector<std::uint8_t>> known_;
  Statistics<std::vector<double>> mean_, scale_;  ///< of the plain model
  std::vector<double> expected_log_;              ///< (n_cells) mean of log(1 + seconds)
  std::vector<std::string> covariate_names_;
  std::vector<std::vector<double>> covariates_;  ///< (n_covariates x n_cells) mean 0, variance 1 over known cells
  std::vector<FeatureName> names_;
  std::vector<std::size_t> envelope_columns_;
  std::vector<std::vector<std::size_t>> blocks_;
};

/// Statistics of features that are told by themselves: FeatureName::statistic.
inline constexpr std::string_view of_whole_sensor = "sensor_as_a_whole", of_whole_trial = "trial_as_a_whole";

// Features as they are written, one after the other. Private to reconcile.

/// Those before `end`, in order.
template <auto end>
[[nodiscard]] constexpr auto statistics_before() {
  std::array<decltype(end), static_cast<std::size_t>(end)> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<decltype(end)>(k);
  return all;
}
/// Statistics that are looked at as they are; those after them are parts of the time.
inline constexpr auto told_of_cells = statistics_before<CellStatistic::sixth_1>();
inline constexpr auto told_of_trials = statistics_before<TrialStatistic::slice_1>();

/// Numbers in the order in which they come; their names too when those are wanted.
struct FeatureMap::Writer {
  std::vector<float> values;
  std::vector<FeatureName>* names = nullptr;
  std::vector<std::size_t>* envelope = nullptr;
  std::vector<std::vector<std::size_t>>* blocks = nullptr;

  /// What has been added since the last block was ended is one.
  void end_block() {
    if (blocks == nullptr || values.size() == ended) return;
    blocks->emplace_back(values.size() - ended);
    std::iota(blocks->back().begin(), blocks->back().end(), ended);
    ended = values.size();
  }
  /// Whatever is added next is part of the global test.
  void test_next() {
    if (envelope != nullptr) envelope->push_back(values.size());
  }
  template <typename Name>
  void add(double value, const Name& name) {
    values.push_back(static_cast<float>(value));
    if (names != nullptr) names->push_back(name());
  }

 private:
  std::size_t ended = 0;  ///< number of values in blocks
};

}  // namespace pirsim::reconcile
