#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

#include "files/read/reader_parts.hpp"
#include "files/read/yaml.hpp"
#include "logs/log_file.hpp"
#include "logs/log_gate.hpp"
#include "logs/log_head.hpp"
#include "logs/log_proof.hpp"
#include "model/core/text.hpp"
#include "model/schema/columns.hpp"
#include "model/schema/words.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/log.hpp"

// A log from its files.

namespace pirsim::io {
namespace {

std::string name_of(const LogMap& map, const std::string& in_log) {
  const auto found = std::ranges::find(map.sensors, in_log, &LogMap::Sensor::in_log);
  return found == map.sensors.end() ? in_log : found->name;
}

// --------------------------------------------------------------------------------------------------------------- parts

/// Files that tell of one sensor, or of several, at the same time.
struct Overlap : Error {
  using Error::Error;
};

/// Two files may tell the same of a time; where they don't, they are no parts of one log. Changes in order of time.
void require_agreement(const std::vector<LogChange>& one, const std::vector<LogChange>& other,
                       const LogReading::Moments& span, const Where& where, const std::string& what) {
  const auto value = [](const std::vector<LogChange>& changes, std::int64_t us) {
    const auto after = std::ranges::upper_bound(changes, us, {}, &LogChange::us);
    return after == changes.begin() ? std::nullopt : std::optional((after - 1)->value);
  };
  for (const auto* changes : {&one, &other}) {
    for (const LogChange& change : *changes) {
      const bool is_common = change.us >= span.first_us && change.us <= span.last_us;
      if (!is_common || value(one, change.us) == value(other, change.us)) continue;
      throw Overlap(ErrorCode::input, where, "it overlaps another file in time, and says something else of " + what);
    }
  }
}

// ------------------------------------------------------------------------------------------------------------ readings

/// Readings of one file after those of another.
class ReadingParts {
 public:
  explicit ReadingParts(Log& log) : log_(log) {}

  void add(LogFile& file) {
    ReadingTracks& part = *file.readings();
    if (part.is_empty()) return;
    const std::int64_t interval = part.cadence().interval_us;
    const Where where{file.file().path};
    if (log_.interval_us == 0) {
      log_.interval_us = interval;
      log_.begin_us = part.first_us() - interval;
    }
    constexpr double alike = 0.2;  // assumed
    if (std::abs(static_cast<double>(interval - log_.interval_us)) > alike * static_cast<double>(log_.interval_us))
      throw Error(
          ErrorCode::input, where,
          "its readings are " + seconds(interval) + " apart, those of the other files " + seconds(log_.interval_us));
    const LogShape& shape = file.shape();
    for (std::size_t i = 0; i < shape.sensors.size(); ++i)
      append(track(shape.names[shape.sensors[i]]), i, part, log_state::unknown, where);
    if (shape.people) {
      if (!log_.people) log_.people = LogTrack{"people", shape.names[*shape.people], {}, 0};
      append(*log_.people, shape.sensors.size(), part, log_state::unknown_count, where);
    }
    log_.end_us = std::max(log_.end_us, part.last_us());
  }
  /// What ends before the log does is unknown from there on.
  void finish() {
    for (LogTrack& track : log_.sensors) end(track, log_.end_us + log_.interval_us, log_state::unknown);
    if (log_.people) end(*log_.people, log_.end_us + log_.interval_us, log_state::unknown_count);
  }

 private:
  static std::string seconds(std::int64_t us) { return shortest_number(static_cast<double>(us) / 1e6) + " s"; }

  LogTrack& track(const std::string& in_log) {
    const auto found = std::ranges::find(log_.sensors, in_log, &LogTrack::in_log);
    if (found != log_.sensors.end()) return *found;
    return log_.sensors.emplace_back(LogTrack{name_of(log_.map, in_log), in_log, {}, 0});
  }
  std::int64_t* last_of(const LogTrack& track) {
    const auto found = std::ranges::find(last_, track.name, &Last::name);  // a column may be the people's, too
    return found == last_.end() ? nullptr : &found->us;
  }
  /// With readings until `last` alone.
  void end(LogTrack& track, std::int64_t next_us, std::int32_t unknown) {
    const std::int64_t* last = last_of(track);
    if (last == nullptr || next_us - *last <= 3 * log_.interval_us / 2) return;
    if (track.changes.back().value != unknown)
      track.changes.push_back({*last + log_.interval_us, log_.interval_us, unknown});
  }
  void append(LogTrack& track, std::size_t column, ReadingTracks& part, std::int32_t unknown, const Where& where) {
    std::vector<LogChange> changes = std::move(part.changes()[column]);
    std::int64_t* last = last_of(track);
    if (last == nullptr) {
      track.changes = std::move(changes);
      last_.push_back({track.name, part.last_us()});
    } else {
      if (*last >= part.first_us()) {
        require_agreement(track.changes, changes, {part.first_us(), std::min(*last, part.last_us())}, where,
                          "column '" + track.in_log + "'");
        std::erase_if(changes, [&](const LogChange& change) { return change.us <= *last; });
      } else {
        end(track, part.first_us(), unknown);
        changes.front().since_last_us = std::min(log_.interval_us, part.first_us() - *last);
        if (changes.front().value == track.changes.back().value) changes.erase(changes.begin());
      }
      track.changes.insert(track.changes.end(), changes.begin(), changes.end());
      *last = std::max(*last, part.last_us());
    }
    track.n_read += part.n_readings();
  }

