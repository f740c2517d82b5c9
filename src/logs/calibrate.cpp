#include "logs/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "logs/counter.hpp"
#include "model/core/parallel.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/error.hpp"
#include "stats/intervals.hpp"
#include "stats/linear_algebra.hpp"

namespace pirsim::calibrate {
namespace {

std::vector<std::size_t> order_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
  return order;
}

/// The least value that so much of the weight doesn't exceed.
double weighted_quantile(std::span<const double> values, std::span<const double> weights, double probability) {
  const double wanted = probability * std::accumulate(weights.begin(), weights.end(), 0.0);
  double reached = 0.0, last = 0.0;
  for (const std::size_t i : order_of(values)) {
    if (!(weights[i] > 0.0)) continue;
    last = values[i];
    reached += weights[i];
    if (reached >= wanted) break;
  }
  return last;
}

std::vector<double> ranks(std::span<const double> values) {
  const std::vector<std::size_t> order = order_of(values);
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return ranks;
}

using counting::Counter, counting::Estimates, counting::LabelledRoom, counting::Stretch;

std::vector<double> weights_of(const Counter& counter) {
  std::vector<double> weights;
  for (const counting::RoomModel& room : counter.rooms) weights.push_back(room.weight);
  return weights;
}

struct Mean {
  double sum = 0.0, n = 0.0;
  void add(double value) { sum += value, n += 1.0; }
  [[nodiscard]] std::optional<double> value() const { return n > 0.0 ? std::optional(sum / n) : std::nullopt; }
};

void add_error(const Estimates& told, const std::vector<int>& people, double step_s, Mean& error) {
  const std::vector<bool> counts = in_use(people, step_s);
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (counts[i] && people[i] != counting::unknown_count) error.add(std::abs(told.count(i) - people[i]));
  }
}

/// How far off the counts are by their own probabilities, of readings in use by themselves.
void add_own_statement(const Estimates& told, double step_s, Mean& statement) {
  std::vector<int> people(told.probabilities.size() / counting::size(told.n_counts));
  for (std::size_t i = 0; i < people.size(); ++i) people[i] = told.count(i);
  const std::vector<bool> counts = in_use(people, step_s);
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (!counts[i] || !told.is_told(i)) continue;
    double expected = 0.0;
    for (int n = 0; n < told.n_counts; ++n)
      expected += told.probabilities[i * counting::size(told.n_counts) + counting::size(n)] * std::abs(n - people[i]);
    statement.add(expected);
  }
}

struct ErrorOfRoom {
  std::optional<double> weighed;
  std::optional<double> stated;  ///< what the weighed counter itself expects
  std::optional<double> alike;   ///< by all rooms alike, as lively as they are
  FigureErrors figures{};
};

/// A room's days, on average.
double days_of_rooms(std::span<const PoolRoom> rooms) {
  Mean days;
  for (const PoolRoom& room : rooms) days.add(static_cast<double>(room.labelled.days.size()));
  return days.value().value_or(1.0);
}

/// Known readings by those of a room's day: 0 to infinity.
double days_of_log(std::span<const counting::Stretch> log, std::span<const PoolRoom> rooms) {
  double known = 0.0;
  for (const counting::Stretch& stretch : log) {
    for (const counting::Reading& reading : counting::readings_of(stretch)) known += reading.known > 0 ? 1.0 : 0.0;
  }
  Mean of_day;
  for (const PoolRoom& room : rooms) {
    for (const counting::Stretch& day : room.labelled.days) of_day.add(static_cast<double>(day.n_readings()));
  }
  return known / of_day.value().value_or(1.0);
}

std::size_t n_versions(const Counter& counter) { return counter.settings.livelinesses.size(); }

/// (rooms) those of their versions together.
std::vector<double> room_weights(const Counter& counter) {
  std::vector<double> weights(counter.rooms.size() / n_versions(counter), 0.0);
  for (std::size_t i = 0; i < counter.rooms.size(); ++i) weights[i / n_versions(counter)] += counter.rooms[i].weight;
  return weights;
}

