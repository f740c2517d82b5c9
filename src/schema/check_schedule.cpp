#include <numeric>

#include "schema/clock.hpp"
#include "schema/household_clocks.hpp"
#include "schema/spec_faults.hpp"

namespace pirsim {
namespace {

void check(const MeetingsSpec& meetings, const SpecPath& path, SpecFaults& faults) {
  faults.fields(meetings, path);
  faults.together(meetings, path);
  if (!faults.few(path.field("held"), meetings.held.size(), limits::held_meetings)) return;
  for (std::size_t i = 0; i < meetings.held.size(); ++i) {
    const SpecPath held = path.item("held", i);
    faults.fields(meetings.held[i], held);
    faults.together(meetings.held[i], held);
  }
  check_together(meetings.held, [&](std::size_t i, std::size_t j) {
    faults.error(path.item("held", i), "overlaps held[" + std::to_string(j) + "], and there is one room");
  });
}

}  // namespace

void check_together(const HeldMeetingSpec& held, const TellFault& tell) {
  if (held.at_h + held.duration_min / 60.0 > 24.0) tell("duration_min", "the meeting lasts beyond midnight");
}

void check_together(std::span<const HeldMeetingSpec> held, const std::function<void(std::size_t, std::size_t)>& tell) {
  const auto end_h = [&](std::size_t i) { return held[i].at_h + held[i].duration_min / 60.0; };
  for (std::size_t i = 0; i < held.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (end_h(j) > held[i].at_h && end_h(i) > held[j].at_h) tell(i, j);
    }
  }
}

void check_together(const MeetingsSpec& meetings, const TellFault& tell) {
  if (meetings.durations_min.size() != meetings.probabilities.size() || meetings.durations_min.empty()) {
    tell("probabilities", "expected one for each of durations_min");
  } else if (std::accumulate(meetings.probabilities.begin(), meetings.probabilities.end(), 0.0) <= 0.0) {
    tell("probabilities", "expected a sum above 0");
  }
  if (meetings.from_h >= meetings.to_h) tell("to_h", "`to` is not after `from`");
}

void check_together(const ScheduleSpec& schedule, const TellFault& tell) {
  try {
    static_cast<void>(day_number(schedule.first_day, {}));
  } catch (const Error& error) {
    tell("first_day", error.issues().front().message);
  }
  if (schedule.from_h >= schedule.to_h) tell("to_h", "`to` is not after `from`");
  if (schedule.departure.mean_h <= schedule.arrival.mean_h) tell("departure", "departure must be after arrival");
  const bool is_office = !schedule.staff.empty() || !schedule.meetings.empty() || schedule.cleaning_h;
  if (!is_office && !schedule.household)
    tell("staff", "nobody comes: give `staff`, `meetings`, `cleaning` or `household`");
  if (is_office && schedule.household)
    tell("household", "`household` goes without `staff`, `meetings` and `cleaning`, which are of an office");
  if (!schedule.household && schedule.to_h > 24.0) tell("to_h", "`to` is beyond 24:00");
  if (schedule.household && (schedule.from_h != home_from_h || schedule.to_h != home_to_h))
    tell("to_h", "a household's day goes from 04:00 to 04:00: leave out `from` and `to`");
}

void check_together(const HouseholdSpec& household, const TellFault& tell) {
  constexpr std::size_t most_residents = 5;
  if (household.residents.empty()) return tell("residents", "nobody lives there");
  if (household.residents.size() > most_residents) return tell("residents", "more than five");
  Names ids("resident");
  for (const ResidentSpec& resident : household.residents) {
    const std::string bad = name_fault(resident.id);
    const std::string fault = bad.empty() ? ids.fault_of_adding(resident.id) : "id '" + resident.id + "': " + bad;
    if (!fault.empty()) tell("residents", fault);
  }
  const double wakes_h = std::max(household.wakes.mean_h, household.wakes_on_free_days.mean_h);
  if (household.goes_to_bed.mean_h <= wakes_h) tell("goes_to_bed", "is not after `wakes`; up to 24:00");
  if (household.comes_home.mean_h <= household.leaves.mean_h) tell("comes_home", "is not after `leaves`");
}

void check(const HouseholdSpec& household, const SpecPath& path, SpecFaults& faults) {
  faults.fields(household, path);
  faults.together(household, path);
  for (std::size_t i = 0; i < household.residents.size(); ++i)
    faults.fields(household.residents[i], path.item("residents", i));
  for (const auto& [key, clock] : household_clocks) faults.fields(household.*clock, path.field(key));
}

void check(const ScheduleSpec& schedule, const SpecPath& path, SpecFaults& faults) {
  faults.fields(schedule, path);
  faults.together(schedule, path);
  if (!faults.few(path.field("staff"), schedule.staff.size(), limits::list_entries)) return;
  for (std::size_t i = 0; i < schedule.staff.size(); ++i) faults.fields(schedule.staff[i], path.item("staff", i));
  if (!faults.few(path.field("meetings"), schedule.meetings.size(), limits::list_entries)) return;
  for (std::size_t i = 0; i < schedule.meetings.size(); ++i)
    check(schedule.meetings[i], path.item("meetings", i), faults);
  if (schedule.household) check(*schedule.household, path.field("household"), faults);
  faults.fields(schedule.arrival, path.field("arrival"));
  faults.fields(schedule.departure, path.field("departure"));
  faults.fields(schedule.lunch, path.field("lunch"));
}

}  // namespace pirsim