  struct Last {
    std::string name;
    std::int64_t us;
  };
  Log& log_;
  std::vector<Last> last_;
};

// -------------------------------------------------------------------------------------------------------------- events

bool may_be_sensor(const EventTracks::Track& track) {
  const auto is_known = [](const LogChange& event) {
    return event.value == log_state::on || event.value == log_state::off;
  };
  return track.n_states > track.n_other && std::ranges::any_of(track.events, is_known);
}

/// Which of the tracks are motion sensors, if no map says so.
std::vector<std::size_t> motion_sensors(const std::vector<EventTracks::Track>& tracks, const LogReading& reading) {
  const std::string& people = reading.map.people;
  std::vector<std::size_t> all, motion, casas;
  const auto is_entity = [](const auto& track) { return track.in_log.starts_with("binary_sensor."); };
  const bool is_home = std::ranges::any_of(tracks, is_entity);  // whose lights and automations are called motion, too
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!may_be_sensor(tracks[i]) || (!people.empty() && tracks[i].in_log == people)) continue;
    if (is_home && !is_entity(tracks[i]) && !tracks[i].in_log.starts_with("sensor.")) continue;
    const NameSays says = reading.says(tracks[i].in_log);
    if (is_casas_motion(tracks[i].in_log)) casas.push_back(i);
    if (says == NameSays::motion || says == NameSays::presence) motion.push_back(i);
    if (says != NameSays::other_quantity && says != NameSays::other_device) all.push_back(i);
  }
  std::vector<std::size_t>& chosen = !casas.empty() ? casas : !motion.empty() ? motion : all;
  std::ranges::sort(chosen, {}, [&](std::size_t i) { return tracks[i].in_log; });
  return chosen;
}

/// Its index. Throws Error(input) if the log has none.
std::size_t track_of(const std::vector<EventTracks::Track>& tracks, const std::string& in_log, const Where& where) {
  const auto found = std::ranges::find(tracks, in_log, &EventTracks::Track::in_log);
  if (found != tracks.end()) return static_cast<std::size_t>(found - tracks.begin());
  std::vector<std::string> names;
  for (const EventTracks::Track& track : tracks) names.push_back(track.in_log);
  throw Error(ErrorCode::input, where, "the log has no events of '" + in_log + "'" + near_or_all(in_log, names));
}

/// In the map's order, or by name.
std::vector<std::size_t> chosen_sensors(LogReading& reading, const LogMap& map, const Where& where) {
  const std::vector<EventTracks::Track>& tracks = reading.events.tracks();
  if (map.sensors.empty()) return motion_sensors(tracks, reading);
  std::vector<std::size_t> chosen;
  for (const LogMap::Sensor& sensor : map.sensors) {
    if (sensor.in_log == map.people)
      throw Error(ErrorCode::input, where, "'" + map.people + "' can't be a sensor and the people");
    chosen.push_back(track_of(tracks, sensor.in_log, where));
  }
  return chosen;
}

/// Nothing is known of these times.
std::vector<LogChange> without(const std::vector<LogChange>& changes, const std::vector<LogReading::Moments>& silences,
                               std::int32_t unknown) {
  std::vector<LogChange> result;
  auto at = changes.begin();
  for (const LogReading::Moments& silence : silences) {
    while (at != changes.end() && at->us <= silence.first_us) result.push_back(*at++);
    if (result.empty()) continue;
    const std::int32_t before = result.back().value;
    result.push_back({silence.first_us, 0, unknown});
    if (at == changes.end() || at->us > silence.last_us) result.push_back({silence.last_us, 0, before});
  }
  result.insert(result.end(), at, changes.end());
  return result;
}

/// What is known from `from` on, and until `to`.
std::vector<LogChange> clipped(std::vector<LogChange> changes, std::int64_t from_us, std::int64_t to_us) {
  // Several changes at from_us itself all stay, and end what held before.
  auto first = std::ranges::lower_bound(changes, from_us, {}, &LogChange::us);
  const bool holds_on = first != changes.begin() && (first == changes.end() || first->us > from_us);
  if (holds_on) (--first)->us = from_us;
  changes.erase(changes.begin(), first);
  changes.erase(std::ranges::lower_bound(changes, to_us, {}, &LogChange::us), changes.end());
  return changes;
}