/// What the log determined of how lively people are, whatever the room.
ParameterRange liveliness_of(const Counter& counter) {
  std::vector<double> odds;
  for (const counting::RoomModel& room : counter.rooms) odds.push_back(room.liveliness);
  const std::vector<double> weights = weights_of(counter), alike(odds.size(), 1.0);
  return {"liveliness",
          weighted_interval(odds, alike),
          weighted_interval(odds, weights),
          weighted_mean(odds, alike),
          weighted_mean(odds, weights),
          std::max(0.0, 1.0 - weighted_sd(odds, weights) / weighted_sd(odds, alike))};
}

/// The room's own models count nothing.
ErrorOfRoom error_of_room(const Counter& counter, const LabelledRoom& room) {
  std::vector<counting::Stretch> log = room.days;
  for (counting::Stretch& day : log) day.people.clear();
  std::vector<double> scores = counting::log_likelihoods(counter, log);
  Counter weighed = counter, alike = counter;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const bool is_own = counter.rooms[i].number == room.number;
    if (is_own) scores[i] = -std::numeric_limits<double>::infinity();
    alike.rooms[i].weight = is_own || counter.rooms[i].liveliness != 1.0 ? 0.0 : 1.0;
  }
  counting::weigh(weighed, scores);
  const auto n_others = static_cast<double>(std::ranges::count(alike.rooms, 1.0, &counting::RoomModel::weight));
  for (counting::RoomModel& model : alike.rooms) model.weight /= n_others;
  Mean weighed_error, statement, alike_error;
  const double step_s = counter.settings.step_s;
  std::vector<Estimates> told;
  for (std::size_t d = 0; d < log.size(); ++d) {
    told.push_back(counting::estimate(weighed, log[d], counting::Pass::smoothed));
    add_error(told.back(), room.days[d].people, step_s, weighed_error);
    add_own_statement(told.back(), step_s, statement);
    add_error(counting::estimate(alike, log[d], counting::Pass::smoothed), room.days[d].people, step_s, alike_error);
  }
  return {weighed_error.value(), statement.value(), alike_error.value(), figure_errors(told, room.days, step_s)};
}

/// Of row i from the mean of the others, by their covariance.
double distance_from_others(const Eigen::MatrixXd& rows, Eigen::Index i) {
  constexpr double ridge = 0.05;  // of each variance: statistics that nearly follow from others; assumed, 0.02-0.2
  constexpr double least = 1e-9;  // of a statistic that is the same in all rooms
  const auto n = static_cast<double>(rows.rows() - 1);
  const Eigen::RowVectorXd mean = (rows.colwise().sum() - rows.row(i)) / n;
  Eigen::MatrixXd centred = rows.rowwise() - mean;
  centred.row(i).setZero();
  Eigen::MatrixXd covariance = centred.transpose() * centred / (n - 1.0);
  const Eigen::VectorXd variances = covariance.diagonal();
  covariance.diagonal() += ridge * variances + Eigen::VectorXd::Constant(variances.size(), least);
  const Eigen::VectorXd away = (rows.row(i) - mean).transpose();
  return away.dot(stats::detail::solve_symmetric(covariance, away));
}

/// Share of the rows that are at least as far from the others as the last is.
double share_as_far(const Eigen::MatrixXd& all) {
  const double own = distance_from_others(all, all.rows() - 1);
  int as_far = 1;
  for (Eigen::Index i = 0; i + 1 < all.rows(); ++i) as_far += distance_from_others(all, i) >= own ? 1 : 0;
  return static_cast<double>(as_far) / static_cast<double>(all.rows());
}

constexpr double window_min = 5.0, pause_min = 10.0, busy_share = 0.7;
constexpr int least_readings_with_motion = 20;

std::uint8_t bit(const Stretch& stretch, std::size_t reading, int sensor) {
  return stretch.motion[reading * static_cast<std::size_t>(stretch.n_sensors) + static_cast<std::size_t>(sensor)];
}

/// Readings from the first to the last with motion; an unknown bit counts as none.
struct Active {
  std::size_t begin = 0, end = 0, with_motion = 0;
  std::vector<char> any;  ///< (end - begin)
};

