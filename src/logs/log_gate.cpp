#include "logs/log_gate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "logs/log_head.hpp"
#include "logs/log_proof.hpp"
#include "logs/times.hpp"
#include "model/core/text.hpp"

namespace pirsim::io {
namespace {

struct Finding {
  Where where;
  std::string message;
  std::vector<std::string> maps{};  ///< keys of maps, each of which settles it
  Severity severity = Severity::error;
};
using Findings = std::vector<Finding>;

bool are_few(std::uint64_t n, std::uint64_t of) { return n <= std::max<std::uint64_t>(1, of / 100); }

std::string day_of(std::int64_t us) { return to_text({us, 0}, LogClock::local).substr(0, 10); }

std::string length_in_words(std::int64_t us) {
  const double days = static_cast<double>(us) / us_per_day;
  return days >= 2.0 ? fixed(days, 0) + " days" : fixed(24.0 * days, 1) + " h";
}

template <typename Gated>
struct Rule {
  std::string_view name;
  Findings (*find)(const Gated&);
};

/// A log is refused by the first rule that it breaks; what is merely odd is added to the remarks.
template <typename Gated, std::size_t n>
void look(const std::array<Rule<Gated>, n>& rules, const Gated& gated) {
  for (const Rule<Gated>& rule : rules) {
    for (const Finding& finding : rule.find(gated)) {
      const auto message = [&] {
        return finding.maps.empty() ? finding.message : with_maps(finding.message, finding.maps);
      };
      if (finding.severity == Severity::error) throw Error(ErrorCode::input, finding.where, message());
      gated.reading.remarks.add(std::string(rule.name) + finding.message, finding.where, message);
    }
  }
}

// --------------------------------------------------------------------------------------------------------------- times

/// What rules of time look at.
struct GatedTimes {
  LogReading& reading;
  const LogFile& file;
  std::int64_t now_us;
};

/// The days, or shorter stretches, that a map's from and to leave.
using BusyTimes = std::vector<const LogReading::Busy*>;
BusyTimes wanted(const LogReading& reading) {
  BusyTimes found;
  for (const auto& [at, busy] : reading.busy) {
    if (reading.is_wanted(busy.first_us, busy.last_us)) found.push_back(&busy);
  }
  return found;
}

/// Until tomorrow, unless a map names a later end. (Rows from before 1990 are left out: LogTimer.)
Findings late_dates(const GatedTimes& all) {
  const std::vector<std::string>& names = all.file.shape().names;
  const bool are_ours = std::ranges::find(names, "time_s") != names.end();  // simulated days may be tomorrow's
  if (all.reading.to_us || are_ours || all.file.clock() == LogClock::elapsed) return {};
  const BusyTimes times = wanted(all.reading);
  const auto late = std::ranges::find_if(times, [&](const auto* at) { return at->last_us > all.now_us + us_per_day; });
  if (late == times.end()) return {};
  const LogReading::Busy& last = late == times.begin() ? *times.back() : **(late - 1);
  return {{{*(*late)->path, (*late)->line, 1},
           "its time is " + day_of((*late)->last_us) + ", later than tomorrow: was the clock set?",
           {"to: " + day_of(last.last_us + us_per_day)}}};
}

/// Nothing is told for a year: some clock wasn't set.
Findings lost_years(const GatedTimes& all) {
  constexpr std::int64_t longest_us = 366 * us_per_day;  // assumed: 200 to 400 days; who pauses for longer says so
  const std::int64_t allowed_us =
      std::max<std::int64_t>(longest_us, std::llround(all.reading.map.longest_gap_s.value_or(0.0) * 1e6));
  const BusyTimes times = wanted(all.reading);
  std::uint64_t n_before = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const LogReading::Busy &before = *times[i - 1], &after = *times[i];
    n_before += before.n_rows;
    if (after.first_us - before.last_us <= allowed_us || all.file.clock() == LogClock::elapsed) continue;
    const bool is_late = 2 * n_before >= all.reading.n_rows;
    const LogReading::Busy& odd = is_late ? after : before;
    return {{{*odd.path, odd.line, 1},
             "nothing is told from " + day_of(before.last_us) + " to " + day_of(after.first_us) +
                 ": was the clock set here?",
             {is_late ? "to: " + day_of(before.last_us + us_per_day) : "from: " + day_of(after.first_us),
              "longest_gap_s: " + fixed(std::ceil(static_cast<double>(after.first_us - before.last_us) / 1e6), 0)}}};
  }
  return {};
}

/// An hour that stands twice, since clocks were put back: rows step back a few times, by an hour or less.
Findings hours_twice(const GatedTimes& all) {
  constexpr std::int64_t longest_us = 3600 * us_per_s;
  constexpr std::uint64_t most_steps = 4;  // two years' clocks
  const auto n_behind = [](const StepsBack& order) {
    const bool is_turned = order.n_steps() > 0 && order.n_steps() <= most_steps && order.n_behind() > order.n_steps() &&
                           order.farthest_us() >= put_back_us && order.farthest_us() <= longest_us;
    return is_turned ? order.n_behind() : 0;
  };
  std::uint64_t n = n_behind(all.reading.order);
  for (const EventTracks::Track& track : all.reading.events.tracks()) n += n_behind(track.order);
  if (n == 0 || all.file.clock() != LogClock::local) return {};
  return {{all.reading.back_at,
           "the times step back here, by an hour at most, and " + counted(n, "row") +
               " stand in it a second time: clocks were put back, and without a zone two hours would be one",
           {"time_zone: Europe/Berlin"}}};
}

/// One row in a hundred may be left out.
Findings rows_left_out(const GatedTimes& all) {
  const LogReading& reading = all.reading;
  if (!reading.left_out || are_few(reading.n_left_out, reading.n_rows)) return {};
  return {{reading.left_out->where, std::to_string(reading.n_left_out) + " of " + counted(reading.n_rows, "row") +
                                        " would be left out; of this one " + reading.left_out->message +
                                        ". Put the rows in order of time, each once"}};
}

/// Of events: first states, and then nothing for a week, are a clock that wasn't set yet: nothing is known of that
/// week. Later ones are known and still, since a sensor without motion writes nothing, and said.
Findings long_silences(const GatedTimes& all) {
  constexpr std::int64_t a_week_us = 7 * us_per_day;  // assumed: of a home in which nobody is, one sensor moves earlier
  LogReading& reading = all.reading;
  Findings found;
  const auto moves_before = [&](std::int64_t us) {
    return std::ranges::any_of(reading.events.tracks(), [us](const EventTracks::Track& track) {
      return std::ranges::any_of(
          track.events, [us](const LogChange& event) { return event.us <= us && event.value == log_state::on; });
    });
  };
  if (reading.map.longest_gap_s || reading.events.tracks().empty()) return {};
  for (const LogReading::Moments& silence : reading.silences(a_week_us)) {
    if (!reading.is_wanted(silence.first_us, silence.last_us)) continue;
    const std::string when = "nothing is written from " + day_of(silence.first_us) + " to " + day_of(silence.last_us);
    if (moves_before(silence.first_us)) {
      found.push_back(
          {{all.file.path()}, when + ", which counts as known and still", {"longest_gap_s: 86400"}, Severity::warning});
    } else {
      reading.first_us = silence.last_us;
      found.push_back(
          {{all.file.path()}, when + ", before anything moves: the log begins behind it", {}, Severity::warning});
    }
  }
  return found;
}

constexpr std::array time_rules{
    Rule<GatedTimes>{"late dates", late_dates},       Rule<GatedTimes>{"lost years", lost_years},
    Rule<GatedTimes>{"hours twice", hours_twice},     Rule<GatedTimes>{"rows left out", rows_left_out},
    Rule<GatedTimes>{"long silences", long_silences},
};

// -------------------------------------------------------------------------------------------------------------- tracks

/// What the rules look at.
struct Gated {
  const Log& log;
  LogReading& reading;
  const LogShape& shape;