/// A map's seconds of this sensor.
std::optional<std::int64_t> of_sensor(const LogMap::Seconds& seconds, const Log& log, const std::string& in_log) {
  const std::string name = name_of(log.map, in_log);
  std::optional<double> s = seconds.all;
  for (const auto& [sensor, own] : seconds.each) {
    if (sensor == name || sensor == in_log) s = own;
  }
  return s ? std::optional(std::llround(*s * 1e6)) : std::nullopt;
}

LogTrack event_track(EventTracks::Track& track, LogReading& reading, const Log& log, std::int32_t unknown) {
  const bool is_people = unknown == log_state::unknown_count;
  const auto remark = [&](const std::string& before, const std::string& after) {
    return [&reading, &track, &log, before, after](std::int64_t us) {
      reading.remarks.add(before + track.in_log, {log.files.front().path}, [&] {
        return before + track.in_log + after + to_text({us, 0}, log.clock) +
               (log.clock == LogClock::zoned ? " UTC" : "");
      });
    };
  };
  MotionEnds ends;
  if (!is_people) {
    ends = {of_sensor(reading.map.hold_s, log, track.in_log),
            of_sensor(reading.map.longest_motion_s, log, track.in_log)};
  }
  std::vector<LogChange> changes =
      log.map.form == LogMap::Form::intervals
          ? united(track, *reading.first_us,
                   remark("overlapping intervals of '", "' are one: another begins within one at "))
          : changes_of(track, ends,
                       remark("motion of '",
                              "' is unknown after longest_motion_s, since nothing more is told of what begins at "));
  if (const auto longest_s = reading.map.longest_gap_s)
    changes = without(changes, reading.silences(std::llround(*longest_s * 1e6)), unknown);
  return {is_people ? "people" : name_of(log.map, track.in_log), track.in_log,
          clipped(std::move(changes), log.begin_us, log.end_us), track.n_states + track.n_other};
}

/// Those that a map has seconds of.
void require_sensors(const Log& log, const LogMap::Seconds& seconds, const std::string& key) {
  for (const auto& [sensor, s] : seconds.each) {
    std::vector<std::string> names;
    for (const LogTrack& track : log.sensors) names.insert(names.end(), {track.name, track.in_log});
    if (std::ranges::find(names, sensor) != names.end()) continue;
    throw Error(ErrorCode::input, Where{log.files.front().path},
                key + " of a map: no sensor of the log is called '" + sensor + "'" + near_or_all(sensor, names));
  }
}

/// What two files tell of one sensor at the same time may be two sensors'.
void require_parts(const EventTracks::Track& track, const std::vector<InputFile>& files) {
  using Part = EventTracks::Track::FilePart;
  const auto events_of = [&](const Part& part) {
    const auto next = std::ranges::find(track.parts, &part, [](const Part& other) { return &other; }) + 1;
    const std::size_t end = next == track.parts.end() ? track.events.size() : next->first_event;
    std::vector<LogChange> events(track.events.begin() + std::ptrdiff_t(part.first_event),
                                  track.events.begin() + std::ptrdiff_t(end));
    std::ranges::stable_sort(events, {}, &LogChange::us);
    return events;
  };
  for (const Part& part : track.parts) {
    for (const Part& before : track.parts) {
      if (&before == &part) break;
      const LogReading::Moments span{std::max(before.first_us, part.first_us), std::min(before.last_us, part.last_us)};
      if (span.first_us > span.last_us) continue;
      require_agreement(events_of(before), events_of(part), span, Where{files[part.file - 1].path},
                        "'" + track.in_log + "'");
    }
  }
}

std::string shortened_list(const std::vector<std::string>& names) {
  constexpr std::ptrdiff_t most = 12;
  return joined({names.begin(), names.begin() + std::min(most, std::ssize(names))}, ", ");
}

void finish_events(Log& log, LogReading& reading) {
  std::vector<EventTracks::Track>& tracks = reading.events.tracks();
  const Where where{log.files.front().path};
  const std::vector<std::size_t> chosen = chosen_sensors(reading, log.map, where);
  std::optional<std::size_t> people;
  if (!log.map.people.empty()) people = track_of(tracks, log.map.people, where);
  log.begin_us = std::max(*reading.first_us, reading.from_us.value_or(*reading.first_us));
  const std::int64_t after_last = *reading.last_us + 1;  // which belongs to it
  log.end_us = std::min(after_last, reading.to_us.value_or(after_last));
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (i == people) {
      require_parts(tracks[i], log.files);
      log.people = event_track(tracks[i], reading, log, log_state::unknown_count);
    }
    if (i == people || std::ranges::find(chosen, i) != chosen.end()) continue;
    log.others.push_back(tracks[i].in_log);
    log.n_other_rows += tracks[i].n_states + tracks[i].n_other;
  }
  for (const std::size_t i : chosen) {
    EventTracks::Track& track = tracks[i];
    require_parts(track, log.files);
    log.sensors.push_back(event_track(tracks[i], reading, log, log_state::unknown));
  }
  require_sensors(log, log.map.hold_s, "hold_s");
  require_sensors(log, log.map.longest_motion_s, "longest_motion_s");
  if (log.sensors.empty()) {
    std::vector<std::string> maps;
    for (const EventTracks::Track& track : tracks) {
      if (may_be_sensor(track) && maps.size() < 12) maps.push_back("sensors: [" + quoted_yaml(track.in_log) + "]");
    }
    const std::string why =
        "no motion sensor is in it: nothing is on and off, 0 and 1, or true and false, and not called "
        "a door's or a switch's; it has events of " +
        shortened_list(log.others);
    throw Error(ErrorCode::input, where, maps.empty() ? why : with_maps(why, maps));
  }
}