Active active_part(const Stretch& stretch) {
  Active active;
  std::vector<char> any(stretch.n_readings(), 0);
  for (std::size_t i = 0; i < any.size(); ++i) {
    for (int k = 0; k < stretch.n_sensors; ++k) any[i] = any[i] != 0 || bit(stretch, i, k) == 1 ? 1 : 0;
    if (any[i] == 0) continue;
    if (active.with_motion++ == 0) active.begin = i;
    active.end = i + 1;
  }
  active.any.assign(any.begin() + static_cast<std::ptrdiff_t>(active.begin),
                    any.begin() + static_cast<std::ptrdiff_t>(active.end));
  return active;
}

/// Share of a sensor's known readings with motion.
double share(const Stretch& stretch, int sensor, std::size_t begin, std::size_t end) {
  std::size_t known = 0, motion = 0;
  for (std::size_t i = begin; i < end; ++i) {
    known += bit(stretch, i, sensor) == counting::unknown_bit ? 0 : 1;
    motion += bit(stretch, i, sensor) == 1 ? 1 : 0;
  }
  return known == 0 ? 0.0 : static_cast<double>(motion) / static_cast<double>(known);
}

/// Phi coefficient of the first and the last sensor; 0 where one of them never changes.
double likeness(const Stretch& stretch, const Active& active) {
  double n = 0, a = 0, b = 0, both = 0;
  for (std::size_t i = active.begin; i < active.end; ++i) {
    const std::uint8_t x = bit(stretch, i, 0), y = bit(stretch, i, stretch.n_sensors - 1);
    if (x == counting::unknown_bit || y == counting::unknown_bit) continue;
    n += 1;
    a += x;
    b += y;
    both += x * y;
  }
  const double spread = a * (n - a) * b * (n - b);
  return spread > 0.0 ? (n * both - a * b) / std::sqrt(spread) : 0.0;
}

/// The most that a sensor is silent for at a time while another reports, as a share of the readings with motion.
double longest_silence(const Stretch& stretch, const Active& active) {
  std::size_t longest = 0;
  for (int k = 0; k < stretch.n_sensors; ++k) {
    std::size_t silent = 0;
    for (std::size_t i = active.begin; i < active.end; ++i) {
      if (active.any[i - active.begin] == 0 || bit(stretch, i, k) == counting::unknown_bit) continue;
      silent = bit(stretch, i, k) == 1 ? 0 : silent + 1;
      longest = std::max(longest, silent);
    }
  }
  return static_cast<double>(longest) / static_cast<double>(active.with_motion);
}

/// Of the readings with motion of the sensor that has most such: the share before and after which none reports.
double lone_motion(const Stretch& stretch, const Active& active) {
  constexpr std::size_t fewest = 6;  // readings with motion of a sensor, of fewer a share says nothing
  const auto any = [&](std::size_t i) {
    return i >= active.begin && i < active.end && active.any[i - active.begin] != 0;
  };
  double most = 0.0;
  for (int k = 0; k < stretch.n_sensors; ++k) {
    std::size_t motion = 0, lone = 0;
    for (std::size_t i = active.begin; i < active.end; ++i) {
      if (bit(stretch, i, k) != 1) continue;
      ++motion;
      lone += any(i + 1) || (i > 0 && any(i - 1)) ? 0 : 1;
    }
    if (motion >= fewest) most = std::max(most, static_cast<double>(lone) / static_cast<double>(motion));
  }
  return most;
}

/// Lengths of runs without and with motion, in readings.
struct Runs {
  std::vector<std::size_t> without, with;
};

Runs runs_of(const Active& active) {
  Runs runs;
  for (std::size_t i = 0; i < active.any.size();) {
    std::size_t end = i;
    while (end < active.any.size() && active.any[end] == active.any[i]) ++end;
    (active.any[i] != 0 ? runs.with : runs.without).push_back(end - i);
    i = end;
  }
  return runs;
}

double log_mean(const std::vector<std::size_t>& lengths) {
  double sum = 0.0;
  for (const std::size_t length : lengths) sum += static_cast<double>(length);
  return lengths.empty() ? 0.0 : std::log(sum / static_cast<double>(lengths.size()));
}

