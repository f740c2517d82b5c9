#include "io/read/reader_parts.hpp"

#include <algorithm>
#include <cmath>

#include "io/read/yaml_map.hpp"
#include "schema/clock.hpp"
#include "schema/household_clocks.hpp"
#include "schema/occupancy_runs.hpp"

namespace pirsim::io {
namespace {

StaffSpec read_staff(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "staff");
  StaffSpec staff;
  staff.where = node.where();
  read_fields(map, staff);
  if (!map.has("count")) staff.count = std::max(1, static_cast<int>(staff.seats.size()));
  map.finish();
  return staff;
}

HeldMeetingSpec read_held(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "held");
  HeldMeetingSpec held;
  held.where = node.where();
  if (!map.has("at")) faults.error(node.where(), "held: `at` is missing");
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
  spec.area = map.text("area");
  read_fields(map, spec);
  if (!map.has("most_a_day")) spec.most_a_day = std::max(spec.most_a_day, spec.fewest_a_day);
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
  map.finish();
  return spec;
}

HouseholdSpec read_household(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "household");
  HouseholdSpec household;
  for (const YamlNode& entry : map.list("residents")) {
    YamlMap own(entry, faults, "residents");
    ResidentSpec& resident = household.residents.emplace_back();
    resident.where = entry.where();
    resident.id = own.text("id");
    resident.bed = own.text("bed");
    read_fields(own, resident);
    own.finish();
  }
  read_fields(map, household);
  for (const auto& [key, clock] : household_clocks) read_part(map, key, household.*clock);
  check_together(household, [&](std::string_view field, const std::string& message) {
    faults.error(map.where(std::string(field)), "household: " + std::string(field) + ": " + message);
  });
  map.finish();
  return household;
}

}  // namespace

std::optional<ScheduleSpec> read_schedule(const std::optional<YamlNode>& node, Diagnostics& faults) {
  if (!node) return std::nullopt;
  YamlMap map(*node, faults, "schedule");
  ScheduleSpec spec;
  spec.where = node->where();
  spec.first_day = map.text("first_day", spec.first_day);
  read_fields(map, spec);
  for (const YamlNode& staff : map.list("staff")) spec.staff.push_back(read_staff(staff, faults));
  if (const auto child = map.child("meetings")) {
    const std::vector<YamlNode> rooms =
        child->is_map() ? std::vector{*child} : map.list("meetings", limits::list_entries);
    for (const YamlNode& room : rooms) spec.meetings.push_back(read_meetings(room, faults));
  }
  if (const auto child = map.child("household")) {
    spec.household = read_household(*child, faults);
    if (!map.has("from")) spec.from_h = home_from_h;
    if (!map.has("to")) spec.to_h = home_to_h;
  }
  read_part(map, "arrival", spec.arrival);
  read_part(map, "departure", spec.departure);
  read_part(map, "lunch", spec.lunch);
  check_together(spec, [&](std::string_view field, const std::string& message) {
    const bool is_date = field == "first_day";
    faults.error(map.where(key_of(field)), is_date ? message : "schedule: " + message);
  });
  map.finish();
  return spec;
}

ScriptTime time_of(const ScriptSpec& script, const TrialSpec& trial, const Diagnostics& faults) {
  constexpr RunClock any{};  // where it isn't understood, so that no second fault follows
  const bool is_sound = !faults.has_errors();
  if (trial.schedule) {
    const double day_s = std::round(3600.0 * (trial.schedule->to_h - trial.schedule->from_h));
    return {is_sound ? clock_of(script, trial) : any, day_s};
  }
  if (trial.occupancy) {
    if (!is_sound) return {any};
    const OccupancyRuns runs = runs_of(*trial.occupancy, script.begin);
    return {runs.clock, has_days(*trial.occupancy) ? std::optional(runs.duration_s) : std::nullopt};
  }
  if (script.begin.empty()) return {};
  return {clock_from(script.begin).value_or(any)};
}

}  // namespace pirsim::io