  [[nodiscard]] Where file() const { return {log.files.front().path}; }
  [[nodiscard]] const EventTracks::Track* events_of(const std::string& in_log) const {
    auto& tracks = reading.events.tracks();
    const auto found = std::ranges::find(tracks, in_log, &EventTracks::Track::in_log);
    return found == tracks.end() ? nullptr : &*found;
  }
  /// The cells of a sensor, or of the people; none: unknown.
  [[nodiscard]] const CellCounts* cells_of(const std::string& in_log) const {
    const auto column = reading.columns.find(in_log);
    return column == reading.columns.end() ? events_of(in_log) : &column->second;
  }
  [[nodiscard]] std::string name_columns() const {
    std::vector<std::string> names;
    for (const std::size_t column : shape.sensor) names.push_back(shape.names[column]);
    return joined(names, "' with '");
  }
  /// That names sensors by these columns and one more.
  [[nodiscard]] std::string name_map(const std::vector<std::size_t>& columns, std::size_t more) const {
    std::vector<std::string> names;
    for (const std::size_t column : columns) names.push_back(shape.names[column]);
    names.push_back(shape.names[more]);
    return "state: " + quoted_yaml(shape.names[*shape.state]) + ", sensor: " + quoted_yaml(names);
  }
};

/// One cell in a hundred may be no state; it counts as unknown.
Findings odd_states(const Gated& all) {
  Findings found;
  const auto look_at = [&](const LogTrack& track, const std::string& kind, const std::string& way_out) {
    const CellCounts* cells = all.cells_of(track.in_log);
    if (cells == nullptr || cells->n_other == 0) return;
    const std::string what = "'" + cells->odd_text + "' is no " + kind + " of '" + track.in_log + "'";
    const std::uint64_t n = cells->n_states + cells->n_other;
    if (are_few(cells->n_other, n)) {
      const std::string more = cells->n_other == 1 ? "" : "; " + std::to_string(cells->n_other - 1) + " more like this";
      found.push_back({cells->odd_at, what + ": it counts as unknown" + more, {}, Severity::warning});
      return;
    }
    const std::string all_of = what + ", as are " + std::to_string(cells->n_other) + " of its " + counted(n, "row");
    if (!way_out.empty())
      found.push_back({cells->odd_at, all_of, {way_out}});
    else if (is_number(cells->odd_text))
      found.push_back({cells->odd_at, all_of + ": it counts triggers or seconds", {"above: 0"}});
    else
      found.push_back({cells->odd_at,
                       all_of,
                       {"states: {on: [" + quoted_yaml(cells->odd_text) + "]}",
                        "states: {off: [" + quoted_yaml(cells->odd_text) + "]}"}});
  };
  for (const LogTrack& track : all.log.sensors) look_at(track, "state", "");
  if (all.log.people) look_at(*all.log.people, "number of people", "people: none");
  return found;
}

/// Columns of the first rows in which each of few texts stands again and again.
std::vector<std::size_t> columns_of_names(const LogShape& shape) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < shape.head.n_columns(); ++i) {
    const bool is_name = std::ranges::find(shape.sensor, i) != shape.sensor.end();
    const bool is_used = shape.time.has(i) || (shape.end && shape.end->has(i)) || i == shape.state || is_name;
    const std::size_t n = shape.head.n_values(i);
    if (!is_used && n >= 2 && 2 * n <= shape.head.rows.size()) found.push_back(i);
  }
  return found;
}

