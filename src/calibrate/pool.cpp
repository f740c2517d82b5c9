// From a recipe's dataset to the rooms of a calibration.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/text.hpp"
#include "io/files/atomic_file.hpp"
#include "io/read/csv_reader.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/csv.hpp"

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

void add_columns(const fs::path& file, std::span<const NamedColumn> columns, RoomMeans& means) {
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
  constexpr std::array of_rooms{NamedColumn{"floor_m2", "floor_m2"}, NamedColumn{"seats", "seats"},
                                NamedColumn{"staff", "people"}};
  constexpr std::array of_days{NamedColumn{"ambient_c", "ambient_c"}};
  constexpr std::array of_sensors{NamedColumn{"y_m", "sensors.height_m"}, NamedColumn{"tilt_deg", "sensors.tilt_deg"}};
  add_columns(folder / "rooms.csv", of_rooms, means);
  add_columns(folder / "sensors.csv", of_sensors, means);
  add_columns(folder / "days.csv", of_days, means);
  add_effects(folder / "effects.csv", means);
  Parameters parameters;
  means.tell(parameters);
  return parameters;
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
      if (bit != 1) bit = std::max(bit, rows.motion[i * n_sensors + k]);
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

bool may_have(const dataset::RecipeSpec& recipe, int n_sensors) {
  return std::ranges::any_of(recipe.rooms, [&](const dataset::RoomGroupSpec& group) {
    int least = 0, most = 0;
    for (const dataset::SensorGroupSpec& sensors : group.rooms.sensors) {
      least += sensors.count.least;
      most += sensors.count.most;
    }
    return group.home || !group.scenes.empty() || (least <= n_sensors && n_sensors <= most);
  });
}

Interval hours_of(const dataset::RecipeSpec& recipe) {
  Interval hours{24.0, 0.0};
  for (const dataset::RoomGroupSpec& group : recipe.rooms) {
    hours.low = std::min(hours.low, group.schedule.from_h);
    hours.high = std::max(hours.high, group.schedule.to_h);
  }
  return hours;
}

namespace {

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

}  // namespace

counting::Stretch whole_log(const LogRows& rows) {
  counting::Stretch stretch{static_cast<int>(rows.sensors.size()), {}};
  for (std::size_t i = 0; i < rows.n_windows(); ++i) append(rows, i, stretch);
  return stretch;
}

LogDays days_of(const LogRows& rows, const Interval& hours) {
  constexpr double least_share = 0.9;  // assumed: half a day has other statistics than a day
  const bool has_clock = rows.clock != LogClock::elapsed;
  const auto is_within = [&](const LogMoment& moment) {
    constexpr std::int64_t day_us = 86'400'000'000;
    constexpr double hour_us = 3600e6;
    const std::int64_t local_us = moment.local_us(), into_us = (local_us % day_us + day_us) % day_us;
    const double hour = static_cast<double>(into_us) / hour_us;
    return !has_clock || (hour >= hours.low && hour < hours.high);
  };
  std::vector<std::pair<std::string, counting::Stretch>> each;
  for (std::size_t i = 0; i < rows.n_windows(); ++i) {
    if (!is_within(rows.begin[i])) continue;
    const std::string date = has_clock ? to_text(rows.begin[i], rows.clock).substr(0, 10) : "the one day of the log";
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
      days.whole.push_back(std::move(day));
  }
  return days;
}

}  // namespace pirsim::calibrate
