#include "reconcile/inference/feature_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "model/core/parallel.hpp"
#include "model/schema/actions.hpp"
#include "reconcile/data/statistics.hpp"

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

FeatureName mean_of(const std::string& statistic) { return {"mean " + statistic, statistic, "all cells, mean"}; }
FeatureName size_of(const std::string& statistic) {
  return {"size of " + statistic, statistic, "all cells, mean size of the differences"};
}
FeatureName of_sensor(const std::string& sensor, const std::string& statistic) {
  return {sensor + " " + statistic, statistic, sensor};
}

constexpr std::size_t n_sixths = static_cast<std::size_t>(CellStatistic::shift_s) - told_of_cells.size();
constexpr std::size_t n_slices = n_trial_statistics - told_of_trials.size();
/// Statistics whose means over the sensors of a trial are looked at one by one.
constexpr std::array told_by_trial{CellStatistic::seconds,       CellStatistic::half_difference,
                                   CellStatistic::onsets,        CellStatistic::isolated,
                                   CellStatistic::again_after_1, CellStatistic::agreement,
                                   CellStatistic::lead_seconds,  CellStatistic::tail_seconds};
/// Statistics by whose means the sensors are put in order.
constexpr std::array told_in_order{CellStatistic::seconds,      CellStatistic::silent_seconds,
                                   CellStatistic::onsets,       CellStatistic::again_after_1,
                                   CellStatistic::period_power, CellStatistic::half_difference};

template <typename Statistic>
Statistic nth_after(Statistic first, std::size_t n) {
  return static_cast<Statistic>(static_cast<std::size_t>(first) + n);
}

}  // namespace

std::vector<CellKnowledge> cell_knowledge(const SceneSpec& scene, const ScriptSpec& script) {
  std::vector<CellKnowledge> cells;
  const StudyFrame frame = frame_of(scene, script);
  if (!frame.day_parts.empty()) return std::vector<CellKnowledge>(frame.n_cells());  // nobody knows who sits where
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
  for_each_cell(frame_, [&](std::size_t trial, std::size_t sensor) {
    const std::vector<double> seconds = seconds_of(frame_, plain, trial, sensor);
    for (const double s : seconds)
      expected_log_[frame_.cell(trial, sensor)] += std::log1p(s) / static_cast<double>(seconds.size());
  });
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
  stats::Matrix<float> all(0, names_.size());
  ordered_parallel<std::vector<float>>(
      statistics.rows(), threads, [&](std::size_t row) { return features(statistics.row(row)); },
      [&](const std::vector<float>& one) { all.append_row(one); });
  return all;
}

// The features of a dataset, block by block.

void FeatureMap::write_cells(const Scaled& data, Writer& out) const {
  for (const std::size_t trial : trials_) {
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (!known(trial, sensor, CellStatistic::seconds)) continue;
      out.test_next();
      out.add(data.cell(trial, sensor, CellStatistic::seconds), [&] {
        return of_sensor(frame_.trials[trial] + " " + frame_.sensors[sensor], name(CellStatistic::seconds));
      });
    }
  }
}

std::pair<double, double> FeatureMap::sum_over(const Scaled& data, std::span<const std::size_t> trials,
                                               std::span<const std::size_t> sensors, CellStatistic statistic) const {
  double sum = 0.0, count = 0.0;
  for (const std::size_t trial : trials) {
    for (const std::size_t sensor : sensors) {
      if (!known(trial, sensor, statistic)) continue;
      sum += data.cell(trial, sensor, statistic);
      count += 1.0;
    }
  }
  return {sum, count};
}

void FeatureMap::write_sensors(const Scaled& data, Writer& out) const {
  for (const CellStatistic statistic : told_of_cells) {
    std::vector<double> means;
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      const auto [sum, count] = sum_over(data, trials_, std::array{sensor}, statistic);
      if (count == 0.0) continue;
      means.push_back(sum / count);
      out.test_next();
      out.add(means.back(), [&] { return of_sensor(frame_.sensors[sensor], name(statistic)); });
    }
    if (std::ranges::find(told_in_order, statistic) == told_in_order.end() || means.size() < 3) continue;
    std::ranges::sort(means);
    out.add(means[means.size() - 1] - means[means.size() - 2],
            [&] { return FeatureName{"first less second sensor: " + name(statistic)}; });
    out.add(means[1] - means[0], [&] { return FeatureName{"last but one less last sensor: " + name(statistic)}; });
    out.add(means.back() - means.front(), [&] { return FeatureName{"first less last sensor: " + name(statistic)}; });
  }
}

