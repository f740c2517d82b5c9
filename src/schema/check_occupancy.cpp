#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "schema/check_specs.hpp"
#include "schema/clock.hpp"
#include "schema/occupancy_runs.hpp"
#include "schema/spec_faults.hpp"

namespace pirsim {
namespace {

bool ascend(const std::vector<double>& times_s) {
  constexpr double farthest_s = 1e10;  // 300 years
  return std::ranges::all_of(times_s, [](double t) { return std::abs(t) <= farthest_s; }) &&
         std::ranges::adjacent_find(times_s, std::greater_equal()) == times_s.end();
}

void check_begin(const std::string& begin, const std::string& field, const TellFault& tell) {
  if (begin.empty() || clock_from(begin)) return;
  tell(field, "expected the date and time of second 0, e.g. 2026-03-02T07:00, got '" + begin + "'");
}

void check_areas(const CountsSpec& counts, const TellFault& tell) {
  std::vector<int> sum(counts.people.size(), 0);
  for (auto area = counts.areas.begin(); area != counts.areas.end(); ++area) {
    if (std::find_if(counts.areas.begin(), area, [&](const auto& other) { return other.area == area->area; }) != area)
      return tell("areas", "'" + area->area + "' appears twice");
    if (area->people.size() != sum.size())
      return tell("areas", "'" + area->area + "': expected as many numbers as times");
    if (std::ranges::any_of(area->people, [](int people) { return people < 0; }))
      return tell("areas", "'" + area->area + "': a number of people is below 0");
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += area->people[i];
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (sum[i] <= counts.people[i]) continue;
    return tell("areas", std::to_string(sum[i]) + " people are in areas at reading " + std::to_string(i + 1) +
                             ", but only " + std::to_string(counts.people[i]) + " in all");
  }
}

void check_counts(const CountsSpec& counts, const std::optional<int>& persons, const TellFault& tell) {
  check_begin(counts.begin, "counts", tell);
  if (counts.times_s.empty()) return tell("counts", "expected at least one reading");
  if (counts.times_s.size() != counts.people.size()) return tell("counts", "expected as many numbers as times");
  if (counts.times_s.size() > limits::occupancy_rows)
    return tell("counts", "more than " + std::to_string(limits::occupancy_rows) + " readings");
  if (!ascend(counts.times_s)) tell("counts", "expected times that ascend");
  const auto [fewest, most] = std::ranges::minmax(counts.people);
  if (fewest < 0) tell("counts", "a number of people is below 0");
  const auto allowed = static_cast<int>(accepted::people_of_counts.max);
  if (most > allowed) tell("counts", "more than " + std::to_string(allowed) + " people");
  check_areas(counts, tell);
  if (persons && *persons < most) {
    tell("persons",
         std::to_string(*persons) + " different people, but up to " + std::to_string(most) + " are there at once");
  }
}

void check_places(const PlacesSpec& places, const TellFault& tell) {
  check_begin(places.begin, "places", tell);
  if (places.stays.empty()) return tell("places", "expected at least one stay");
  if (places.stays.size() > limits::occupancy_rows)
    return tell("places", "more than " + std::to_string(limits::occupancy_rows) + " stays");
  const bool forward = std::ranges::all_of(places.stays, [](const StaySpec& stay) { return stay.from_s <= stay.to_s; });
  if (!forward) return tell("places", "a stay ends before it begins");
  std::map<std::string, std::vector<const StaySpec*>> by_person;
  for (const StaySpec& stay : places.stays) by_person[stay.person].push_back(&stay);
  for (auto& [person, stays] : by_person) {
    std::ranges::stable_sort(stays, {}, &StaySpec::from_s);
    constexpr double rounding_s = 1e-6;
    const auto overlap = std::ranges::adjacent_find(
        stays, [](const auto* one, const auto* next) { return one->to_s > next->from_s + rounding_s; });
    if (overlap == stays.end()) continue;
    return tell("places", "'" + person + "' is in two places at once, from second " +
                              shortest_number((*std::next(overlap))->from_s) + " on");
  }
}

void check_positions(const PositionsSpec& positions, const TellFault& tell) {
  check_begin(positions.begin, "positions", tell);
  if (positions.tracks.empty()) return tell("positions", "expected at least one track");
  for (const TrackSpec& track : positions.tracks) {
    const std::string fault = follow_fault(track.times_s, track.points, track.headings_deg);
    if (!fault.empty()) return tell("positions", "'" + track.person + "': " + fault);
    if (track.times_s.size() > limits::walk_points)
      return tell("positions", "'" + track.person + "': more than " + std::to_string(limits::walk_points) + " points");
  }
}

/// Do its data make runs?
void check_runs(const OccupancySpec& occupancy, const std::string& begin, const TellFault& tell) {
  const bool has_own_clock = clock_from(data_begin(occupancy)).has_value();
  if (has_days(occupancy) && !has_own_clock && !clock_from(begin)) {
    return tell("from_h",
                "`from` and `to` are times of day, and the data have seconds alone: add `begin`, the date and time at "
                "which they begin");
  }
  if (has_days(occupancy) && has_own_clock && !begin.empty()) {
    return tell("from_h", "`from` and `to` and the data's own clock say when runs begin: leave out `begin`");
  }
  const OccupancyRuns runs = runs_of(occupancy, begin);
  if (runs.begins_s.empty()) return tell("from_h", "the data have no reading between `from` and `to` of any day");
  if (runs.duration_s <= 0.0) {
    return tell("counts", "the data end at " + moment_text(runs.clock, runs.duration_s) + ", and the run begins at " +
                              moment_text(runs.clock, 0.0));
  }
  if (runs.duration_s > accepted::at_s.max) {
    tell("counts", "the data last for " + std::to_string(static_cast<long long>(runs.duration_s / 86400.0)) +
                       " days, and a run at most 115: give `from` and `to`, times of day, and each replicate is a day");
  }
}

}  // namespace

std::string follow_fault(const std::vector<double>& times_s, const std::vector<Vec2>& points,
                         const std::vector<double>& headings_deg) {
  const std::size_t n = times_s.size();
  if (n == 0) return "expected a list that isn't empty";
  if (points.size() != n || (!headings_deg.empty() && headings_deg.size() != n))
    return "expected as many points (and headings, if there are any) as times";
  if (!ascend(times_s) || times_s.front() < 0.0) return "expected times from 0 on that ascend";
  const bool finite = std::ranges::all_of(headings_deg, [](double heading) { return std::isfinite(heading); });
  return finite ? "" : "a heading isn't finite";
}

void check_together(const OccupancySpec& occupancy, const std::string& begin, const TellFault& tell) {
  bool is_sound = true;
  const TellFault tell_and_note = [&](std::string_view field, const std::string& message) {
    is_sound = false;
    tell(field, message);
  };
  const int n = (occupancy.counts ? 1 : 0) + (occupancy.places ? 1 : 0) + (occupancy.positions ? 1 : 0);
  if (n != 1) return tell("counts", "expected one of `counts`, `places` and `positions`");
  if (!occupancy.counts &&
      (has_days(occupancy) || occupancy.persons || occupancy.changes_within_s || !occupancy.seats.empty())) {
    tell_and_note("counts", "`from`, `to`, `persons`, `changes_within_s` and `seats` go with `counts` alone");
  }
  if (occupancy.counts) check_counts(*occupancy.counts, occupancy.persons, tell_and_note);
  if (occupancy.places) check_places(*occupancy.places, tell_and_note);
  if (occupancy.positions) check_positions(*occupancy.positions, tell_and_note);
  if (occupancy.from_h.value_or(0.0) >= occupancy.to_h.value_or(24.0))
    tell_and_note("to_h", "`to` is not after `from`");
  if (is_sound) check_runs(occupancy, begin, tell);
}

void check(const OccupancySpec& occupancy, const std::string& begin, const SpecPath& path, SpecFaults& faults) {
  faults.fields(occupancy, path);
  check_together(occupancy, begin,
                 [&](std::string_view field, const std::string& message) { faults.error(path.field(field), message); });
}

}  // namespace pirsim
