#include "reconcile/inference/feature_map.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/parallel.hpp"
#include "reconcile/inference/feature_writer.hpp"

namespace pirsim::reconcile {
namespace {

void standardise(std::vector<double>& values, const std::vector<std::size_t>& over) {
  double mean = 0.0, square = 0.0;
  for (const std::size_t i : over) mean += values[i] / static_cast<double>(over.size());
  for (const std::size_t i : over) square += (values[i] - mean) * (values[i] - mean) / static_cast<double>(over.size());
  for (double& value : values) value = square > 1e-12 ? (value - mean) / std::sqrt(square) : 0.0;
}

/// Calls visit(column, value) for every number that is there, row by row.
template <typename Visit>
void for_all_known(const stats::Matrix<float>& table, const Visit& visit) {
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t i = 0; i < table.columns(); ++i) {
      if (!std::isnan(table(row, i))) visit(i, static_cast<double>(table(row, i)));
    }
  }
}

const action::Sit* first_seat(const TrialSpec& trial) {
  for (const PersonSpec& person : trial.people) {
    for (const ScriptedAction& action : person.actions) {
      if (const auto* sit = std::get_if<action::Sit>(&action.what)) return sit;
    }
  }
  return nullptr;
}

}  // namespace

std::vector<CellKnowledge> cell_knowledge(const SceneSpec& scene, const ScriptSpec& script) {
  std::vector<CellKnowledge> cells;
  for (const TrialSpec& trial : script.trials) {
    const action::Sit* sit = first_seat(trial);
    const auto seat = sit == nullptr ? scene.seats.end() : std::ranges::find(scene.seats, sit->seat, &SeatSpec::id);
    for (const SensorSpec& sensor : scene.sensors) {
      cells.emplace_back();
      if (seat == scene.seats.end()) continue;
      const Vec3 way = sensor.world_from_sensor.origin - seat->world_from_seat.origin;
      cells.back().distance_m = glm::length(way);
      cells.back().facing = glm::dot(glm::normalize(way), seat->world_from_seat.forward());
    }
  }
  return cells;
}

FeatureMap::FeatureMap(const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge,
                       const stats::Matrix<float>& plain, std::vector<std::size_t> trials)
    : frame_(frame), trials_(std::move(trials)) {
  known_.assign(plain.columns(), 0);
  for_all_known(plain, [&](std::size_t i, double) { known_[i] = 1; });
  learn_scales(plain);
  learn_covariates(knowledge);
  Writer writer;
  writer.names = &names_;
  writer.envelope = &envelope_columns_;
  writer.blocks = &blocks_;
  write_all(plain.row(0), writer);
}

bool FeatureMap::known(std::size_t trial, std::size_t sensor, std::size_t statistic) const {
  return known_[cell_index(frame_, trial, sensor, static_cast<CellStatistic>(statistic))] != 0;
}

void FeatureMap::learn_scales(const stats::Matrix<float>& plain) {
  const std::size_t n = plain.columns();
  std::vector<double> rows(n, 0.0);  // that have the statistic: in some a counted phase may not come
  std::vector<double> square(n, 0.0);
  mean_.assign(n, 0.0);
  expected_log_.assign(frame_.n_cells(), 0.0);
  for_all_known(plain, [&](std::size_t i, double) { rows[i] += 1.0; });
  for_all_known(plain, [&](std::size_t i, double value) { mean_[i] += value / rows[i]; });
  for_all_known(plain,
                [&](std::size_t i, double value) { square[i] += (value - mean_[i]) * (value - mean_[i]) / rows[i]; });
  for (std::size_t row = 0; row < plain.rows(); ++row) {
    for (std::size_t cell = 0; cell < frame_.n_cells(); ++cell) {
      const std::size_t i = cell * n_cell_statistics;  // its seconds
      if (!std::isnan(plain(row, i))) expected_log_[cell] += std::log1p(static_cast<double>(plain(row, i))) / rows[i];
    }
  }
  // A statistic that hardly varies in one cell must not drown the others: its scatter is at least a part of what the
  // same statistic has elsewhere.
  const std::size_t in_cells = frame_.n_cells() * n_cell_statistics;
  scale_.assign(n, 1.0);
  const auto set_scales = [&](std::size_t first, std::size_t step, std::size_t last) {
    std::vector<double> scatters;
    for (std::size_t i = first; i < last; i += step) {
      if (known_[i] != 0) scatters.push_back(std::sqrt(square[i]));
    }
    if (scatters.empty()) return;
    double mean = std::accumulate(scatters.begin(), scatters.end(), 0.0) / static_cast<double>(scatters.size());
    if (mean < 1e-6) mean = 1.0;
    for (std::size_t i = first; i < last; i += step) scale_[i] = std::sqrt(square[i] + 0.04 * mean * mean);
  };
  for (std::size_t k = 0; k < n_cell_statistics; ++k) set_scales(k, n_cell_statistics, in_cells);
  const std::size_t in_trials = in_cells + frame_.trials.size() * n_trial_statistics;
  for (std::size_t k = 0; k < n_trial_statistics; ++k) set_scales(in_cells + k, n_trial_statistics, in_trials);
  for (std::size_t k = 0; k < n_pairs(frame_); ++k) set_scales(in_trials + k, n_pairs(frame_), n);
}