// ----------------------------------------------------------------------------------------------------------------- all

/// The map with what was found.
void complete(LogMap& map, const LogFile& file, const Log& log) {
  const LogShape& shape = file.shape();
  map.form = shape.form;
  map.time = {shape.names[shape.time.first]};
  for (const std::size_t column : shape.time.more) map.time.push_back(shape.names[column]);
  map.dates = shape.time.order;
  if (shape.end) {
    map.end = {shape.names[shape.end->first]};
    for (const std::size_t column : shape.end->more) map.end.push_back(shape.names[column]);
  }
  if (shape.form != LogMap::Form::wide) {
    map.sensor_column.clear();
    for (const std::size_t column : shape.sensor) map.sensor_column.push_back(shape.names[column]);
    if (shape.state) map.state_column = shape.names[*shape.state];
  } else {
    map.rows = log.has_readings() ? LogMap::Rows::readings : LogMap::Rows::changes;
    map.empty = shape.empty;
  }
  if (log.has_readings() && !map.interval_s) map.interval_s = static_cast<double>(log.interval_us) / 1e6;
  map.sensors.clear();
  for (const LogTrack& track : log.sensors) map.sensors.push_back({track.name, track.in_log});
  if (log.people) map.people = log.people->in_log;
  map.people_mean = log.people ? shape.people_mean : LogMap::People::none;
}

/// A sensor that was renamed: it says what the name says that told last. That one name isn't known tells nothing while
/// another one is.
void join_renamed(Log& log) {
  for (std::size_t i = 0; i < log.sensors.size(); ++i) {
    LogTrack& track = log.sensors[i];
    std::vector<std::pair<LogChange, std::size_t>> told;
    std::size_t n_names = 0, n_turns = 0;
    for (const LogTrack& part : log.sensors) {
      if (part.name != track.name) continue;
      for (const LogChange& change : part.changes) told.emplace_back(change, n_names);
      if (n_names++ > 0) (track.in_log += ", ") += part.in_log, track.n_read += part.n_read;
    }
    if (n_names < 2) continue;
    std::ranges::stable_sort(told, {}, [](const auto& one) { return one.first.us; });
    std::vector<LogChange> joined_changes;
    std::optional<std::size_t> last;
    for (const auto& [change, name] : told) {
      if (last && *last != name && change.value == log_state::unknown) continue;
      n_turns += last && *last != name ? 1 : 0;
      last = name;
      if (!joined_changes.empty() && joined_changes.back().us == change.us) joined_changes.pop_back();
      if (joined_changes.empty() || joined_changes.back().value != change.value) joined_changes.push_back(change);
    }
    if (n_turns >= n_names) {
      throw Error(ErrorCode::input, Where{log.files.front().path},
                  "sensors: the names of '" + track.name +
                      "' tell in turns, so that they are several sensors': " + track.in_log);
    }
    track.changes = std::move(joined_changes);
    const auto is_part = [&](const LogTrack& part) { return &part != &track && part.name == track.name; };
    log.sensors.erase(std::remove_if(log.sensors.begin() + std::ptrdiff_t(i) + 1, log.sensors.end(), is_part),
                      log.sensors.end());
  }
}

/// Rows from before the clock was set: few, or those before the time from which on a map wants the log.
void require_few_unset(LogReading& reading, const Log& log) {
  constexpr std::uint64_t one_in = 50;  // assumed
  const bool are_few = !reading.map.from.empty() || one_in * reading.unset.count() <= reading.n_rows;
  for (Issue& issue : reading.unset.issues(are_few ? Severity::warning : Severity::error)) {
    const std::string why = reading.first_us
                                ? with_maps(issue.message, {"from: " + to_text({*reading.first_us, 0}, log.clock)})
                                : issue.message;
    if (!are_few) throw Error(ErrorCode::input, issue.where, why);
    reading.remarks.add("unset", issue.where, [&] { return issue.message; });
  }
}

