#include "reconcile/inference/feature_map.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/parallel.hpp"
#include "schema/action_facts.hpp"

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

/// Calls visit(trial, sensor).
template <typename Visit>
void for_each_cell(const StudyFrame& frame, const Visit& visit) {
  for (std::size_t trial = 0; trial < frame.trials.size(); ++trial) {
    for (std::size_t sensor = 0; sensor < frame.sensors.size(); ++sensor) visit(trial, sensor);
  }
}

}  // namespace

std::vector<CellKnowledge> cell_knowledge(const SceneSpec& scene, const ScriptSpec& script) {
  std::vector<CellKnowledge> cells;
  const StudyFrame frame = frame_of(scene, script);
  if (!frame.units.empty()) return std::vector<CellKnowledge>(frame.n_cells());  // nobody knows who sits where
  for (const TrialSpec& trial : script.trials) {
    const action::Sit* sit = first<action::Sit>(trial);
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
  std::vector<std::uint8_t> known(plain.columns(), 0);
  for_all_known(plain, [&](std::size_t i, double) { known[i] = 1; });
  known_ = {frame_, std::move(known)};
  learn_scales(plain);
  learn_covariates(knowledge);
  Writer writer;
  writer.names = &names_;
  writer.envelope = &envelope_columns_;
  writer.blocks = &blocks_;
  write_all({frame_, plain.row(0)}, writer);
}

void FeatureMap::learn_scales(const stats::Matrix<float>& plain) {
  const std::size_t n = plain.columns();
  std::vector<double> rows(n, 0.0);  // that have the statistic: in some a counted phase may not come
  std::vector<double> square(n, 0.0);
  std::vector<double> mean(n, 0.0), scale(n, 1.0);
  expected_log_.assign(frame_.n_cells(), 0.0);
  for_all_known(plain, [&](std::size_t i, double) { rows[i] += 1.0; });
  for_all_known(plain, [&](std::size_t i, double value) { mean[i] += value / rows[i]; });
  for_all_known(plain,
                [&](std::size_t i, double value) { square[i] += (value - mean[i]) * (value - mean[i]) / rows[i]; });
  const Statistics rows_with(frame_, std::span<const double>(rows));
  for (std::size_t row = 0; row < plain.rows(); ++row) {
    for_each_cell(frame_, [&](std::size_t trial, std::size_t sensor) {
      const double seconds = seconds_of(DatasetStatistics(frame_, plain.row(row)), trial, sensor);
      if (std::isnan(seconds)) return;
      expected_log_[frame_.cell(trial, sensor)] +=
          std::log1p(seconds) / rows_with.cell(trial, sensor, CellStatistic::seconds);
    });
  }
  // A statistic that hardly varies in one cell must not drown the others: its scatter is at least a part of what the
  // same statistic has elsewhere.
  for (const std::vector<std::size_t>& places : alike_places(frame_)) {
    std::vector<double> scatters;
    for (const std::size_t i : places) {
      if (known_.values()[i] != 0) scatters.push_back(std::sqrt(square[i]));
    }
    if (scatters.empty()) continue;
    double usual = std::accumulate(scatters.begin(), scatters.end(), 0.0) / static_cast<double>(scatters.size());
    if (usual < 1e-6) usual = 1.0;
    for (const std::size_t i : places) scale[i] = std::sqrt(square[i] + 0.04 * usual * usual);
  }
  mean_ = {frame_, std::move(mean)};
  scale_ = {frame_, std::move(scale)};
}

void FeatureMap::learn_covariates(const std::vector<CellKnowledge>& knowledge) {
  covariate_names_ = {"expected", "uncertainty", "distance", "facing"};
  covariates_.assign(covariate_names_.size(), std::vector<double>(frame_.n_cells(), 0.0));
  std::vector<std::size_t> over;
  for (const std::size_t trial : trials_) {
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (known(trial, sensor, CellStatistic::seconds)) over.push_back(frame_.cell(trial, sensor));
    }
  }
  for_each_cell(frame_, [&](std::size_t trial, std::size_t sensor) {
    const std::size_t cell = frame_.cell(trial, sensor);
    covariates_[0][cell] = expected_log_[cell];
    covariates_[1][cell] = std::log((scale_.cell(trial, sensor, CellStatistic::seconds) + 0.5) /
                                    (mean_.cell(trial, sensor, CellStatistic::seconds) + 1.0));
    covariates_[2][cell] = knowledge[cell].distance_m;
    covariates_[3][cell] = knowledge[cell].facing;
  });
  for (std::vector<double>& covariate : covariates_) standardise(covariate, over);
}

/// Deviations in units of the plain model's scatter, drawn in at the ends: of what is told of the trials looked at, 0
/// elsewhere.
FeatureMap::Scaled FeatureMap::scaled(const DatasetStatistics& data) const {
  std::vector<double> values(data.values().size(), 0.0);
  const Statistics out(frame_, std::span(values));
  const auto off = [&](const auto& of) {
    return of(known_) == 0 || std::isnan(of(data)) ? 0.0 : static_cast<double>(of(data)) - of(mean_);
  };
  for (const std::size_t trial : trials_) {
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      for (const CellStatistic statistic : told_of_cells) {
        const auto of = [&](const auto& all) -> auto& { return all.cell(trial, sensor, statistic); };
        of(out) = std::asinh(off(of) / of(scale_));
      }
      // A clock's error is read off it, so that it stays in proportion; a few windows are much.
      constexpr double much_windows = 4.0;
      const auto shift = [&](const auto& all) -> auto& { return all.cell(trial, sensor, CellStatistic::shift_s); };
      shift(out) = off(shift) / (much_windows * frame_.window_s);
    }
    for (const TrialStatistic statistic : told_of_trials) {
      const auto of = [&](const auto& all) -> auto& { return all.trial(trial, statistic); };
      of(out) = std::asinh(off(of) / of(scale_));
    }
  }
  return {frame_, std::move(values)};
}

std::vector<float> FeatureMap::features(std::span<const float> statistics) const {
  Writer writer;
  writer.values.reserve(names_.size());
  write_all({frame_, statistics}, writer);
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
