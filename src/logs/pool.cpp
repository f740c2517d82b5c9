#include <algorithm>
#include <cmath>

#include "files/read/csv_reader.hpp"
#include "logs/calibrate.hpp"
#include "model/core/text.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/csv.hpp"

// From a recipe's dataset to the rooms of a calibration.

namespace pirsim::calibrate {
namespace {

namespace fs = std::filesystem;
using Parameters = std::map<int, std::map<std::string, double>>;  ///< of each room

/// Numbers of a table whose lines belong to rooms; those of several sensors or days are averaged.
class RoomMeans {
 public:
  void add(int room, const std::string& name, double value) {
    Sum& sum = sums_[room][name];
    sum.value += value;
    sum.n += 1.0;
  }
  void tell(Parameters& parameters) const {
    for (const auto& [room, own] : sums_) {
      for (const auto& [name, sum] : own) parameters[room][name] = sum.value / sum.n;
    }
  }

 private:
  struct Sum {
    double value = 0.0, n = 0.0;
  };
  std::map<int, std::map<std::string, Sum>> sums_;
};

/// A column of a table, and what a recipe calls it.
struct NamedColumn {
  const char *column, *name;
};

void add_columns(const fs::path& file, const std::vector<NamedColumn>& columns, RoomMeans& means) {
  const io::CsvTable table = io::CsvTable::read(file);
  Diagnostics faults;
  const auto room = table.required_column("room", faults);
  std::vector<std::size_t> found;
  for (const NamedColumn& one : columns) found.push_back(table.required_column(one.column, faults).value_or(0));
  faults.throw_if_errors();
  for (std::size_t row = 0; row < table.n_rows(); ++row) {
    const int number = table.integer(row, *room, faults).value_or(0);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (const auto value = table.number(row, found[i], faults)) means.add(number, columns[i].name, *value);
    }
  }
  faults.throw_if_errors();
}

void add_effects(const fs::path& file, RoomMeans& means) {
  const io::CsvTable table = io::CsvTable::read(file);
  Diagnostics faults;
  const auto room = table.required_column("room", faults), effect = table.required_column("effect", faults),
             parameter = table.required_column("parameter", faults), value = table.required_column("value", faults);
  faults.throw_if_errors();
  for (std::size_t row = 0; row < table.n_rows(); ++row) {
    const auto number = io::parse_number<double>(table.text(row, *value));  // words are no ranges
    if (number)
      means.add(table.integer(row, *room, faults).value_or(0),
                table.text(row, *effect) + '.' + table.text(row, *parameter), *number);
  }
  faults.throw_if_errors();
}

Parameters parameters_of(const fs::path& folder) {
  RoomMeans means;
  add_columns(folder / "rooms.csv", {{"floor_m2", "floor_m2"}, {"seats", "seats"}, {"staff", "people"}}, means);
  add_columns(folder / "sensors.csv", {{"y_m", "sensors.height_m"}, {"tilt_deg", "sensors.tilt_deg"}}, means);
  add_columns(folder / "days.csv", {{"ambient_c", "ambient_c"}}, means);
  add_effects(folder / "effects.csv", means);
  Parameters parameters;
  means.tell(parameters);
  return parameters;
}

void append(const LogRows& rows, std::size_t window, counting::Stretch& stretch) {
  for (std::size_t k = 0; k < rows.sensors.size(); ++k) stretch.motion.push_back(rows.at(window, k));
  const bool is_counted = !rows.people.empty() && rows.people_mean == LogMap::People::count;  // presence: 1 or more
  if (is_counted) stretch.people.push_back(rows.people[window]);
}

/// Readings of which the sensor is known that is known least.
std::size_t least_known(const counting::Stretch& stretch) {
  std::size_t least = stretch.n_readings();
  for (std::size_t k = 0; k < static_cast<std::size_t>(stretch.n_sensors); ++k) {
    std::size_t known = 0;
    for (std::size_t i = k; i < stretch.motion.size(); i += static_cast<std::size_t>(stretch.n_sensors))
      known += stretch.motion[i] == counting::unknown_bit ? 0 : 1;
    least = std::min(least, known);
  }
  return least;
}

// A log counted.

void require_fit(const counting::Counter& counter, const LogRows& rows, const LogTraits& log) {
  std::vector<std::string> own = counter.sensors, others = log.sensors;
  std::ranges::sort(own);
  std::ranges::sort(others);
  const bool are_others = !own.empty() && !others.empty() && own != others;
  if (static_cast<int>(rows.sensors.size()) != counter.n_sensors || are_others) {
    throw Error(ErrorCode::input, "the counter is for " +
                                      counted(static_cast<std::size_t>(counter.n_sensors), "sensor") +
                                      (own.empty() ? "" : " (" + joined(counter.sensors, ", ") + ")") +
                                      ", and the log has " + std::to_string(rows.sensors.size()) + ": " +
                                      joined(rows.sensors, ", ") + "; a map (--map) chooses among them" +
                                      (own.empty() ? ""
                                                   : " and names them, `sensors: {" + counter.sensors.front() + ": " +
                                                         rows.sensors.front() + ", ...}`"));
  }
  if (log.interval_s <= counter.settings.step_s * (1.0 + 1e-6)) return;
  throw Error(ErrorCode::input, "the log has a reading every " + shortest_number(log.interval_s) +
                                    " s, and the counter counts by readings of " +
                                    shortest_number(counter.settings.step_s) +
                                    " s: it can't tell what was between. Make a counter of such a log "
                                    "(pirsim calibrate --step " +
                                    shortest_number(std::ceil(log.interval_s)) + ")");
}

/// Sensors that aren't told, holds that differ.
std::vector<std::string> remarks_of(const counting::Counter& counter, const LogTraits& log) {
  std::vector<std::string> remarks;
  if (counter.sensors.empty() && !log.sensors.empty()) {
    remarks.push_back("it doesn't tell which sensors it is for: the log's are taken for them (" +
                      joined(log.sensors, ", ") + ")");
  }
  for (std::size_t k = 0; k < log.holds_s.size(); ++k) {
    const auto own = std::ranges::find(counter.sensors, log.sensors[k]);
    if (own == counter.sensors.end() || counter.holds_s.empty()) continue;
    const std::optional<double> known = counter.holds_s[static_cast<std::size_t>(own - counter.sensors.begin())];
    constexpr double least_share = 0.2, least_s = 1.0;  // assumed (0.1-0.5, 0.5-2): logs of one sensor differ by less
    if (!known || !log.holds_s[k]) continue;
    const double by_s = std::abs(*log.holds_s[k] - *known);
    if (by_s <= std::max(least_s, least_share * *known)) continue;
    remarks.push_back("'" + log.sensors[k] + "' holds motion for " + fixed(*log.holds_s[k], 1) +
                      " s in this log, and for " + fixed(*known, 1) +
                      " s in the one that the counter comes from: its counts may be off");
  }
  return remarks;
}

}  // namespace