/// Shares of readings before which 5 min were quiet, and busy, for the busiest sensor.
std::pair<double, double> quiet_and_busy(const Stretch& stretch, const Active& active, double step_s) {
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(window_min * minute_s / step_s)));
  std::size_t quiet = 0, busy = 0;
  for (std::size_t i = active.begin; i < active.end; ++i) {
    double most = 0.0;
    for (int k = 0; k < stretch.n_sensors; ++k)
      most = std::max(most, share(stretch, k, i + 1 < window ? 0 : i + 1 - window, i + 1));
    quiet += most == 0.0 ? 1 : 0;
    busy += most > busy_share ? 1 : 0;
  }
  const auto n = static_cast<double>(active.any.size());
  return {static_cast<double>(quiet) / n, static_cast<double>(busy) / n};
}

std::vector<double> of_stretch(const Stretch& stretch, const Active& active, double step_s) {
  std::vector<double> shares;
  for (int k = 0; k < stretch.n_sensors; ++k) shares.push_back(share(stretch, k, active.begin, active.end));
  const auto [least, most] = std::ranges::minmax(shares);
  const double n = static_cast<double>(active.any.size()), hours = n * step_s / hour_s;
  const Runs runs = runs_of(active);
  const auto [quiet, busy] = quiet_and_busy(stretch, active, step_s);
  const auto pauses = std::ranges::count_if(
      runs.without, [&](std::size_t length) { return static_cast<double>(length) * step_s > pause_min * minute_s; });
  std::vector<double> values{most,
                             static_cast<double>(active.with_motion) / n,
                             log_mean(runs.with),
                             log_mean(runs.without),
                             quiet,
                             busy,
                             hours,
                             static_cast<double>(pauses) / hours,
                             static_cast<double>(active.begin) * step_s / hour_s,
                             lone_motion(stretch, active)};
  if (stretch.n_sensors > 1) {
    values.push_back(least);
    values.push_back(likeness(stretch, active));
    values.push_back(longest_silence(stretch, active));
  }
  return values;
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

/// Those of motion, which make the verdict; without: but for this one.
std::vector<std::size_t> verdicts_columns(int n_sensors, std::optional<std::size_t> without = {}) {
  const std::vector<StatisticInfo> infos = statistics_of(n_sensors);
  std::vector<std::size_t> columns;
  for (std::size_t s = 0; s < infos.size(); ++s) {
    if (infos[s].about == Statistic::About::motion && s != without) columns.push_back(s);
  }
  return columns;
}

/// The rooms, and the log as the last row, of some statistics.
Eigen::MatrixXd with_log(const RoomStatistics& known, const std::vector<double>& of_log,
                         const std::vector<std::size_t>& columns) {
  const auto n = static_cast<Eigen::Index>(known.rows.rows());
  Eigen::MatrixXd all(n + 1, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    for (Eigen::Index i = 0; i < n; ++i) all(i, column) = known.rows(static_cast<std::size_t>(i), columns[c]);
    all(n, column) = of_log[columns[c]];
  }
  return all;
}

/// Says of what is unlike the rooms what that is a sign of. If they are so only together, of the two that weigh most.
void tell_signs(const std::vector<StatisticInfo>& infos, Verdict verdict, std::vector<Statistic>& statistics) {
  using About = Statistic::About;
  const auto speaks = [](const Statistic& one) { return one.about == About::motion && one.p <= verdict_level; };
  double least_share = 2.0;  // more than all
  if (verdict == Verdict::none_like_it && std::ranges::none_of(statistics, speaks)) {
    std::vector<double> shares;
    for (const Statistic& one : statistics) shares.push_back(one.share);
    std::ranges::sort(shares, std::greater{});
    least_share = shares[1];
  }
  for (std::size_t s = 0; s < statistics.size(); ++s) {
    Statistic& one = statistics[s];
    const bool is_more = one.of_log > 0.5 * (one.of_rooms.low + one.of_rooms.high);
    if (one.p <= verdict_level || (one.about == About::motion && one.share >= least_share))
      one.sign = is_more ? infos[s].more : infos[s].less;
  }
}

Interval told(const StatisticInfo& info, const Interval& values, double step_s) {
  return {told(info, values.low, step_s), told(info, values.high, step_s)};
}

std::vector<Statistic> compared(std::span<const PoolRoom> pool, const RoomStatistics& known,
                                const std::vector<double>& of_log, const std::vector<double>& weights,
                                const counting::Counter& counter, Verdict verdict) {
  const double step_s = counter.settings.step_s;
  std::vector<double> own_weights;
  for (const std::size_t r : known.rooms) own_weights.push_back(weights[r]);
  const std::vector<double> alike(known.rooms.size(), 1.0);
  const std::vector<StatisticInfo> infos = statistics_of(counter.n_sensors);
  const auto distance = [&](std::optional<std::size_t> without) {
    const Eigen::MatrixXd rows = with_log(known, of_log, verdicts_columns(counter.n_sensors, without));
    return distance_from_others(rows, rows.rows() - 1);
  };
  const double whole = distance({});
  std::vector<Statistic> all;
  for (std::size_t s = 0; s < infos.size(); ++s) {
    std::vector<double> values;
    for (std::size_t i = 0; i < known.rooms.size(); ++i) values.push_back(known.rows(i, s));
    const StatisticInfo& info = infos[s];
    Statistic& one = all.emplace_back(Statistic{.name = info.name, .unit = info.unit, .about = info.about});
    one.of_log = told(info, of_log[s], step_s);
    one.of_rooms = told(info, weighted_interval(values, alike), step_s);
    one.of_weighty = told(info, weighted_interval(values, own_weights), step_s);
    one.p = unlike_share(values, of_log[s]);
    if (info.about == Statistic::About::motion && whole > 0.0) one.share = std::max(0.0, 1.0 - distance(s) / whole);
  }
  tell_signs(infos, verdict, all);
  for (std::size_t s = 0; s < infos.size(); ++s) {
    if (all[s].sign.empty() || all[s].about == Statistic::About::schedule) continue;
    all[s].advice = advice_for(pool, known, s, all[s].of_log - 0.5 * (all[s].of_rooms.low + all[s].of_rooms.high));
  }
  return all;
}

}  // namespace