/// Rows of changes become events of columns, which are known: those of all files.
void take_columns(LogMap& map, const std::vector<std::unique_ptr<LogFile>>& files) {
  if (files.front()->shape().form != LogMap::Form::wide) return;
  std::vector<LogMap::Sensor> sensors;
  for (const auto& file : files) {
    const LogShape& shape = file->shape();
    for (const std::size_t column : shape.sensors) {
      const std::string& name = shape.names[column];
      if (std::ranges::find(sensors, name, &LogMap::Sensor::in_log) == sensors.end())
        sensors.push_back({name_of(map, name), name});
    }
    if (!shape.people) continue;
    const std::string& people = shape.names[*shape.people];
    if (!map.people.empty() && map.people != people)
      throw Error(ErrorCode::input, Where{file->file().path},
                  "it counts people in '" + people + "', another file in '" + map.people + "'");
    map.people = people;
  }
  map.sensors = std::move(sensors);
}

void check_names(const Log& log) {
  std::set<std::string> names;
  for (const LogTrack& track : log.sensors) {
    const Where where{log.files.front().path};
    if (const std::string fault = line_fault(track.name); !fault.empty())
      throw Error(ErrorCode::input, where, "sensor '" + track.name + "': " + fault);
    if (!names.insert(track.name).second)
      throw Error(ErrorCode::input, where, "two sensors are called '" + track.name + "'");
    if (is_column_name(track.name)) {
      throw Error(ErrorCode::input, where,
                  with_maps("sensor '" + track.name + "' has the name of a column of rows",
                            {"sensors: {PIR1: " + quoted_yaml(track.in_log) + "}"}));
    }
  }
}

/// Intervals tell them themselves.
void require_no_ends(const LogMap& map, const std::string& file) {
  if (map.hold_s == LogMap::Seconds{} && map.longest_motion_s == LogMap::Seconds{} && !map.longest_gap_s) return;
  throw Error(ErrorCode::input, Where{file},
              "intervals tell when motion ends: hold_s, longest_motion_s and longest_gap_s of a map don't fit them");
}

std::vector<LogOffset> in_order(std::vector<LogOffset> offsets) {
  std::ranges::stable_sort(offsets, {}, &LogOffset::from_us);
  const auto same = [](const LogOffset& a, const LogOffset& b) { return a.offset_s == b.offset_s; };
  offsets.erase(std::unique(offsets.begin(), offsets.end(), same), offsets.end());
  return offsets;
}

void require_one_form(const LogFile& first, LogFile& other, LogFile& first_again) {
  const bool is_same =
      first.shape().form == other.shape().form && first_again.readings().has_value() == other.readings().has_value();
  if (!other.source().empty() && other.timer().clock() == LogClock::elapsed) {
    throw Error(ErrorCode::input, Where{other.file().path},
                "its times are times of day, so that files can't be put in order: join them in one");
  }
  const bool is_same_clock = first_again.timer().clock() == other.timer().clock();
  if (is_same && other.source().empty() && first.source().empty() &&
      (first.shape().header_line > 0) != (other.shape().header_line > 0)) {
    throw Error(ErrorCode::input, Where{other.file().path},
                std::string("its first line ") + (other.shape().header_line > 0 ? "names" : "doesn't name") +
                    " the columns, the first file's " + (other.shape().header_line > 0 ? "doesn't" : "does"));
  }
  if (is_same && is_same_clock) return;
  throw Error(ErrorCode::input, Where{other.file().path},
              is_same ? "its times are of another kind than those of the first file"
                      : "it has another form than the first file");
}

std::int64_t now_us() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count();
}

}  // namespace

