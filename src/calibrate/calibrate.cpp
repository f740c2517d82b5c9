#include "pirsim/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "calibrate/errors.hpp"
#include "calibrate/motion_statistics.hpp"
#include "calibrate/room_check.hpp"
#include "calibrate/weighted.hpp"
#include "core/parallel.hpp"
#include "pirsim/error.hpp"

namespace pirsim::calibrate {
namespace {

using counting::Stretch;

std::vector<double> weights_of(const counting::Counter& counter) {
  std::vector<double> weights;
  for (const counting::RoomModel& room : counter.rooms) weights.push_back(room.weight);
  return weights;
}

// -- parameters ------------------------------------------------------------------------------------------------------

/// Of the rooms that have the parameter; the others' weights are 0.
struct ParameterValues {
  std::vector<double> values, has;
};

ParameterValues values_of(std::span<const PoolRoom> pool, const std::string& name) {
  ParameterValues all;
  for (const PoolRoom& room : pool) {
    const auto found = room.parameters.find(name);
    all.values.push_back(found == room.parameters.end() ? 0.0 : found->second);
    all.has.push_back(found == room.parameters.end() ? 0.0 : 1.0);
  }
  return all;
}

std::vector<std::string> names_of(std::span<const PoolRoom> pool) {
  std::map<std::string, int> names;
  for (const PoolRoom& room : pool) {
    for (const auto& [name, value] : room.parameters) ++names[name];
  }
  constexpr int fewest = 5;  // rooms that have it: of fewer nothing can be said
  std::vector<std::string> often;
  for (const auto& [name, n] : names) {
    if (n >= fewest) often.push_back(name);
  }
  return often;
}

std::vector<ParameterRange> parameter_ranges(std::span<const PoolRoom> pool, const std::vector<double>& weights) {
  std::vector<ParameterRange> ranges;
  for (const std::string& name : names_of(pool)) {
    const ParameterValues all = values_of(pool, name);
    std::vector<double> weighed = all.has;
    for (std::size_t r = 0; r < pool.size(); ++r) weighed[r] *= weights[r];
    if (std::ranges::none_of(weighed, [](double weight) { return weight > 0.0; })) continue;
    const double spread = weighted_sd(all.values, all.has);
    constexpr double least_share = 1e-9;  // of the mean: what all rooms share differs in its last digits
    if (!(spread > least_share * std::abs(weighted_mean(all.values, all.has)))) continue;
    ranges.push_back({name, weighted_interval(all.values, all.has), weighted_interval(all.values, weighed),
                      weighted_mean(all.values, all.has), weighted_mean(all.values, weighed),
                      std::max(0.0, 1.0 - weighted_sd(all.values, weighed) / spread)});
  }
  std::ranges::stable_sort(ranges, std::greater{}, &ParameterRange::narrowed);
  return ranges;
}

// -- the check -------------------------------------------------------------------------------------------------------

/// Rooms that have statistics, as rows, and which rooms they are.
struct RoomStatistics {
  stats::Matrix<double> rows;
  std::vector<std::size_t> rooms;
};

/// Of each day of a room that tells enough.
using DayStatistics = std::vector<std::vector<double>>;

std::vector<DayStatistics> day_statistics(std::span<const PoolRoom> pool, double step_s, unsigned threads) {
  std::vector<DayStatistics> all;
  ordered_parallel<DayStatistics>(
      pool.size(), threads, [&](std::size_t r) { return motion_statistics(pool[r].labelled.days, step_s); },
      [&](DayStatistics& one) { all.push_back(std::move(one)); });
  return all;
}

std::vector<double> mean_of_first(const DayStatistics& days, std::size_t n_days) {
  const std::size_t n = std::min(n_days, days.size());
  std::vector<double> means(days.front().size(), 0.0);
  for (std::size_t d = 0; d < n; ++d) {
    for (std::size_t s = 0; s < means.size(); ++s) means[s] += days[d][s] / static_cast<double>(n);
  }
  return means;
}

/// Of as many days as the log has: one day scatters more than the mean of three.
RoomStatistics room_statistics(const std::vector<DayStatistics>& days, std::size_t n_days) {
  std::vector<double> values;
  std::vector<std::size_t> rooms;
  for (std::size_t r = 0; r < days.size(); ++r) {
    if (days[r].empty()) continue;
    std::ranges::copy(mean_of_first(days[r], n_days), std::back_inserter(values));
    rooms.push_back(r);
  }
  stats::Matrix<double> rows(rooms.size(), rooms.empty() ? 0 : values.size() / rooms.size());
  std::ranges::copy(values, rows.values().begin());
  return {std::move(rows), std::move(rooms)};
}

/// Which parameter of the recipe moves a statistic the way that it would have to go, if one does.
std::string advice_for(std::span<const PoolRoom> pool, const RoomStatistics& known, std::size_t statistic,
                       double lack) {
  // Chance alone brings that in one of a hundred.
  const double least_correlation = 2.6 / std::sqrt(static_cast<double>(std::max<std::size_t>(1, known.rooms.size())));
  std::string best;
  double most = least_correlation;
  for (const std::string& name : names_of(pool)) {
    const ParameterValues all = values_of(pool, name);
    std::vector<double> x, y;
    for (std::size_t i = 0; i < known.rooms.size(); ++i) {
      if (all.has[known.rooms[i]] == 0.0) continue;
      x.push_back(all.values[known.rooms[i]]);
      y.push_back(known.rows(i, statistic));
    }
    const double correlation = rank_correlation(x, y);
    if (std::abs(correlation) <= most) continue;
    most = std::abs(correlation);
    best = ((correlation > 0.0) == (lack > 0.0) ? "more " : "less ") + name;
  }
  return best;
}

Interval told(const StatisticInfo& info, const Interval& values, double step_s) {
  return {told(info, values.low, step_s), told(info, values.high, step_s)};
}

std::vector<Statistic> compared(std::span<const PoolRoom> pool, const RoomStatistics& known,
                                const std::vector<double>& of_log, const counting::Counter& counter) {
  const std::vector<double> weights = weights_of(counter);
  const double step_s = counter.settings.step_s;
  std::vector<double> own_weights;
  for (const std::size_t r : known.rooms) own_weights.push_back(weights[r]);
  const std::vector<double> alike(known.rooms.size(), 1.0);
  const std::vector<StatisticInfo> infos = statistics_of(counter.n_sensors);
  std::vector<Statistic> all;
  for (std::size_t s = 0; s < infos.size(); ++s) {
    std::vector<double> values;
    for (std::size_t i = 0; i < known.rooms.size(); ++i) values.push_back(known.rows(i, s));
    const StatisticInfo& info = infos[s];
    Statistic& one = all.emplace_back(Statistic{info.name,
                                                info.unit,
                                                told(info, of_log[s], step_s),
                                                told(info, weighted_interval(values, alike), step_s),
                                                told(info, weighted_interval(values, own_weights), step_s),
                                                unlike_share(values, of_log[s]),
                                                {}});
    if (one.p <= verdict_level) one.advice = advice_for(pool, known, s, of_log[s] - weighted_mean(values, alike));
  }
  return all;
}

}  // namespace

struct Pool::Parts {
  std::vector<PoolRoom> rooms;
  counting::Counter counter;
  RoomErrors errors;
  std::vector<DayStatistics> days;
};

Pool::Pool(std::vector<PoolRoom> rooms, const counting::Settings& settings, unsigned threads) {
  constexpr std::size_t fewest = fewest_rooms;
  if (rooms.size() < fewest) {
    throw Error(ErrorCode::input, "a calibration needs " + std::to_string(fewest) +
                                      " rooms at least, better 60; there are " + std::to_string(rooms.size()));
  }
  std::vector<counting::LabelledRoom> labelled;
  for (const PoolRoom& room : rooms) labelled.push_back(room.labelled);
  counting::Counter counter = counting::train(labelled, settings, threads);
  RoomErrors errors = errors_of_rooms(counter, labelled, threads);
  std::vector<DayStatistics> days = day_statistics(rooms, settings.step_s, threads);
  parts_ =
      std::make_shared<const Parts>(Parts{std::move(rooms), std::move(counter), std::move(errors), std::move(days)});
}

std::span<const PoolRoom> Pool::rooms() const noexcept { return parts_->rooms; }

Calibration Pool::calibrate(std::span<const Stretch> log, std::span<const Stretch> days) const {
  const auto& [rooms, counter, errors, room_days] = *parts_;
  Calibration made;
  made.counter = counter;
  const std::vector<double> scores = counting::log_likelihoods(counter, log);
  counting::weigh(made.counter, scores);
  const std::vector<double> weights = weights_of(made.counter);
  made.effective_rooms = 1.0 / std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
  for (std::size_t r = 0; r < rooms.size(); ++r)
    made.rooms.push_back({rooms[r].labelled.number, scores[r], weights[r], errors.weighed[r]});
  expect_error(errors, weights, made);
  made.parameters = parameter_ranges(rooms, weights);
  const DayStatistics log_days = motion_statistics(days, counter.settings.step_s);
  if (log_days.empty()) return made;
  const RoomStatistics known = room_statistics(room_days, log_days.size());
  if (known.rooms.size() < fewest_rooms) return made;
  const std::vector<double> of_log = mean_of_first(log_days, log_days.size());
  made.p = unlike_share(known.rows, of_log);
  made.verdict = made.p <= verdict_level ? Verdict::none_like_it : Verdict::like_these;
  if (made.verdict == Verdict::none_like_it)
    made.counter.warning = "Hardly a room that this counter comes from makes such a log: don't rely on its counts.";
  made.statistics = compared(rooms, known, of_log, made.counter);
  return made;
}

}  // namespace pirsim::calibrate