void FeatureMap::write_trials(const Scaled& data, Writer& out) const {
  for (const CellStatistic statistic : told_by_trial) {
    for (const std::size_t trial : trials_) {
      const auto [sum, count] = sum_over(data, std::array{trial}, stats::numbers_to(frame_.sensors.size()), statistic);
      if (count == 0.0) continue;
      out.add(sum / count, [&] { return FeatureName{frame_.trials[trial] + " " + name(statistic)}; });
    }
  }
  for (const TrialStatistic statistic : told_of_trials) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (const std::size_t trial : trials_) {
      if (known_.trial(trial, statistic) == 0) continue;
      const double value = data.trial(trial, statistic);
      sum += value;
      squares += value * value;
      count += 1.0;
    }
    if (count == 0.0) continue;
    if (statistic >= TrialStatistic::joint_loss) out.test_next();
    out.add(sum / count, [&] { return mean_of(name(statistic)); });
    out.add(std::sqrt(squares / count), [&] { return size_of(name(statistic)); });
  }
  write_shifts(data, out);
}

/// What a clock's error is read off, of either sign: over the trials, of each sensor and of all.
void FeatureMap::write_shifts(const Scaled& data, Writer& out) const {
  const std::string statistic = name(CellStatistic::shift_s);
  double all = 0.0, n_all = 0.0;
  for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
    const auto [sum, count] = sum_over(data, trials_, std::array{sensor}, CellStatistic::shift_s);
    if (count == 0.0) continue;
    out.add(sum / count, [&] { return of_sensor(frame_.sensors[sensor], statistic); });
    all += sum;
    n_all += count;
  }
  if (n_all > 0.0) out.add(all / n_all, [&] { return mean_of(statistic); });
}

/// Sum of a statistic, of(data, trial), over the trials in which it is known; none if there are no such trials. What a
/// dataset has depends on the shape alone: a trial that one dataset lacks adds nothing.
template <typename Of>
std::optional<double> FeatureMap::total(const DatasetStatistics& data, const Of& of) const {
  std::optional<double> sum;
  for (const std::size_t trial : trials_) {
    if (of(known_, trial) == 0) continue;
    const float value = of(data, trial);
    sum = sum.value_or(0.0) + (std::isnan(value) ? 0.0 : static_cast<double>(value));
  }
  return sum;
}

/// How motion spreads over the time, whatever there is of it: logarithms of shares, of all sensors and of each.
void FeatureMap::write_time(const DatasetStatistics& data, Writer& out) const {
  const auto write_shares = [&](std::size_t n, const auto& part, const std::string& owner) {
    std::vector<double> totals;
    for (std::size_t k = 0; k < n; ++k) {
      const std::optional<double> seconds = part(k);
      if (!seconds) return;
      totals.push_back(*seconds);
    }
    const double all = std::accumulate(totals.begin(), totals.end(), 0.0) + static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k) {
      out.test_next();
      out.add(std::log((totals[k] + 1.0) / all), [&] {
        return FeatureName{owner + ", part " + std::to_string(k + 1) + " of " + std::to_string(n) + " of the time",
                           "share_of_time"};
      });
    }
  };
  write_shares(
      n_slices,
      [&](std::size_t k) {
        return total(data, [&](const auto& all, std::size_t trial) {
          return all.trial(trial, nth_after(TrialStatistic::slice_1, k));
        });
      },
      "all sensors");
  for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
    write_shares(
        n_sixths,
        [&](std::size_t k) {
          return total(data, [&](const auto& all, std::size_t trial) {
            return all.cell(trial, sensor, nth_after(CellStatistic::sixth_1, k));
          });
        },
        frame_.sensors[sensor]);
  }
}

/// How much oftener than not a sensor moves while another does: logarithms of odds over all trials.
void FeatureMap::write_pairs(const DatasetStatistics& data, Writer& out) const {
  std::vector<double> odds;
  for (std::size_t first = 0; first < frame_.sensors.size(); ++first) {
    for (std::size_t second = 0; second < frame_.sensors.size(); ++second) {
      if (first == second) continue;
      const auto alone = total(data, [&](const auto& all, std::size_t t) { return all.pair(t, first, second); });
      const auto seconds =
          total(data, [&](const auto& all, std::size_t t) { return all.cell(t, second, CellStatistic::seconds); });
      if (!alone || !seconds) continue;
      const double together = std::max(0.0, *seconds / frame_.window_s - *alone);
      odds.push_back(std::log((together + 0.5) / (*alone + 0.5)));
      out.test_next();
      out.add(odds.back(), [&] {
        return FeatureName{frame_.sensors[first] + " while " + frame_.sensors[second] + " moves", "together"};
      });
    }
  }
  if (odds.empty()) return;
  out.add(*std::ranges::max_element(odds), [] { return FeatureName{"most together"}; });
  out.add(*std::ranges::min_element(odds), [] { return FeatureName{"least together"}; });
}