static Log read_once(std::span<const std::filesystem::path> files, const LogMap& map, const LogObserver& observer) {
  std::optional<LogZone> zone;
  if (!map.time_zone.empty()) zone.emplace(map.time_zone, Where{});
  LogReading reading{map, zone ? &*zone : nullptr};
  Log log;
  log.map = map;
  std::vector<std::unique_ptr<LogFile>> read;
  for (const std::filesystem::path& file : files) {
    LogFile& opened = *read.emplace_back(std::make_unique<LogFile>(file, reading, observer));
    if (read.size() == 1) {
      reading.from_us = opened.limit("from", map.from);
      reading.to_us = opened.limit("to", map.to);
      if (reading.from_us && reading.to_us && *reading.from_us >= *reading.to_us)
        throw Error(ErrorCode::usage, "to: expected a time after from, " + map.from);
    } else {
      require_one_form(*read.front(), opened, *read.front());
    }
    opened.read();
    log.files.push_back(opened.file());
  }
  if (reading.faults.count() > 0) throw Error(ErrorCode::input, reading.faults.issues(Severity::error));
  log.clock = read.front()->clock();
  require_few_unset(reading, log);
  pass_times(reading, *read.front(), observer.now_us.value_or(now_us()));
  LogFile& first = *read.front();
  log.n_rows = reading.n_rows;
  log.source = first.source();
  for (const auto& file : read) log.n_other_lines += file->n_other_lines();
  const auto refuse_part = [&] {
    throw Error(ErrorCode::usage, "nothing of the log is between from and to; its first time is " +
                                      to_text({*reading.first_us, 0}, log.clock) + (zone ? " UTC" : "") +
                                      ", its last " + to_text({*reading.last_us, 0}, log.clock));
  };
  log.others = first.shape().others;
  if (first.readings()) {
    std::vector<LogFile*> parts;
    for (const auto& file : read) parts.push_back(file.get());
    std::ranges::stable_sort(parts, {}, [](LogFile* file) { return file->readings()->first_us(); });
    ReadingParts all(log);
    for (LogFile* part : parts) all.add(*part);
    if (log.interval_us == 0) refuse_part();
    all.finish();
  } else {
    if (reading.from_us.value_or(*reading.first_us) > *reading.last_us ||
        reading.to_us.value_or(*reading.last_us) < *reading.first_us)
      refuse_part();
    take_columns(log.map, read);
    log.map.form = first.shape().form;
    if (log.map.form == LogMap::Form::intervals) require_no_ends(log.map, log.files.front().path);
    finish_events(log, reading);
  }
  if (zone) {
    log.offsets = zone->offsets(log.begin_us, log.end_us);
  } else {
    for (const auto& file : read) {
      const std::vector<LogOffset> more = file->timer().offsets(log.begin_us, log.end_us);
      log.offsets.insert(log.offsets.end(), more.begin(), more.end());
    }
    log.offsets = in_order(std::move(log.offsets));
  }
  complete(log.map, first, log);
  join_renamed(log);
  check_names(log);
  pass_tracks(log, reading, first);
  log.remarks = reading.remarks.issues(Severity::warning);
  return log;
}

Log read_log(std::span<const std::filesystem::path> files, const LogMap& map, const LogObserver& observer) {
  if (files.empty()) throw Error(ErrorCode::usage, "a log has at least one file");
  try {
    return read_once(files, map, observer);
  } catch (const Overlap&) {
    const auto is_twice = [](const std::filesystem::path& file) { return std::filesystem::is_regular_file(file); };
    if (map.files != LogMap::Files::found || !std::ranges::all_of(files, is_twice)) throw;
    LogMap of_sensors = map;
    of_sensors.files = LogMap::Files::sensors;
    try {
      return read_once(files, of_sensors, observer);
    } catch (const Error&) {  // they have several
    }
    throw;
  }
}

LogRows read_log_rows(std::span<const std::filesystem::path> files, const LogMap& map, double window_s) {
  const Log log = read_log(files, map);
  return LogWindows(log, window_s).rows();
}

}  // namespace pirsim::io

// What a log's columns mean, as YAML.

namespace pirsim {

template <>
struct Words<LogMap::Form> {
  static constexpr WordList<LogMap::Form, 3> all{
      {{"wide", LogMap::Form::wide}, {"events", LogMap::Form::events}, {"intervals", LogMap::Form::intervals}}};
};
template <>
struct Words<LogMap::Rows> {
  static constexpr WordList<LogMap::Rows, 2> all{
      {{"readings", LogMap::Rows::readings}, {"changes", LogMap::Rows::changes}}};
};
template <>
struct Words<LogMap::Dates> {
  static constexpr WordList<LogMap::Dates, 3> all{{{"month_first", LogMap::Dates::month_first},
                                                   {"day_first", LogMap::Dates::day_first},
                                                   {"year_first", LogMap::Dates::year_first}}};
};
template <>
struct Words<LogMap::Order> {
  static constexpr WordList<LogMap::Order, 2> all{
      {{"oldest_first", LogMap::Order::oldest_first}, {"newest_first", LogMap::Order::newest_first}}};
};
template <>
struct Words<LogMap::Files> {
  static constexpr WordList<LogMap::Files, 2> all{
      {{"parts", LogMap::Files::parts}, {"sensors", LogMap::Files::sensors}}};
};
template <>
struct Words<LogMap::Stamps> {
  static constexpr WordList<LogMap::Stamps, 2> all{{{"end", LogMap::Stamps::end}, {"begin", LogMap::Stamps::begin}}};
};
template <>
struct Words<LogMap::People> {
  static constexpr WordList<LogMap::People, 2> all{
      {{"count", LogMap::People::count}, {"presence", LogMap::People::presence}}};
};
template <>
struct Words<LogMap::Empty> {
  static constexpr WordList<LogMap::Empty, 2> all{
      {{"unknown", LogMap::Empty::unknown}, {"unchanged", LogMap::Empty::unchanged}}};
};

}  // namespace pirsim

