#include "pirsim/reconcile/feature_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "pirsim/core/parallel.hpp"

namespace pirsim::reconcile {
namespace {

/// Statistics whose means over the sensors of a trial are looked at one by one.
constexpr auto n_told_of_cells = static_cast<std::size_t>(CellStatistic::sixth_1);
constexpr auto n_told_of_trials = static_cast<std::size_t>(TrialStatistic::slice_1);
constexpr std::size_t n_sixths = n_cell_statistics - n_told_of_cells;
constexpr std::size_t n_slices = n_trial_statistics - n_told_of_trials;
constexpr std::array told_by_trial{CellStatistic::seconds,       CellStatistic::half_difference,
                                   CellStatistic::onsets,        CellStatistic::isolated,
                                   CellStatistic::again_after_1, CellStatistic::agreement,
                                   CellStatistic::lead_seconds,  CellStatistic::tail_seconds};
/// Statistics by whose means the sensors are put in order.
constexpr std::array told_in_order{CellStatistic::seconds,      CellStatistic::silent_seconds,
                                   CellStatistic::onsets,       CellStatistic::again_after_1,
                                   CellStatistic::period_power, CellStatistic::half_difference};

void standardise(std::vector<double>& values, const std::vector<std::size_t>& over) {
  double mean = 0.0, square = 0.0;
  for (const std::size_t i : over) mean += values[i] / static_cast<double>(over.size());
  for (const std::size_t i : over) square += (values[i] - mean) * (values[i] - mean) / static_cast<double>(over.size());
  for (double& value : values) value = square > 1e-12 ? (value - mean) / std::sqrt(square) : 0.0;
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

/// Deviations in units of the plain model's scatter, drawn in at the ends.
struct FeatureMap::Scaled {
  std::vector<double> values;  ///< (n_statistics)
};

/// Numbers in the order in which they come; their names too when those are wanted.
struct FeatureMap::Writer {
  std::vector<float> values;
  std::vector<std::string>* names = nullptr;
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

FeatureMap::FeatureMap(const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge,
                       const stats::Matrix<float>& plain, std::vector<std::size_t> trials)
    : frame_(frame), trials_(std::move(trials)) {
  for (const float value : plain.row(0)) known_.push_back(std::isnan(value) ? 0 : 1);
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
  const auto rows = static_cast<double>(plain.rows());
  std::vector<double> square(n, 0.0);
  mean_.assign(n, 0.0);
  expected_log_.assign(frame_.n_cells(), 0.0);
  for (std::size_t row = 0; row < plain.rows(); ++row) {
    for (std::size_t i = 0; i < n; ++i) {
      if (known_[i] != 0) mean_[i] += static_cast<double>(plain(row, i)) / rows;
    }
    for (std::size_t cell = 0; cell < frame_.n_cells(); ++cell) {
      const std::size_t seconds = cell * n_cell_statistics;
      if (known_[seconds] != 0) expected_log_[cell] += std::log1p(static_cast<double>(plain(row, seconds))) / rows;
    }
  }
  for (std::size_t row = 0; row < plain.rows(); ++row) {
    for (std::size_t i = 0; i < n; ++i) {
      const double d = known_[i] != 0 ? static_cast<double>(plain(row, i)) - mean_[i] : 0.0;
      square[i] += d * d / rows;
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
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    if (known_[i] == 0 || std::isnan(statistics[i])) continue;
    data.values[i] = std::asinh((static_cast<double>(statistics[i]) - mean_[i]) / scale_[i]);
  }
  return data;
}

void FeatureMap::write_cells(const Scaled& data, Writer& out) const {
  for (const std::size_t trial : trials_) {
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (!known(trial, sensor, 0)) continue;
      out.test_next();
      out.add(data.values[cell_index(frame_, trial, sensor, CellStatistic::seconds)],
              [&] { return frame_.trials[trial] + " " + frame_.sensors[sensor] + " seconds"; });
    }
  }
}

void FeatureMap::write_sensors(const Scaled& data, Writer& out) const {
  for (std::size_t k = 0; k < n_told_of_cells; ++k) {
    std::vector<double> means;
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      double sum = 0.0, count = 0.0;
      for (const std::size_t trial : trials_) {
        if (!known(trial, sensor, k)) continue;
        sum += data.values[cell_index(frame_, trial, sensor, static_cast<CellStatistic>(k))];
        count += 1.0;
      }
      if (count == 0.0) continue;
      means.push_back(sum / count);
      out.test_next();
      out.add(means.back(), [&] { return frame_.sensors[sensor] + " " + name(static_cast<CellStatistic>(k)); });
    }
    if (std::ranges::find(told_in_order, static_cast<CellStatistic>(k)) == told_in_order.end()) continue;
    if (means.size() < 3) continue;
    std::ranges::sort(means);
    const auto label = [&](const char* which) { return which + name(static_cast<CellStatistic>(k)); };
    out.add(means[means.size() - 1] - means[means.size() - 2], [&] { return label("first less second sensor: "); });
    out.add(means[1] - means[0], [&] { return label("last but one less last sensor: "); });
    out.add(means.back() - means.front(), [&] { return label("first less last sensor: "); });
  }
}

void FeatureMap::write_trials(const Scaled& data, Writer& out) const {
  for (const CellStatistic statistic : told_by_trial) {
    for (const std::size_t trial : trials_) {
      double sum = 0.0, count = 0.0;
      for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
        if (!known(trial, sensor, static_cast<std::size_t>(statistic))) continue;
        sum += data.values[cell_index(frame_, trial, sensor, statistic)];
        count += 1.0;
      }
      if (count > 0.0) out.add(sum / count, [&] { return frame_.trials[trial] + " " + name(statistic); });
    }
  }
  for (std::size_t k = 0; k < n_told_of_trials; ++k) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (const std::size_t trial : trials_) {
      const std::size_t i = trial_index(frame_, trial, static_cast<TrialStatistic>(k));
      if (known_[i] == 0) continue;
      sum += data.values[i];
      squares += data.values[i] * data.values[i];
      count += 1.0;
    }
    if (count == 0.0) continue;
    const auto label = [&](const char* which) { return which + name(static_cast<TrialStatistic>(k)); };
    out.add(sum / count, [&] { return label("mean "); });
    out.add(std::sqrt(squares / count), [&] { return label("size of "); });
  }
}

/// Sum of a statistic over the trials; NaN if it is known in none.
double FeatureMap::total(std::span<const float> statistics,
                         const std::function<std::size_t(std::size_t)>& index) const {
  double sum = 0.0, count = 0.0;
  for (const std::size_t trial : trials_) {
    const std::size_t i = index(trial);
    if (known_[i] == 0 || std::isnan(statistics[i])) continue;
    sum += static_cast<double>(statistics[i]);
    count += 1.0;
  }
  return count > 0.0 ? sum : std::nan("");
}

/// How motion spreads over the time, whatever there is of it: logarithms of shares, of all sensors and of each.
void FeatureMap::write_time(std::span<const float> statistics, Writer& out) const {
  const auto write_shares = [&](std::size_t n, const auto& part, const std::string& whose) {
    std::vector<double> totals;
    for (std::size_t k = 0; k < n; ++k) totals.push_back(part(k));
    if (std::isnan(totals.front())) return;
    const double all = std::accumulate(totals.begin(), totals.end(), 0.0) + static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k) {
      out.test_next();
      out.add(std::log((totals[k] + 1.0) / all),
              [&] { return whose + ", part " + std::to_string(k + 1) + " of " + std::to_string(n) + " of the time"; });
    }
  };
  write_shares(
      n_slices,
      [&](std::size_t k) {
        return total(statistics,
                     [&](std::size_t trial) { return trial_index(frame_, trial, TrialStatistic::slice_1) + k; });
      },
      "all sensors");
  for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
    write_shares(
        n_sixths,
        [&](std::size_t k) {
          return total(statistics, [&](std::size_t trial) {
            return cell_index(frame_, trial, sensor, CellStatistic::sixth_1) + k;
          });
        },
        frame_.sensors[sensor]);
  }
}

