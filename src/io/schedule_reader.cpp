#include "io/reader_parts.hpp"

#include <algorithm>
#include <cmath>

#include "io/yaml_map.hpp"
#include "schema/clock.hpp"

namespace pirsim::io {
namespace {

/// "08:30", as hours.
double read_hours(YamlMap& map, const std::string& key, double otherwise, Diagnostics& faults) {
  if (!map.has(key)) {
    static_cast<void>(map.text(key));
    return otherwise;
  }
  const std::string text = map.text(key);
  constexpr std::size_t to_minutes = 5;
  const auto hours = text.size() <= to_minutes ? clock_hours(text) : std::nullopt;
  if (!hours) faults.error(map.where(key), key + ": expected a time of day from 00:00 to 24:00, e.g. 08:30");
  return hours.value_or(otherwise);
}

ClockSpec read_clock(YamlMap& map, const std::string& key, const ClockSpec& otherwise, Diagnostics& faults) {
  const auto child = map.child(key);
  if (!child) return otherwise;
  YamlMap own(*child, faults, key);
  ClockSpec clock;
  clock.mean_h = read_hours(own, "mean", otherwise.mean_h, faults);
  clock.sd_min = otherwise.sd_min;
  read_numbers(own, clock);
  own.finish();
  return clock;
}

StaffSpec read_staff(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "staff");
  StaffSpec staff;
  staff.where = node.where();
  staff.role = map.choice<Role>(
      "role", staff.role, {{"staff", Role::staff}, {"manager", Role::manager}, {"administrator", Role::administrator}});
  staff.seats = map.texts("seats");
  staff.count = std::max(1, static_cast<int>(staff.seats.size()));
  read_numbers(map, staff);
  map.finish();
  return staff;
}

HeldMeetingSpec read_held(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "held");
  HeldMeetingSpec held;
  held.where = node.where();
  if (!map.has("at")) faults.error(node.where(), "held: `at` is missing");
  held.at_h = read_hours(map, "at", held.at_h, faults);
  read_numbers(map, held);
  check_together(held, [&](std::string_view, const std::string& message) {
    faults.error(node.where(), "held: at " + map.text("at") + ": " + message);
  });
  map.finish();
  return held;
}

/// The field of a time is called so, its key isn't: `from_h`.
std::string key_of(std::string_view field) {
  if (field.ends_with("_h")) field.remove_suffix(2);
  return std::string(field);
}

MeetingsSpec read_meetings(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "meetings");
  MeetingsSpec spec;
  spec.where = node.where();
  read_numbers(map, spec);
  if (!map.has("most_a_day")) spec.most_a_day = std::max(spec.most_a_day, spec.fewest_a_day);
  spec.from_h = read_hours(map, "from", spec.from_h, faults);
  spec.to_h = read_hours(map, "to", spec.to_h, faults);
  for (const YamlNode& held : map.list("held", limits::held_meetings)) spec.held.push_back(read_held(held, faults));
  check_together(spec.held, [&](std::size_t i, std::size_t j) {
    faults.error(spec.held[i].where, "held: overlaps the meeting of line " + std::to_string(spec.held[j].where.line) +
                                         ", and there is one room");
  });
  check_together(spec, [&](std::string_view field, const std::string& message) {
    const bool is_time = field == "to_h";
    const std::string key = is_time ? "to" : map.has("probabilities") ? "probabilities" : "durations_min";
    faults.error(map.where(key), (is_time ? "meetings: " : "probabilities: ") + message);
  });
  spec.seats = map.texts("seats");
  map.finish();
  return spec;
}

ProfileSpec read_profile(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "profile");
  ProfileSpec spec;
  read_numbers(map, spec);
  check_together(spec, faults_by_key(map));
  map.finish();
  return spec;
}

}  // namespace

std::optional<ScheduleSpec> read_schedule(const std::optional<YamlNode>& node, Diagnostics& faults) {
  if (!node) return std::nullopt;
  YamlMap map(*node, faults, "schedule");
  ScheduleSpec spec;
  spec.where = node->where();
  spec.first_day = map.text("first_day", spec.first_day);
  spec.from_h = read_hours(map, "from", spec.from_h, faults);
  spec.to_h = read_hours(map, "to", spec.to_h, faults);
  for (const YamlNode& staff : map.list("staff")) spec.staff.push_back(read_staff(staff, faults));
  if (const auto child = map.child("meetings")) spec.meetings = read_meetings(*child, faults);
  if (const auto child = map.child("profile")) spec.profile = read_profile(*child, faults);
  spec.arrival = read_clock(map, "arrival", spec.arrival, faults);
  spec.departure = read_clock(map, "departure", spec.departure, faults);
  spec.lunch = read_clock(map, "lunch", spec.lunch, faults);
  read_numbers(map, spec);
  if (map.has("cleaning")) {
    spec.cleaning_h = read_hours(map, "cleaning", 19.0, faults);
  } else {
    static_cast<void>(map.text("cleaning"));
  }
  spec.entrances = map.texts("entrances");
  spec.style = map.choice<MotionStyle>(
      "style", spec.style, {{"choreographed", MotionStyle::choreographed}, {"natural", MotionStyle::natural}});
  check_together(spec, [&](std::string_view field, const std::string& message) {
    const bool is_date = field == "first_day";
    faults.error(map.where(key_of(field)), is_date ? message : "schedule: " + message);
  });
  map.finish();
  return spec;
}

ScriptTime read_time(YamlMap& script, const std::optional<ScheduleSpec>& schedule, ScriptSpec& spec) {
  constexpr RunClock any{};  // where it isn't understood, so that no second fault follows
  spec.begin = script.text("begin");
  if (schedule) {
    const double day_s = std::round(3600.0 * (schedule->to_h - schedule->from_h));
    if (script.faults().has_errors()) return {any, day_s};
    TrialSpec day;
    day.schedule = schedule;
    return {clock_of(spec, day), day_s};
  }
  if (!script.has("begin")) return {};
  return {clock_from(spec.begin).value_or(any)};
}

}  // namespace pirsim::io
