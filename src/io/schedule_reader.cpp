#include "io/reader_parts.hpp"

#include <cmath>
#include <numeric>

#include "io/yaml_map.hpp"
#include "schema/schedule_people.hpp"

namespace pirsim::io {
namespace {

/// "08:30", as hours.
double read_time(YamlMap& map, const std::string& key, double otherwise, Diagnostics& faults) {
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
  clock.mean_h = read_time(own, "mean", otherwise.mean_h, faults);
  clock.sd_min = own.number("sd_min", otherwise.sd_min, {.min = 0.0, .max = 240.0});
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
  const int own = static_cast<int>(staff.seats.size());
  staff.count = map.integer("count", std::max(1, own), {.min = std::max(1, own), .max = 200});
  map.finish();
  return staff;
}

HeldMeetingSpec read_held(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "held");
  HeldMeetingSpec held;
  held.where = node.where();
  if (!map.has("at")) faults.error(node.where(), "held: `at` is missing");
  held.at_h = read_time(map, "at", held.at_h, faults);
  held.duration_min = map.number("duration_min", held.duration_min, {.min = 1.0, .max = 1440.0});
  held.people = map.integer("people", held.people, {.min = 1, .max = 200});
  if (held.at_h + held.duration_min / 60.0 > 24.0) {
    faults.error(node.where(), "held: a meeting at " + map.text("at") + " that lasts beyond midnight");
  }
  map.finish();
  return held;
}

void check_held(const std::vector<HeldMeetingSpec>& meetings, Diagnostics& faults) {
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const HeldMeetingSpec& one = meetings[j];
      const HeldMeetingSpec& other = meetings[i];
      if (one.at_h + one.duration_min / 60.0 <= other.at_h || other.at_h + other.duration_min / 60.0 <= one.at_h)
        continue;
      faults.error(other.where,
                   "held: overlaps the meeting of line " + std::to_string(one.where.line) + ", and there is one room");
    }
  }
}

void check_durations(const MeetingsSpec& spec, const Where& where, Diagnostics& faults) {
  if (spec.durations_min.size() != spec.probabilities.size() || spec.durations_min.empty()) {
    faults.error(where, "probabilities: expected one for each of durations_min");
  } else if (std::accumulate(spec.probabilities.begin(), spec.probabilities.end(), 0.0) <= 0.0) {
    faults.error(where, "probabilities: expected a sum above 0");
  }
}

MeetingsSpec read_meetings(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "meetings");
  MeetingsSpec spec;
  spec.where = node.where();
  spec.fewest_a_day = map.integer("fewest_a_day", spec.fewest_a_day, {.min = 0, .max = 100});
  spec.most_a_day =
      map.integer("most_a_day", std::max(spec.fewest_a_day, spec.most_a_day), {.min = spec.fewest_a_day, .max = 100});
  spec.fewest_people = map.integer("fewest_people", spec.fewest_people, {.min = 1, .max = 200});
  if (map.has("most_people")) {
    spec.most_people = map.integer("most_people", spec.fewest_people, {.min = spec.fewest_people, .max = 200});
  }
  spec.durations_min = map.numbers("durations_min", spec.durations_min, {.min = 1.0, .max = 1440.0});
  spec.probabilities = map.numbers("probabilities", spec.probabilities, {.min = 0.0, .max = 1.0});
  check_durations(spec, map.where(map.has("probabilities") ? "probabilities" : "durations_min"), faults);
  spec.from_h = read_time(map, "from", spec.from_h, faults);
  spec.to_h = read_time(map, "to", spec.to_h, faults);
  if (spec.from_h >= spec.to_h) faults.error(map.where("to"), "meetings: `to` is not after `from`");
  spec.lateness_min = map.number("lateness_min", spec.lateness_min, {.min = 0.0, .max = 60.0});
  for (const YamlNode& held : map.list("held", limits::held_meetings)) spec.held.push_back(read_held(held, faults));
  check_held(spec.held, faults);
  spec.seats = map.texts("seats");
  map.finish();
  return spec;
}

ProfileSpec read_profile(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "profile");
  ProfileSpec spec;
  constexpr std::size_t hours_a_day = 24;
  spec.presence = map.numbers("presence", {}, {.min = 0.0, .max = 1.0});
  if (spec.presence.size() != hours_a_day) {
    faults.error(map.has("presence") ? map.where("presence") : node.where(),
                 "presence: expected 24 shares, one for each hour of the day");
    spec.presence.assign(hours_a_day, 0.0);
  }
  spec.mobility = map.number("mobility", spec.mobility, {.min = 0.0, .max = 10.0});
  spec.step_min = map.number("step_min", spec.step_min, {.min = 1.0, .max = 120.0});
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
  try {
    static_cast<void>(day_number(spec.first_day, map.where("first_day")));
  } catch (const Error& error) {
    for (const Issue& issue : error.issues()) faults.error(issue.where, issue.message);
  }
  spec.from_h = read_time(map, "from", spec.from_h, faults);
  spec.to_h = read_time(map, "to", spec.to_h, faults);
  if (spec.from_h >= spec.to_h)
    faults.error(map.has("to") ? map.where("to") : node->where(), "schedule: `to` is not after `from`");
  for (const YamlNode& staff : map.list("staff")) spec.staff.push_back(read_staff(staff, faults));
  if (const auto child = map.child("meetings")) spec.meetings = read_meetings(*child, faults);
  if (const auto child = map.child("profile")) spec.profile = read_profile(*child, faults);
  spec.arrival = read_clock(map, "arrival", spec.arrival, faults);
  spec.departure = read_clock(map, "departure", spec.departure, faults);
  spec.lunch = read_clock(map, "lunch", spec.lunch, faults);
  if (spec.departure.mean_h <= spec.arrival.mean_h) {
    faults.error(map.has("departure") ? map.where("departure") : node->where(),
                 "schedule: departure must be after arrival");
  }
  spec.lunch_min = map.number("lunch_min", spec.lunch_min, {.min = 0.0, .max = 240.0});
  spec.lunch_sd_min = map.number("lunch_sd_min", spec.lunch_sd_min, {.min = 0.0, .max = 120.0});
  if (map.has("cleaning")) {
    spec.cleaning_h = read_time(map, "cleaning", 19.0, faults);
  } else {
    static_cast<void>(map.text("cleaning"));
  }
  spec.entrances = map.texts("entrances");
  spec.style = map.choice<MotionStyle>(
      "style", spec.style, {{"choreographed", MotionStyle::choreographed}, {"natural", MotionStyle::natural}});
  if (spec.staff.empty() && !spec.meetings && !spec.cleaning_h) {
    faults.error(node->where(), "schedule: nobody comes: give `staff`, `meetings` or `cleaning`");
  }
  map.finish();
  return spec;
}

}  // namespace pirsim::io