std::optional<double> common_hold(const LogFacts& facts) {
  constexpr double alike = 1.1;  // assumed (1.05-1.2): clocks and radios make holds so different
  std::vector<double> holds, shortest;
  std::vector<std::string> words;
  for (const LogSensorFacts& sensor : facts.sensors) {
    if (sensor.pulses.n < fewest_pulses_of_hold) continue;
    if (sensor.hold_s) holds.push_back(*sensor.hold_s);
    shortest.push_back(sensor.hold_s.value_or(sensor.pulses.floor_s));
    words.push_back(sensor.name + (sensor.hold_s ? " holds motion for " : ", whose hold isn't told, has pulses of ") +
                    shortest_number(shortest.back()) + " s");
  }
  if (holds.empty() || facts.interval_s > 0.0) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(holds);
  if (most > alike * least || alike * std::ranges::min(shortest) < most) {
    throw Error(ErrorCode::input, "the log's sensors don't hold motion equally long (" + joined(words, "; ") +
                                      "), and those of the rooms do: say a hold for all (--hold SECONDS), or leave "
                                      "sensors out by a map (--map, sensors)");
  }
  return least;
}

std::vector<std::string> pool_overrides(const dataset::RecipeSpec& recipe, double step_s,
                                        std::optional<double> hold_s) {
  std::vector<std::string> overrides{"sensing.window_s=" + io::csv_number(step_s), "exports=[]", "occupants=false"};
  if (!hold_s) return overrides;
  const auto known = std::ranges::find(recipe.effects, "pulse_stretching", &dataset::VariedEffectSpec::name);
  const auto index = static_cast<std::size_t>(known - recipe.effects.begin());
  const std::string effect = "{pulse_stretching: {hold_s: " + io::csv_number(*hold_s) + "}}";
  overrides.push_back(recipe.effects.empty() ? "effects=[" + effect + "]"
                                             : "effects." + std::to_string(index) + "=" + effect);
  return overrides;
}