/// How much oftener than not a sensor moves while another does: logarithms of odds over all trials.
void FeatureMap::write_pairs(std::span<const float> statistics, Writer& out) const {
  std::vector<double> odds;
  for (std::size_t first = 0; first < frame_.sensors.size(); ++first) {
    for (std::size_t second = 0; second < frame_.sensors.size(); ++second) {
      if (first == second) continue;
      double together = 0.0, alone = 0.0, count = 0.0;
      for (const std::size_t trial : trials_) {
        if (!known(trial, first, 0) || !known(trial, second, 0)) continue;
        const auto without = static_cast<double>(statistics[pair_index(frame_, trial, first, second)]);
        const auto seconds = static_cast<double>(statistics[cell_index(frame_, trial, second, CellStatistic::seconds)]);
        if (std::isnan(without) || std::isnan(seconds)) continue;
        together += std::max(0.0, seconds / frame_.window_s - without);
        alone += without;
        count += 1.0;
      }
      if (count == 0.0 || known_[pair_index(frame_, trials_.front(), first, second)] == 0) continue;
      odds.push_back(std::log((together + 0.5) / (alone + 0.5)));
      out.test_next();
      out.add(odds.back(), [&] { return frame_.sensors[first] + " while " + frame_.sensors[second] + " moves"; });
    }
  }
  if (odds.empty()) return;
  out.add(*std::ranges::max_element(odds), [] { return std::string("most together"); });
  out.add(*std::ranges::min_element(odds), [] { return std::string("least together"); });
}

