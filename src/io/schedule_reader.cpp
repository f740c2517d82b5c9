#include "io/reader_parts.hpp"

#include <cmath>
#include <cstdio>
#include <numeric>

#include "io/yaml_map.hpp"
#include "schema/schedule_people.hpp"

namespace pirsim::io {
namespace {

constexpr NumberRange hours{.min = 0.0, .max = 24.0};

/// "08:30", as hours.
double read_time(YamlMap& map, const std::string& key, double otherwise, Diagnostics& faults) {
  if (!map.has(key)) {
    static_cast<void>(map.text(key));
    return otherwise;
  }
  const std::string text = map.text(key);
  unsigned hour = 0, minute = 0;
  char more = 0;
  const bool good = std::sscanf(text.c_str(), "%2u:%2u%c", &hour, &minute, &more) == 2 && minute < 60 &&
                    60 * hour + minute <= 24 * 60;
  if (!good) faults.error(map.where(key), key + ": expected a time of day from 00:00 to 24:00, e.g. 08:30");
  return good ? hour + minute / 60.0 : otherwise;
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
  staff.role = map.choice<Role>(
      "role", staff.role, {{"staff", Role::staff}, {"manager", Role::manager}, {"administrator", Role::administrator}});
  for (const YamlNode& seat : map.list("seats")) staff.seats.push_back(seat.text(faults, "seats"));
  const int own = static_cast<int>(staff.seats.size());
  staff.count = map.integer("count", std::max(1, own), {.min = std::max(1, own), .max = 200});
  map.finish();
  return staff;
}

MeetingsSpec read_meetings(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "meetings");
  MeetingsSpec spec;
  spec.fewest_a_day = map.integer("fewest_a_day", spec.fewest_a_day, {.min = 0, .max = 100});
  spec.most_a_day =
      map.integer("most_a_day", std::max(spec.fewest_a_day, spec.most_a_day), {.min = spec.fewest_a_day, .max = 100});
  spec.fewest_people = map.integer("fewest_people", spec.fewest_people, {.min = 1, .max = 200});
  spec.most_people = map.integer("most_people", std::max(spec.fewest_people, spec.most_people),
                                 {.min = spec.fewest_people, .max = 200});
  spec.durations_min = map.numbers("durations_min", spec.durations_min, {.min = 1.0, .max = 1440.0});
  spec.probabilities = map.numbers("probabilities", spec.probabilities, {.min = 0.0, .max = 1.0});
  spec.from_h = read_time(map, "from", spec.from_h, faults);
  spec.to_h = read_time(map, "to", spec.to_h, faults);
  spec.lateness_min = map.number("lateness_min", spec.lateness_min, {.min = 0.0, .max = 60.0});
  if (spec.durations_min.size() != spec.probabilities.size() || spec.durations_min.empty()) {
    faults.error(map.where("probabilities"), "probabilities: expected one for each of durations_min");
  } else if (std::accumulate(spec.probabilities.begin(), spec.probabilities.end(), 0.0) <= 0.0) {
    faults.error(map.where("probabilities"), "probabilities: expected a sum above 0");
  }
  if (spec.from_h >= spec.to_h) faults.error(map.where("to"), "meetings: `to` is not after `from`");
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
                 "schedule: people leave before they come: departure isn't after arrival");
  }
  spec.lunch_min = map.number("lunch_min", spec.lunch_min, {.min = 0.0, .max = 240.0});
  spec.lunch_sd_min = map.number("lunch_sd_min", spec.lunch_sd_min, {.min = 0.0, .max = 120.0});
  if (map.has("cleaning")) {
    spec.cleaning_h = read_time(map, "cleaning", 19.0, faults);
  } else {
    static_cast<void>(map.text("cleaning"));
  }
  for (const YamlNode& door : map.list("entrances")) spec.entrances.push_back(door.text(faults, "entrances"));
  if (spec.staff.empty() && !spec.meetings && !spec.cleaning_h) {
    faults.error(node->where(), "schedule: nobody comes: give `staff`, `meetings` or `cleaning`");
  }
  map.finish();
  return spec;
}

}  // namespace pirsim::io