/// Of the first rows: what stands in columns that name the sensor together.
std::vector<std::string> names_in(const LogShape& shape, const std::vector<std::size_t>& columns) {
  std::vector<std::string> names;
  for (const auto& row : shape.head.rows) {
    std::string& name = names.emplace_back();
    for (const std::size_t column : columns) name += (name.empty() ? "" : "_") + row[column];
  }
  return names;
}

/// A column that hardly ever repeats, where another one does, names no sensor.
Findings names_that_never_repeat(const Gated& all) {
  constexpr std::size_t fewest = 8;
  if (all.shape.sensor.empty() || all.shape.head.rows.size() < fewest) return {};
  const std::vector<std::string> names = names_in(all.shape, all.shape.sensor);
  const std::size_t n_names = std::set(names.begin(), names.end()).size();
  const std::vector<std::size_t> others = columns_of_names(all.shape);
  const std::size_t hardly = others.empty() ? 0 : names.size() / 10;  // assumed: rows that stand twice
  if (n_names + hardly < names.size()) return {};
  Finding found{all.file(), "'" + all.name_columns() + "' is another one in " +
                                (n_names < names.size() ? "nearly " : "") + "each row, so that it names no sensor"};
  for (const std::size_t column : others) found.maps.push_back("sensor: " + quoted_yaml(all.shape.names[column]));
  return {found};
}