double weighted_mean(std::span<const double> values, std::span<const double> weights) {
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0) /
         std::accumulate(weights.begin(), weights.end(), 0.0);
}

double weighted_sd(std::span<const double> values, std::span<const double> weights) {
  const double mean = weighted_mean(values, weights);
  std::vector<double> squares;
  for (const double value : values) squares.push_back((value - mean) * (value - mean));
  return std::sqrt(weighted_mean(squares, weights));
}

Interval weighted_interval(std::span<const double> values, std::span<const double> weights) {
  constexpr double tail = 0.05;
  return {weighted_quantile(values, weights, tail), weighted_quantile(values, weights, 1.0 - tail)};
}

double rank_correlation(std::span<const double> x, std::span<const double> y) {
  constexpr std::size_t fewest = 3;
  if (x.size() < fewest) return 0.0;
  const std::vector<double> a = ranks(x), b = ranks(y), one(x.size(), 1.0);
  const double spread = weighted_sd(a, one) * weighted_sd(b, one);
  if (!(spread > 0.0)) return 0.0;
  const double product = std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / static_cast<double>(x.size());
  return (product - weighted_mean(a, one) * weighted_mean(b, one)) / spread;
}

std::vector<bool> in_use(const std::vector<int>& people, double step_s) {
  constexpr double around_s = 1800.0;
  const auto around = static_cast<std::ptrdiff_t>(std::lround(around_s / step_s));
  const auto is_there = [](int n) { return n > 0; };
  const auto first = std::ranges::find_if(people, is_there);
  std::vector<bool> counts(people.size(), false);
  if (first == people.end()) return counts;
  const auto last = std::find_if(people.rbegin(), people.rend(), is_there).base();  // one beyond
  const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, first - people.begin() - around);
  const std::ptrdiff_t to = std::min(std::ssize(people), last - people.begin() + around);
  std::fill(counts.begin() + from, counts.begin() + to, true);
  return counts;
}