namespace pirsim::io {
namespace {

template <Worded Enum>
Enum choice(YamlMap& map, const std::string& key, Enum otherwise) {
  return map.choice(key, otherwise, {Words<Enum>::all.begin(), Words<Enum>::all.end()});
}

/// `time: stamp`, `time: [Date, Time]`, or `time: [Date, Time, AmPm]`.
std::vector<std::string> read_time(YamlMap& map, const std::string& key) {
  const auto node = map.child(key);
  std::vector<std::string> columns = map.texts(key);
  if (node && (columns.empty() || columns.size() > 3)) {
    map.faults().error(node->where(), key + ": expected a column, or those of date, time, and AM or PM or an offset");
  }
  return columns;
}

/// `states: {on: [pir, 255], off: none}`, and `above: 0`.
LogMap::States read_states(YamlMap& map) {
  LogMap::States states;
  states.above = map.optional_number("above", {.min = -1e9, .max = 1e9});
  const auto node = map.child("states");
  if (!node) return states;
  YamlMap words(*node, map.faults(), "states");
  states.on = words.texts("on");
  states.off = words.texts("off");
  words.finish();
  for (const std::string& word : states.on) {
    if (std::ranges::find(states.off, word) != states.off.end())
      map.faults().error(node->where(), "states: '" + word + "' is on and off");
  }
  return states;
}

/// `hold_s: 30`, or of some sensors `hold_s: {hall: 30}`.
LogMap::Seconds read_seconds(YamlMap& map, const std::string& key, NumberRange range) {
  LogMap::Seconds seconds;
  const auto node = map.child(key);
  if (!node) return seconds;
  if (!node->is_map()) {
    seconds.all = node->number(map.faults(), key, range);
    return seconds;
  }
  const std::vector<YamlKey> keys = node->keys();
  const std::vector<YamlNode> values = node->items();
  for (std::size_t i = 0; i < keys.size(); ++i)
    seconds.each.emplace_back(keys[i].name, values[i].number(map.faults(), key + ": " + keys[i].name, range));
  return seconds;
}

/// `sensors: {PIR1: S6_PIR}`, one that was renamed `{PIR1: [old, new]}`, or `[S6_PIR, S7_PIR]` under their own names.
std::vector<LogMap::Sensor> read_sensors(YamlMap& map) {
  const auto node = map.child("sensors");
  if (!node || node->is_null()) return {};
  std::vector<LogMap::Sensor> sensors;
  if (node->n_items() > limits::sensors) {
    map.faults().error(node->where(), too_many(limits::sensors, "sensors"));
    return {};
  }
  if (!node->is_map()) {
    for (const YamlNode& item : read_list(*node, map.faults(), "sensors", limits::sensors)) {
      const std::string name = item.text(map.faults(), "sensors");
      sensors.push_back({name, name});
    }
    return sensors;
  }
  const std::vector<YamlKey> keys = node->keys();
  const std::vector<YamlNode> values = node->items();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (const std::string fault = line_fault(keys[i].name); !fault.empty())
      map.faults().error(keys[i].where, "sensors: '" + keys[i].name + "': " + fault);
    const std::string label = "sensors: " + keys[i].name;
    std::vector<YamlNode> names{values[i]};
    if (values[i].is_list()) names = read_list(values[i], map.faults(), label);
    for (const YamlNode& name : names) sensors.push_back({keys[i].name, name.text(map.faults(), label)});
  }
  return sensors;
}

/// Each column is one sensor's.
void check_sensors(YamlMap& map, const std::vector<LogMap::Sensor>& sensors) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const auto before = sensors.begin() + static_cast<std::ptrdiff_t>(i);
    const bool is_first = std::find_if(sensors.begin(), before,
                                       [&](const auto& other) { return other.in_log == sensors[i].in_log; }) == before;
    if (is_first && !is_column_name(sensors[i].name)) continue;
    const YamlNode node = *map.child("sensors");
    const std::vector<YamlNode> items = node.items();
    const Where where = items.size() == sensors.size() ? items[i].where() : node.where();
    if (!is_first) map.faults().error(where, "sensors: '" + sensors[i].in_log + "' is named twice");
    if (is_column_name(sensors[i].name))
      map.faults().error(where, "sensors: '" + sensors[i].name +
                                    "' is the name of a column of rows: give the sensor another one, as {PIR1: " +
                                    quoted_yaml(sensors[i].in_log) + "}");
  }
}

/// `people: Room_Occupancy_Count`, with what it means, or `people: none`.
void read_people(YamlMap& map, LogMap& log) {
  const auto node = map.child("people");
  if (!node) return;
  if (!node->is_map()) {
    log.people = node->is_null() ? "" : node->text(map.faults(), "people");
    if (log.people.empty())
      map.faults().error(node->where(), "people: expected a column, or `none` for a log without a count");
    if (log.people != "none") return;
    log.people.clear();
    log.people_mean = LogMap::People::none;
    return;
  }
  YamlMap people(*node, map.faults(), "people");
  log.people = people.required_text("column");
  log.people_mean = choice(people, "means", log.people_mean);
  people.finish();
}