/// Where a sensor goes on while it is on, again and again, and a further column tells two apart, that belongs to the
/// name.
Findings names_in_two_columns(const Gated& all) {
  constexpr double fewest = 3.0,
                   hardly = 0.1;  // assumed: telegrams get lost, and some sensors say again what they said
  if (all.shape.form != LogMap::Form::events || all.shape.sensor.empty() || !all.shape.state) return {};
  const auto repeats = [&](const std::vector<std::size_t>& columns) {
    const std::vector<std::string> names = names_in(all.shape, columns);
    std::vector<NamedRow> rows;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto state = read_state(all.shape.head.rows[i][*all.shape.state], all.reading.map.states);
      if (state && *state != log_state::unknown) rows.push_back({0, names[i], *state});
    }
    return (1.0 - proof_of_names(rows).own_turns) * static_cast<double>(rows.size());
  };
  const double n_repeats = repeats(all.shape.sensor);
  if (n_repeats < fewest) return {};
  for (const std::size_t column : columns_of_names(all.shape)) {
    std::vector<std::size_t> columns = all.shape.sensor;
    columns.push_back(column);
    if (repeats(columns) > hardly * n_repeats) continue;
    const bool is_alone = repeats({column}) <= hardly * n_repeats;
    return {{all.file(),
             "'" + all.name_columns() + "' names a sensor that goes on while it is on, and '" +
                 all.shape.names[column] + "' tells two apart",
             {all.name_map(is_alone ? std::vector<std::size_t>{} : all.shape.sensor, column)}}};
  }
  return {};
}

/// What a device measures may stand in a column of its own: its motion, and its light.
Findings kinds_in_a_column(const Gated& all) {
  const LogShape& shape = all.shape;
  if (shape.form != LogMap::Form::events || shape.sensor.empty() || !shape.state) return {};
  const std::vector<std::string> names = names_in(shape, shape.sensor);
  const auto is_read = [&](const std::string& name) {
    return std::ranges::find(all.log.sensors, name, &LogTrack::in_log) != all.log.sensors.end();
  };
  for (const std::size_t column : columns_of_names(shape)) {
    std::set<std::pair<bool, std::int32_t>> seen;  // is motion, state
    std::set<std::pair<bool, std::string>> kinds;  // is motion, sensor
    bool has_others = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string& kind = shape.head.rows[i][column];
      if (kind.empty() || !is_read(names[i])) continue;
      const NameSays says = what_name_says(kind);
      const bool is_motion = says == NameSays::motion || says == NameSays::presence;
      seen.emplace(is_motion,
                   read_state(shape.head.rows[i][*shape.state], all.reading.map.states).value_or(log_state::unknown));
      has_others = has_others || says == NameSays::other_device || says == NameSays::other_quantity ||
                   kinds.contains({!is_motion, names[i]});
      kinds.emplace(is_motion, names[i]);
    }
    const bool has_motion = !seen.empty() && seen.rbegin()->first;
    if (!has_motion || !has_others || seen.size() < 3) continue;  // of two the state tells which: "motion", "quiet"
    return {{all.file(),
             "'" + shape.names[column] + "' tells motion from other things, and isn't read",
             {all.name_map(shape.sensor, column)}}};
  }
  return {};
}

/// "hall_vacant", "no motion": what is on while nobody moves.
bool says_contrary(std::string_view name) {
  constexpr std::array contraries{" vacant ", " nomotion ",     " no motion ",     " no movement ", " no presence ",
                                  " absent ", " not occupied ", " unoccupied ",    " idle ",        " clear ",
                                  " frei ",   " unbelegt ",     " keine bewegung "};
  const std::string words = " " + joined(words_of_name(name), " ") + " ";
  return std::ranges::any_of(contraries, [&](const char* one) { return words.find(one) != std::string::npos; });
}