void FeatureMap::learn_covariates(const std::vector<CellKnowledge>& knowledge) {
  covariate_names_ = {"expected", "uncertainty", "distance", "facing"};
  covariates_.assign(covariate_names_.size(), std::vector<double>(frame_.n_cells(), 0.0));
  std::vector<std::size_t> over;
  for (const std::size_t trial : trials_) {
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (known(trial, sensor, 0)) over.push_back(trial * frame_.sensors.size() + sensor);
    }
  }
  for (std::size_t cell = 0; cell < frame_.n_cells(); ++cell) {
    const std::size_t seconds = cell * n_cell_statistics;
    covariates_[0][cell] = expected_log_[cell];
    covariates_[1][cell] = std::log((scale_[seconds] + 0.5) / (mean_[seconds] + 1.0));
    covariates_[2][cell] = knowledge[cell].distance_m;
    covariates_[3][cell] = knowledge[cell].facing;
  }
  for (std::vector<double>& covariate : covariates_) standardise(covariate, over);
}

FeatureMap::Scaled FeatureMap::scaled(std::span<const float> statistics) const {
  Scaled data;
  data.values.resize(statistics.size(), 0.0);
  const auto scale = [&](std::size_t first, std::size_t n) {
    for (std::size_t i = first; i < first + n; ++i) {
      if (known_[i] == 0 || std::isnan(statistics[i])) continue;
      data.values[i] = std::asinh((static_cast<double>(statistics[i]) - mean_[i]) / scale_[i]);
    }
  };
  for (const std::size_t trial : trials_) {
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      scale(cell_index(frame_, trial, sensor, CellStatistic::seconds), n_told_of_cells);
      // A clock's error is read off it, so that it stays in proportion; a few windows are much.
      constexpr double much_windows = 4.0;
      const std::size_t shift = cell_index(frame_, trial, sensor, CellStatistic::shift_s);
      if (known_[shift] == 0 || std::isnan(statistics[shift])) continue;
      data.values[shift] = (static_cast<double>(statistics[shift]) - mean_[shift]) / (much_windows * frame_.window_s);
    }
    scale(trial_index(frame_, trial, TrialStatistic::lag_minus_4), n_told_of_trials);
  }
  return data;
}

std::vector<float> FeatureMap::features(std::span<const float> statistics) const {
  Writer writer;
  writer.values.reserve(names_.size());
  write_all(statistics, writer);
  return std::move(writer.values);
}

stats::Matrix<float> FeatureMap::features(const stats::Matrix<float>& statistics, unsigned threads) const {
  stats::Matrix<float> all(statistics.rows(), names_.size());
  constexpr std::size_t block = 256;
  ordered_parallel<int>((statistics.rows() + block - 1) / block, threads,
                        [&](std::size_t b) {
                          for (std::size_t row = b * block; row < std::min(statistics.rows(), (b + 1) * block); ++row) {
                            std::ranges::copy(features(statistics.row(row)), all.row(row).begin());
                          }
                          return 0;
                        },
                        [](int&) {});
  return all;
}

}  // namespace pirsim::reconcile