void FeatureMap::write_contrasts(const Scaled& data, Writer& out) const {
  for (std::size_t k = 0; k < n_told_of_cells; ++k) {
    double count = 0.0, sum = 0.0, size = 0.0, greatest = -1e9, least = 1e9;
    std::vector<double> slopes(covariates_.size(), 0.0);
    for (const std::size_t trial : trials_) {
      for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
        if (!known(trial, sensor, k)) continue;
        const std::size_t cell = trial * frame_.sensors.size() + sensor;
        const double value = data.values[cell * n_cell_statistics + k];
        count += 1.0;
        sum += value;
        size += std::abs(value);
        greatest = std::max(greatest, value);
        least = std::min(least, value);
        for (std::size_t c = 0; c < slopes.size(); ++c) slopes[c] += value * covariates_[c][cell];
      }
    }
    if (count == 0.0) continue;
    const std::string statistic = name(static_cast<CellStatistic>(k));
    const auto label = [&](std::string_view which) { return std::string(which) + " " + statistic; };
    out.test_next();
    out.add(sum / count, [&] { return label("mean"); });
    out.test_next();
    out.add(size / count, [&] { return label("size of"); });
    out.add(greatest, [&] { return label("greatest"); });
    out.add(least, [&] { return label("least"); });
    for (std::size_t c = 0; c < slopes.size(); ++c) {
      out.add(slopes[c] / count, [&] { return label("slope on " + covariate_names_[c] + " of"); });
    }
  }
}

double FeatureMap::likeness(std::span<const double> values, std::span<const std::size_t> trial_order,
                            std::span<const std::size_t> sensor_order) const {
  const std::size_t n_sensors = frame_.sensors.size();
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (const std::size_t trial : trials_) {
    for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
      const std::size_t from = trial_order[trial] * n_sensors + sensor_order[sensor];
      const std::size_t cell = trial * n_sensors + sensor;
      if (known_[cell * n_cell_statistics] == 0 || known_[from * n_cell_statistics] == 0) continue;
      const double a = values[cell], b = expected_log_[from];
      n += 1.0;
      x += a;
      y += b;
      xx += a * a;
      yy += b * b;
      xy += a * b;
    }
  }
  const double variance = (n * xx - x * x) * (n * yy - y * y);
  return variance > 1e-9 ? (n * xy - x * y) / std::sqrt(variance) : 0.0;
}

void FeatureMap::write_permutations(std::span<const float> statistics, Writer& out) const {
  const std::size_t n_trials = frame_.trials.size(), n_sensors = frame_.sensors.size();
  std::vector<double> values(frame_.n_cells(), 0.0);
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    const float seconds = statistics[cell * n_cell_statistics];
    if (!std::isnan(seconds)) values[cell] = std::log1p(static_cast<double>(seconds));
  }
  std::vector<std::size_t> trials(n_trials), sensors(n_sensors);
  std::iota(trials.begin(), trials.end(), std::size_t{0});
  std::iota(sensors.begin(), sensors.end(), std::size_t{0});
  const double as_it_is = likeness(values, trials, sensors);
  out.add(as_it_is, [] { return std::string("likeness"); });
  const auto add = [&](const auto& trial_order, const auto& sensor_order, const char* what) {
    out.add(likeness(values, trial_order, sensor_order) - as_it_is,
            [&] { return std::string("likeness gained by ") + what; });
  };
  const auto rotated = [](std::vector<std::size_t> order, std::ptrdiff_t by) {
    std::rotate(order.begin(), order.begin() + (by > 0 ? by : static_cast<std::ptrdiff_t>(order.size()) + by),
                order.end());
    return order;
  };
  const auto best_swap = [&](std::vector<std::size_t> order, const auto& likeness_of) {
    double best = -2.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        std::swap(order[i], order[j]);
        best = std::max(best, likeness_of(order));
        std::swap(order[i], order[j]);
      }
    }
    return best - as_it_is;
  };
  if (n_trials > 1) {
    add(rotated(trials, 1), sensors, "trials shifted by one");
    add(rotated(trials, -1), sensors, "trials shifted back by one");
    add(std::vector<std::size_t>(trials.rbegin(), trials.rend()), sensors, "trials in reverse");
    out.add(best_swap(trials, [&](const auto& order) { return likeness(values, order, sensors); }),
            [] { return std::string("likeness gained by two trials swapped"); });
  }
  if (n_sensors > 1) {
    add(trials, rotated(sensors, 1), "sensors shifted by one");
    add(trials, rotated(sensors, -1), "sensors shifted back by one");
    add(trials, std::vector<std::size_t>(sensors.rbegin(), sensors.rend()), "sensors in reverse");
    out.add(best_swap(sensors, [&](const auto& order) { return likeness(values, trials, order); }),
            [] { return std::string("likeness gained by two sensors swapped"); });
  }
}

void FeatureMap::write_all(std::span<const float> statistics, Writer& out) const {
  const Scaled data = scaled(statistics);
  write_cells(data, out);
  out.end_block();
  write_sensors(data, out);
  out.end_block();
  write_trials(data, out);
  out.end_block();
  write_time(statistics, out);
  out.end_block();
  write_pairs(statistics, out);
  out.end_block();
  write_contrasts(data, out);
  out.end_block();
  write_permutations(statistics, out);
  out.end_block();
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