/// What is called so is no motion sensor, unless a map says that its states are turned round.
Findings contrary_names(const Gated& all) {
  const std::string state = all.shape.state ? all.shape.names[*all.shape.state] : std::string();
  std::vector<std::string> contrary, others;
  for (const LogTrack& sensor : all.log.sensors) {
    const std::string& name = says_contrary(state) ? state : sensor.in_log;
    (says_contrary(name) ? contrary : others).push_back(name);
  }
  if (contrary.empty() || !all.reading.map.states.on.empty()) return {};
  return {{all.file(),
           "'" + contrary.front() + "' is called the contrary of motion",
           {others.empty() ? R"(states: {on: ["0", "off", "false", "no"], off: ["1", "on", "true", "yes"]})"
                           : "sensors: " + quoted_yaml(others)}}};
}

/// What is called motion, or a count of people, is read, or it is said why not.
Findings motion_left_out(const Gated& all) {
  const auto is_called_motion = [&](const std::string& name) {
    const NameSays says = all.reading.says(name);
    return says == NameSays::motion || says == NameSays::presence;
  };
  if (!all.reading.map.sensors.empty()) return {};
  const bool has_motion = std::ranges::any_of(all.log.sensors, [&](const LogTrack& track) {
    return is_called_motion(track.in_log) || is_casas_motion(track.in_log);
  });
  Findings found;
  const auto is_no_count = [](const std::string& text) { return is_number(text) && !read_count(text); };
  for (const std::string& name : all.log.others) {
    const auto& names = all.shape.head.names;
    const auto column = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    if (!all.log.people && column < names.size() && what_name_says(name) == NameSays::count) {
      const auto odd =
          std::ranges::find_if(all.shape.head.rows, [&](const auto& row) { return is_no_count(row[column]); });
      if (odd != all.shape.head.rows.end())
        found.push_back({all.file(),
                         "column '" + name + "' isn't read: '" + (*odd)[column] + "' and more are no numbers of people",
                         {},
                         Severity::warning});
    }
    const CellCounts* cells = all.cells_of(name);
    if (!is_called_motion(name) || all.log.sensors.empty() || (cells != nullptr && cells->n_other == 0)) continue;
    const std::string what = "'" + name + "' is called a motion sensor, and none of its cells tells whether it is on";
    if (has_motion)
      found.push_back({all.file(), what + ": it is left out", {}, Severity::warning});
    else
      found.push_back({all.file(),
                       what + "; '" + all.log.sensors.front().in_log + "' isn't called so, and is read",
                       {"sensors: [" + quoted_yaml(all.log.sensors.front().in_log) + "]"}});
  }
  return found;
}

/// What is known of a sensor's time, by windows.
struct Shares {
  std::size_t n_known = 0, n_on = 0;
  std::size_t n_others_off = 0, n_on_alone = 0;  ///< windows in which all others are off; of those: on

  [[nodiscard]] double on() const {
    return static_cast<double>(n_on) / static_cast<double>(std::max<std::size_t>(1, n_known));
  }
};

std::vector<Shares> shares_of(const Log& log) {
  const LogWindows windows(log, usual_window_s(log));
  constexpr std::size_t at_once = 1U << 14U;
  std::vector<Shares> shares(log.sensors.size());
  for (std::size_t first = 0; first < windows.size(); first += at_once) {
    const LogRows rows = windows.rows(first, at_once);
    for (std::size_t i = 0; i < rows.n_windows(); ++i) {
      std::size_t n_on = 0, n_off = 0;
      for (std::size_t k = 0; k < shares.size(); ++k) {
        n_on += rows.at(i, k) == log_state::on ? 1 : 0;
        n_off += rows.at(i, k) == log_state::off ? 1 : 0;
      }
      for (std::size_t k = 0; k < shares.size(); ++k) {
        const bool is_on = rows.at(i, k) == log_state::on, is_off = rows.at(i, k) == log_state::off;
        const bool is_alone = n_off - (is_off ? 1 : 0) + 1 == shares.size() && shares.size() > 1;
        shares[k].n_known += is_on || is_off ? 1 : 0;
        shares[k].n_on += is_on ? 1 : 0;
        shares[k].n_others_off += is_alone && (is_on || is_off) ? 1 : 0;
        shares[k].n_on_alone += is_alone && is_on ? 1 : 0;
      }
    }
  }
  return shares;
}