void FeatureMap::write_contrasts(const Scaled& data, Writer& out) const {
  for (const CellStatistic statistic : told_of_cells) {
    double count = 0.0, sum = 0.0, size = 0.0, greatest = -1e9, least = 1e9;
    std::vector<double> slopes(covariates_.size(), 0.0);
    for (const std::size_t trial : trials_) {
      for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
        if (!known(trial, sensor, statistic)) continue;
        const double value = data.cell(trial, sensor, statistic);
        count += 1.0;
        sum += value;
        size += std::abs(value);
        greatest = std::max(greatest, value);
        least = std::min(least, value);
        for (std::size_t c = 0; c < slopes.size(); ++c) slopes[c] += value * covariates_[c][frame_.cell(trial, sensor)];
      }
    }
    if (count == 0.0) continue;
    out.test_next();
    out.add(sum / count, [&] { return mean_of(name(statistic)); });
    out.test_next();
    out.add(size / count, [&] { return size_of(name(statistic)); });
    out.add(greatest, [&] { return FeatureName{"greatest " + name(statistic)}; });
    out.add(least, [&] { return FeatureName{"least " + name(statistic)}; });
    for (std::size_t c = 0; c < slopes.size(); ++c) {
      out.add(slopes[c] / count,
              [&] { return FeatureName{"slope on " + covariate_names_[c] + " of " + name(statistic)}; });
    }
  }
}

/// How far the cells of a sensor or of a trial are off before, in and after the main part, to whichever side: what was
/// knocked, or went otherwise, loses in one place what it gains in another.
void FeatureMap::write_wholes(const Scaled& data, Writer& out) const {
  const auto write = [&](const auto& trials, const auto& sensors, const std::string& whose,
                         std::string_view statistic) {
    double size = 0.0, count = 0.0;
    for (const std::size_t trial : trials) {
      for (const std::size_t sensor : sensors) {
        for (const auto part : {CellStatistic::lead_seconds, CellStatistic::seconds, CellStatistic::tail_seconds}) {
          if (!known(trial, sensor, part)) continue;
          size += std::abs(data.cell(trial, sensor, part));
          count += 1.0;
        }
      }
    }
    if (count < 2.0) return;  // of one number that tells it
    out.test_next();
    out.add(size / count, [&] { return FeatureName{whose + " as a whole", std::string(statistic), whose}; });
  };
  const std::vector<std::size_t> all = stats::numbers_to(frame_.sensors.size());
  for (const std::size_t sensor : all) write(trials_, std::array{sensor}, frame_.sensors[sensor], of_whole_sensor);
  for (const std::size_t trial : trials_) write(std::array{trial}, all, frame_.trials[trial], of_whole_trial);
}

double FeatureMap::likeness(std::span<const double> values, std::span<const std::size_t> trial_order,
                            std::span<const std::size_t> sensor_order) const {
  Correlation correlation;
  for (const std::size_t trial : trials_) {
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      const std::size_t from_trial = trial_order[trial], from_sensor = sensor_order[sensor];
      if (!known(trial, sensor, CellStatistic::seconds) || !known(from_trial, from_sensor, CellStatistic::seconds))
        continue;
      correlation.add(values[frame_.cell(trial, sensor)], expected_log_[frame_.cell(from_trial, from_sensor)]);
    }
  }
  return correlation.value();
}

void FeatureMap::write_permutations(const DatasetStatistics& data, Writer& out) const {
  const std::size_t n_trials = frame_.trials.size(), n_sensors = frame_.sensors.size();
  std::vector<double> values(frame_.n_cells(), 0.0);
  for (std::size_t trial = 0; trial < n_trials; ++trial) {
    for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
      const double seconds = seconds_of(data, trial, sensor);
      if (!std::isnan(seconds)) values[frame_.cell(trial, sensor)] = std::log1p(seconds);
    }
  }
  const std::vector<std::size_t> trials = stats::numbers_to(n_trials), sensors = stats::numbers_to(n_sensors);
  const double as_it_is = likeness(values, trials, sensors);
  out.add(as_it_is, [] { return FeatureName{"likeness"}; });
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
  const auto permute = [&](const std::vector<std::size_t>& order, const std::string& what, const auto& likeness_of) {
    if (order.size() < 2) return;
    const auto add = [&](double more, const std::string& by) {
      out.add(more, [&] { return FeatureName{"likeness gained by " + by}; });
    };
    add(likeness_of(rotated(order, 1)) - as_it_is, what + " shifted by one");
    add(likeness_of(rotated(order, -1)) - as_it_is, what + " shifted back by one");
    add(likeness_of(std::vector(order.rbegin(), order.rend())) - as_it_is, what + " in reverse");
    add(best_swap(order, likeness_of), "two " + what + " swapped");
  };
  permute(trials, "trials", [&](const auto& order) { return likeness(values, order, sensors); });
  permute(sensors, "sensors", [&](const auto& order) { return likeness(values, trials, order); });
}

void FeatureMap::write_all(const DatasetStatistics& statistics, Writer& out) const {
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
  write_wholes(data, out);
  out.end_block();
  write_permutations(statistics, out);
  out.end_block();
}

}  // namespace pirsim::reconcile