RoomErrors errors_of_rooms(const Counter& counter, std::span<const LabelledRoom> rooms, unsigned threads) {
  RoomErrors errors;
  ordered_parallel<ErrorOfRoom>(
      rooms.size(), threads, [&](std::size_t r) { return error_of_room(counter, rooms[r]); },
      [&](ErrorOfRoom& one) {
        errors.weighed.push_back(one.weighed);
        errors.stated.push_back(one.stated);
        errors.alike.push_back(one.alike);
        for (std::size_t f = 0; f < one.figures.size(); ++f)
          errors.figures[f].insert(errors.figures[f].end(), one.figures[f].begin(), one.figures[f].end());
      });
  return errors;
}

void expect_error(const RoomErrors& errors, std::span<const double> weights, double stated, Calibration& made) {
  std::vector<double> weighed, alike, own_weights;
  Mean statement;
  for (std::size_t r = 0; r < weights.size(); ++r) {
    if (!errors.weighed[r] || !errors.alike[r]) continue;
    weighed.push_back(*errors.weighed[r]);
    alike.push_back(*errors.alike[r]);
    own_weights.push_back(weights[r]);
    if (errors.stated[r]) statement.add(*errors.stated[r]);
  }
  const bool says_nothing = std::ranges::all_of(own_weights, [](double weight) { return weight == 0.0; });
  if (says_nothing) return;  // nobody was ever in the rooms that have any weight
  const double times = statement.value() && stated > *statement.value() ? stated / *statement.value() : 1.0;
  for (std::vector<double>* errors_of : {&weighed, &alike}) {
    for (double& error : *errors_of) error *= times;
  }
  made.mean_error = weighted_mean(weighed, own_weights);
  made.error_alike = weighted_mean(alike, own_weights);
  made.counter.expected_error = weighted_interval(weighed, std::vector(weighed.size(), 1.0));
  made.counter.figures_off = figures_off(errors.figures, times, made.counter.settings.step_s);
}

double unlike_share(const stats::Matrix<double>& rows, std::span<const double> vector) {
  Eigen::MatrixXd all(static_cast<Eigen::Index>(rows.rows() + 1), static_cast<Eigen::Index>(rows.columns()));
  all.topRows(all.rows() - 1) = stats::detail::as_eigen(rows);
  all.bottomRows(1) = stats::detail::as_eigen(vector).transpose();
  return share_as_far(all);
}

double unlike_share(std::span<const double> values, double value) {
  std::vector<double> all(values.begin(), values.end());
  all.push_back(value);
  const double middle = stats::quantile(all, 0.5), own = std::abs(value - middle);
  const auto as_far = std::ranges::count_if(all, [&](double other) { return std::abs(other - middle) >= own; });
  return static_cast<double>(as_far) / static_cast<double>(all.size());
}

double told(const StatisticInfo& info, double value, double step_s) {
  return info.scale == StatisticInfo::Scale::plain ? value : std::exp(value) * step_s / minute_s;
}