/// A sensor that never changes, is on most of the time, or just when all others are off, may be turned round.
Findings states_turned_round(const Gated& all) {
  constexpr double mostly = 0.8, alone = 0.8;  // assumed: a busy office moves for 60 % of a day at work
  constexpr std::size_t fewest = 120;          // windows: an hour
  Findings found;
  const std::vector<Shares> shares = shares_of(all.log);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const LogTrack& track = all.log.sensors[i];
    const auto has = [&](std::int32_t state) {
      return std::ranges::any_of(track.changes, [&](const LogChange& change) { return change.value == state; });
    };
    const auto say = [&](const std::string& what) {
      found.push_back({all.file(), "sensor '" + track.name + "' " + what, {}, Severity::warning});
    };
    const Shares& share = shares[i];
    const bool is_on = has(log_state::on), is_off = has(log_state::off);
    if (is_on && !is_off) {
      say("is never off" + (all.log.has_readings()
                                ? std::string()
                                : "; if its log tells motion alone, say `hold_s: {" + track.name + ": 30}` in a map"));
    } else if (!is_on) {
      say(is_off ? "is never on" : "is never known");
    } else if (share.n_known >= fewest && share.on() >= mostly) {
      say("is on for " + percent(share.on()) + " of the time: does its 0 tell motion?");
    } else if (share.n_others_off >= fewest && share.n_on < share.n_known &&
               static_cast<double>(share.n_on_alone) >= alone * static_cast<double>(share.n_others_off)) {
      say("is on for " + percent(static_cast<double>(share.n_on_alone) / static_cast<double>(share.n_others_off)) +
          " of the time in which all others are off: does its 0 tell motion?");
    }
  }
  return found;
}

/// A sensor that falls silent before another one's first word may have been renamed, or replaced.
Findings renamed_sensors(const Gated& all) {
  constexpr std::int64_t shortest_us = 1800 * us_per_s;
  Findings found;
  for (const LogTrack& old : all.log.sensors) {
    const EventTracks::Track* told = all.events_of(old.in_log);
    if (told == nullptr || old.changes.size() < 3 || all.shape.form != LogMap::Form::events) continue;
    std::int64_t last_us = 0, longest_us = shortest_us;
    for (const EventTracks::Track::FilePart& part : told->parts) last_us = std::max(last_us, part.last_us);
    for (std::size_t i = 1; i < old.changes.size(); ++i)
      longest_us = std::max(longest_us, old.changes[i].us - old.changes[i - 1].us);
    if (all.log.end_us - last_us <= 2 * longest_us) continue;
    for (const LogTrack& other : all.log.sensors) {
      const std::int64_t begin_us = other.changes.empty() ? 0 : other.changes.front().us;
      if (begin_us < last_us || begin_us - last_us > longest_us || begin_us == all.log.begin_us) continue;
      found.push_back({all.file(),
                       "sensor '" + old.name + "' says nothing for the last " +
                           length_in_words(all.log.end_us - last_us) + ", which counts as still, and '" + other.name +
                           "' begins then; if that is its new name",
                       {"sensors: {" + quoted_yaml(old.name) + ": " + quoted_yaml({old.in_log, other.in_log}) + "}"},
                       Severity::warning});
    }
  }
  return found;
}

constexpr std::array track_rules{
    Rule<Gated>{"kinds in a column", kinds_in_a_column},
    Rule<Gated>{"odd states", odd_states},
    Rule<Gated>{"contrary names", contrary_names},
    Rule<Gated>{"names that never repeat", names_that_never_repeat},
    Rule<Gated>{"names in two columns", names_in_two_columns},
    Rule<Gated>{"motion left out", motion_left_out},
    Rule<Gated>{"states turned round", states_turned_round},
    Rule<Gated>{"renamed sensors", renamed_sensors},
};

}  // namespace

void pass_times(LogReading& reading, const LogFile& first, std::int64_t now_us) {
  look(time_rules, GatedTimes{reading, first, now_us});
}

void pass_tracks(const Log& log, LogReading& reading, const LogFile& first) {
  look(track_rules, Gated{log, reading, first.shape()});
}

}  // namespace pirsim::io