LogMap map_from(const YamlNode& root) {
  Diagnostics faults;
  YamlMap map(root, faults, "map of a log");
  check_version(map, "pirsim_log");
  LogMap log;
  log.form = choice(map, "form", log.form);
  log.rows = choice(map, "rows", log.rows);
  log.empty = choice(map, "empty", log.empty);
  log.time = read_time(map, "time");
  log.end = read_time(map, "end");
  log.sensor_column = map.texts("sensor");
  log.state_column = map.text("state");
  log.states = read_states(map);
  log.order = choice(map, "order", log.order);
  log.files = choice(map, "files", log.files);
  log.time_format = map.text("time_format");
  log.time_zone = map.text("time_zone");
  log.dates = choice(map, "dates", log.dates);
  log.stamps = choice(map, "stamps", log.stamps);
  log.sensors = read_sensors(map);
  check_sensors(map, log.sensors);
  read_people(map, log);
  constexpr NumberRange length{.min = 1e-3, .max = 4e5};
  log.interval_s = map.optional_number("interval_s", length);
  log.longest_gap_s = map.optional_number("longest_gap_s", {.min = 1e-3, .max = 1e8});
  log.hold_s = read_seconds(map, "hold_s", length);
  log.longest_motion_s = read_seconds(map, "longest_motion_s", length);
  log.shift_s = map.number("shift_s", log.shift_s, {.min = -1e6, .max = 1e6});
  log.from = map.text("from");
  log.to = map.text("to");
  map.finish();
  faults.throw_if_errors();
  return log;
}

/// Of each sensor, in the map's order.
std::vector<std::pair<std::string, std::vector<std::string>>> names_in_log(const LogMap& map) {
  std::vector<std::pair<std::string, std::vector<std::string>>> all;
  for (const LogMap::Sensor& sensor : map.sensors) {
    auto known = std::ranges::find(all, sensor.name, [](const auto& one) { return one.first; });
    if (known == all.end()) known = all.insert(known, {sensor.name, {}});
    known->second.push_back(sensor.in_log);
  }
  return all;
}

}  // namespace

LogMap read_log_map(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return map_from(YamlNode::load(read_input(file), overrides));
}
LogMap parse_log_map(std::string_view text, const std::string& name) { return map_from(YamlNode::parse(text, name)); }

std::string to_yaml(const LogMap& map) {
  std::ostringstream out;
  const auto line = [&](const char* key, const std::string& value) {
    if (!value.empty()) out << key << ": " << value << '\n';
  };
  const auto text = [&](const char* key, const std::string& value) {
    if (!value.empty()) line(key, quoted_yaml(value));
  };
  const auto number = [&](const char* key, const std::optional<double>& value) {
    if (value) line(key, csv_number(*value));
  };
  const auto texts = [&](const char* key, const std::vector<std::string>& all) {
    if (all.size() == 1) text(key, all.front());
    if (all.size() > 1) line(key, quoted_yaml(all));
  };
  const auto seconds = [&](const char* key, const LogMap::Seconds& value) {
    if (value.each.empty()) return number(key, value.all);
    out << key << ":\n";
    for (const auto& [sensor, s] : value.each) out << "  " << quoted_yaml(sensor) << ": " << csv_number(s) << '\n';
  };
  line("pirsim_log", "1");
  line("form", word_of(map.form));
  line("rows", word_of(map.rows));
  line("empty", word_of(map.empty));
  texts("time", map.time);
  texts("end", map.end);
  texts("sensor", map.sensor_column);
  text("state", map.state_column);
  if (!map.states.on.empty() || !map.states.off.empty())
    line("states", "{on: " + quoted_yaml(map.states.on) + ", off: " + quoted_yaml(map.states.off) + "}");
  number("above", map.states.above);
  line("order", word_of(map.order));
  line("files", word_of(map.files));
  text("time_format", map.time_format);
  text("time_zone", map.time_zone);
  line("dates", word_of(map.dates));
  if (map.stamps != LogMap::Stamps::end) line("stamps", word_of(map.stamps));
  if (!map.sensors.empty()) out << "sensors:\n";
  for (const auto& [name, names] : names_in_log(map)) texts(("  " + quoted_yaml(name)).c_str(), names);
  if (!map.people.empty())
    out << "people: {column: " << quoted_yaml(map.people) << ", means: " << word_of(map.people_mean) << "}\n";
  if (map.people_mean == LogMap::People::none) line("people", "none");
  number("interval_s", map.interval_s);
  number("longest_gap_s", map.longest_gap_s);
  seconds("hold_s", map.hold_s);
  seconds("longest_motion_s", map.longest_motion_s);
  if (map.shift_s != 0.0) number("shift_s", map.shift_s);
  text("from", map.from);
  text("to", map.to);
  return out.str();
}

}  // namespace pirsim::io