counting::Stretch readings_of(const dataset::RoomDayRows& rows, double step_s) {
  const auto per = static_cast<std::size_t>(std::max(1L, std::lround(step_s / rows.window_s)));
  const std::size_t n_sensors = rows.sensors.size(), n = rows.people.size() / per;
  counting::Stretch stretch{static_cast<int>(n_sensors), std::vector<std::uint8_t>(n * n_sensors, 0), {}};
  for (std::size_t i = 0; i < n * per; ++i) {
    for (std::size_t k = 0; k < n_sensors; ++k) {
      std::uint8_t& bit = stretch.motion[i / per * n_sensors + k];
      const std::uint8_t row = rows.motion[i * n_sensors + k];
      if (row == 1 || bit == 0) bit = row;  // what is unknown hides no motion, before or after
    }
  }
  for (std::size_t i = 0; i < n; ++i) stretch.people.push_back(rows.people[i * per + per - 1]);
  return stretch;
}

std::vector<PoolRoom> read_pool(const fs::path& folder, int n_sensors, double step_s, unsigned threads) {
  using dataset::Part;
  std::vector<dataset::RoomDayRows> days;
  for (const Part part : {Part::train, Part::validation, Part::test_days, Part::test_rooms})
    std::ranges::move(dataset::read_room_days(folder, part, threads), std::back_inserter(days));
  std::ranges::sort(days, {}, [](const auto& day) { return std::pair(day.room, day.day); });
  const Parameters parameters = parameters_of(folder);
  std::vector<PoolRoom> pool;
  for (const dataset::RoomDayRows& day : days) {
    if (static_cast<int>(day.sensors.size()) != n_sensors) continue;
    if (pool.empty() || pool.back().labelled.number != day.room) {
      const auto own = parameters.find(day.room);
      pool.push_back({{day.room, {}}, own == parameters.end() ? std::map<std::string, double>{} : own->second});
    }
    pool.back().labelled.days.push_back(readings_of(day, step_s));
  }
  if (pool.empty() && !days.empty()) {
    throw Error(ErrorCode::input, "the log has " + counted(static_cast<std::size_t>(n_sensors), "sensor") +
                                      ", and no room of the recipe has as many (the first has " +
                                      std::to_string(days.front().sensors.size()) +
                                      "): change the recipe's sensors, or name those of the room in a map (--map)");
  }
  return pool;
}

void require_rooms(const dataset::RecipeSpec& recipe, int n_sensors) {
  if (recipe.frames == Frames::taken)
    throw Error(ErrorCode::input, Where{recipe.file.string()},
                "calibrate works on rows of motion, which a thermal array doesn't give: leave out 'frames'");
  if (recipe.n_rooms() < fewest_rooms) {
    throw Error(ErrorCode::input, Where{recipe.file.string()},
                "a calibration needs " + std::to_string(fewest_rooms) + " rooms at least, better 60; it has " +
                    std::to_string(recipe.n_rooms()));
  }
  // Of the user's own scenes nobody knows before they are read.
  const bool may_fit = std::ranges::any_of(recipe.rooms, [&](const dataset::RoomGroupSpec& group) {
    int least = 0, most = 0;
    for (const dataset::SensorGroupSpec& sensors : group.rooms.sensors) {
      least += sensors.count.least;
      most += sensors.count.most;
    }
    return group.home || !group.scenes.empty() || (least <= n_sensors && n_sensors <= most);
  });
  if (may_fit) return;
  throw Error(ErrorCode::input, Where{recipe.file.string()},
              "the log has " + counted(static_cast<std::size_t>(n_sensors), "sensor") +
                  ", and no room has as many: change its sensors, or name those of the room in a map (--map)");
}

WeighingLog weighing_log(const Log& log, std::optional<double> step_s, std::optional<double> hold_s) {
  const double interval_s = static_cast<double>(log.interval_us) * 1e-6;
  if (step_s && *step_s < interval_s) {
    throw Error(ErrorCode::usage, "--step: the log has a reading every " + shortest_number(interval_s) +
                                      " s, so that nothing shorter can be told apart");
  }
  const LogFacts facts = facts_of(log);
  WeighingLog weighing{LogWindows(log, step_s.value_or(usual_window_s(log))).rows(), traits_of(facts), hold_s};
  if (hold_s)
    std::ranges::fill(weighing.traits.holds_s, hold_s);
  else
    weighing.hold_s = common_hold(facts);
  return weighing;
}