std::vector<StatisticInfo> statistics_of(int n_sensors) {
  using enum StatisticInfo::Scale;
  using enum Statistic::About;
  const std::string busy = "a fan, a pet, or livelier people",
                    quiet = "fewer or quieter people, or sensors that notice less",
                    lost = "a sensor that died, is covered or looks elsewhere",
                    alike = "sensors that look at the same place, or what all of them see";
  std::vector<StatisticInfo> all{
      {"readings with motion, busiest sensor", "share", plain, motion, busy, quiet},
      {"readings with motion, any sensor", "share", plain, motion, busy, quiet},
      {"mean run with motion", "min", logarithm, motion, "livelier people, or sensors that hold motion for longer",
       "sensors that hold motion for a shorter time, or notice less"},
      {"mean run without", "min", logarithm, motion, quiet, busy},
      {"5 min without motion", "share", plain, motion, quiet, busy},
      {"5 min with motion in more than 70 %", "share", plain, motion, busy, quiet},
      {"from first to last motion", "h", plain, schedule,
       "let the schedule's `arrival` be earlier, or `departure` later",
       "let the schedule's `arrival` be later, or `departure` earlier"},
      {"pauses longer than 10 min", "1/h", plain, motion, "people who leave more often or sit where nothing sees them",
       busy},
      {"first motion after the hours begin", "h", plain, schedule,
       "let the schedule's `arrival` be later, and `from` with it",
       "let the schedule's `arrival` be earlier, and `from` with it"},
      {"motion in one reading alone, most of a sensor", "share", plain, motion, "a fan, or false motion",
       "livelier people, or sensors that hold motion for longer"}};
  if (n_sensors > 1) {
    all.push_back({"readings with motion, quietest sensor", "share", plain, motion, busy, lost});
    all.push_back({"likeness of first and last sensor", "phi", plain, motion, alike, lost + ", or sees a fan"});
    all.push_back({"longest silence of a sensor while another reports", "share", plain, motion, lost, alike});
  }
  return all;
}

std::vector<std::vector<double>> motion_statistics(std::span<const Stretch> stretches, double step_s) {
  std::vector<std::vector<double>> all;
  for (const Stretch& stretch : stretches) {
    const Active active = active_part(stretch);
    if (active.with_motion >= least_readings_with_motion) all.push_back(of_stretch(stretch, active, step_s));
  }
  return all;
}

struct Pool::Parts {
  std::vector<PoolRoom> rooms;
  counting::Counter counter;
  RoomErrors errors;
  std::vector<DayStatistics> days;
};

Pool::Pool(std::vector<PoolRoom> rooms, const counting::Settings& settings, unsigned threads) {
  if (rooms.size() < fewest_rooms) {
    throw Error(ErrorCode::input, "a calibration needs " + std::to_string(fewest_rooms) +
                                      " rooms at least, better 60; there are " + std::to_string(rooms.size()));
  }
  std::vector<counting::LabelledRoom> labelled;
  for (const PoolRoom& room : rooms) labelled.push_back(room.labelled);
  counting::Counter counter = counting::at_livelinesses(counting::train(labelled, settings, threads));
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
  std::vector<double> scores = counting::log_likelihoods(counter, log);
  // Left-out rooms have shown what so many days say; more are taken to say no more, since they have the room in common.
  const double times = std::min(1.0, days_of_rooms(rooms) / days_of_log(log, rooms));
  for (double& score : scores) score *= times;
  counting::weigh(made.counter, scores);
  Mean stated;
  for (const Stretch& stretch : log)
    add_own_statement(counting::estimate(made.counter, stretch, counting::Pass::smoothed), counter.settings.step_s,
                      stated);
  const std::vector<double> weights = room_weights(made.counter);
  made.effective_rooms = 1.0 / std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
  for (std::size_t r = 0; r < rooms.size(); ++r) {
    const auto versions = std::span(scores).subspan(r * n_versions(counter), n_versions(counter));
    made.rooms.push_back(
        {rooms[r].labelled.number, *std::ranges::max_element(versions), weights[r], errors.weighed[r]});
  }
  expect_error(errors, weights, stated.value().value_or(0.0), made);
  made.parameters = parameter_ranges(rooms, weights);
  if (n_versions(counter) > 1) made.parameters.insert(made.parameters.begin(), liveliness_of(made.counter));
  const DayStatistics log_days = motion_statistics(days, counter.settings.step_s);
  if (log_days.empty()) return made;
  const RoomStatistics known = room_statistics(room_days, log_days.size());
  if (known.rooms.size() < fewest_rooms) return made;
  const std::vector<double> of_log = mean_of_first(log_days, log_days.size());
  made.p = share_as_far(with_log(known, of_log, verdicts_columns(counter.n_sensors)));
  made.verdict = made.p <= verdict_level ? Verdict::none_like_it : Verdict::like_these;
  made.counter.warning = warning_of(made.verdict);
  made.statistics = compared(rooms, known, of_log, weights, made.counter, made.verdict);
  return made;
}

}  // namespace pirsim::calibrate