Calibration weigh_rooms(const fs::path& folder, const WeighingLog& log, const LogDays& days,
                        const counting::Settings& settings, unsigned threads) {
  const Pool pool(read_pool(folder, static_cast<int>(log.rows.sensors.size()), settings.step_s, threads), settings,
                  threads);
  Calibration made = pool.calibrate(days.each, days.whole);
  remember(log.traits, made.counter);
  return made;
}

Interval hours_of(const dataset::RecipeSpec& recipe) {
  Interval hours{24.0, 0.0};
  for (const dataset::RoomGroupSpec& group : recipe.rooms) {
    hours.low = std::min(hours.low, group.schedule.from_h);
    hours.high = std::max(hours.high, group.schedule.to_h);
  }
  return hours;
}

counting::Stretch whole_log(const LogRows& rows) {
  counting::Stretch stretch{static_cast<int>(rows.sensors.size()), {}};
  for (std::size_t i = 0; i < rows.n_windows(); ++i) append(rows, i, stretch);
  return stretch;
}

LogDays days_of(const LogRows& rows, const Interval& hours) {
  constexpr double least_share = 0.9;  // assumed: half a day has other statistics than a day
  const bool has_clock = rows.clock != LogClock::elapsed;
  // Of a day that ends after midnight, as those at home do, the small hours are the day before's. No text: it is of
  // none.
  const auto date_of = [&](LogMoment moment) -> std::string {
    constexpr std::int64_t day_us = 86'400'000'000;
    constexpr double hour_us = 3600e6, hours_a_day = 24.0;
    if (!has_clock) return "the one day of the log";
    const std::int64_t local_us = moment.local_us(), into_us = (local_us % day_us + day_us) % day_us;
    double hour = static_cast<double>(into_us) / hour_us;
    if (hour < hours.low) hour += hours_a_day, moment.us -= day_us;
    return hour < hours.high ? to_text(moment, rows.clock).substr(0, 10) : "";
  };
  std::vector<std::pair<std::string, counting::Stretch>> each;
  for (std::size_t i = 0; i < rows.n_windows(); ++i) {
    const std::string date = date_of(rows.begin[i]);
    if (date.empty()) continue;
    if (each.empty() || each.back().first != date) each.push_back({date, {static_cast<int>(rows.sensors.size()), {}}});
    append(rows, i, each.back().second);
  }
  LogDays days;
  for (auto& [date, day] : each) {
    const double whole =
        has_clock ? (hours.high - hours.low) * 3600.0 / rows.window_s : static_cast<double>(day.n_readings());
    if (static_cast<double>(least_known(day)) < least_share * whole)
      days.partial.push_back(date);
    else
      days.whole.push_back(day);
    days.each.push_back(std::move(day));
  }
  return days;
}

LogTraits traits_of(const LogFacts& facts) {
  LogTraits traits{facts.interval_s, {}, {}};
  for (const LogSensorFacts& sensor : facts.sensors) {
    traits.sensors.push_back(sensor.name);
    traits.holds_s.push_back(sensor.hold_s);
  }
  return traits;
}

void remember(const LogTraits& log, counting::Counter& counter) {
  counter.sensors = log.sensors;
  counter.holds_s = log.holds_s;
}

LogCounts count_log(const counting::Counter& counter, LogRows rows, const LogTraits& log, counting::Pass pass) {
  require_fit(counter, rows, log);
  counting::Stretch stretch = whole_log(rows);
  stretch.people.clear();  // a count is made without a look at the answer
  counting::Estimates estimates = counting::estimate(counter, stretch, pass);
  const bool has_errors = pass == counting::Pass::smoothed;  // they are of such counts
  return {std::move(rows),
          std::move(estimates),
          has_errors ? counter.expected_error : std::nullopt,
          has_errors ? counter.figures_off : std::nullopt,
          counter.warning,
          remarks_of(counter, log)};
}

std::optional<CountError> error_of(const LogCounts& counts) {
  CountError error;
  for (std::size_t i = 0; i < counts.rows.people.size(); ++i) {
    const int people = counts.rows.people[i];
    if (people == log_state::unknown_count || !counts.estimates.is_told(i)) continue;
    const double off = std::abs(counts.estimates.count(i) - people);
    error.mean += off;
    ++error.readings;
    if (people == 0) continue;
    error.while_occupied += off;
    ++error.occupied;
  }
  if (error.readings == 0 || counts.rows.people_mean != LogMap::People::count) return std::nullopt;
  error.mean /= static_cast<double>(error.readings);
  if (error.occupied > 0) error.while_occupied /= static_cast<double>(error.occupied);
  return error;
}

}  // namespace pirsim::calibrate
