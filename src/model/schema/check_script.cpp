#include "model/schema/check_script.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "model/core/text.hpp"
#include "model/geom/shapes.hpp"
#include "model/schema/actions.hpp"
#include "model/schema/check_scene.hpp"
#include "model/schema/checks.hpp"
#include "model/schema/clock.hpp"
#include "model/schema/words.hpp"
#include "pirsim/script.hpp"

namespace pirsim {
namespace {

constexpr double seconds_a_day = 86400.0;

/// Moments of the data at which something is known, ascending where days are looked for.
std::vector<double> moments_of(const OccupancySpec& occupancy) {
  if (occupancy.counts) return occupancy.counts->times_s;
  std::vector<double> moments;
  if (occupancy.places) {
    for (const StaySpec& stay : occupancy.places->stays) moments.insert(moments.end(), {stay.from_s, stay.to_s});
  }
  if (occupancy.positions) {
    for (const TrackSpec& track : occupancy.positions->tracks)
      moments.insert(moments.end(), track.times_s.begin(), track.times_s.end());
  }
  std::ranges::sort(moments);
  return moments;
}

/// What a row's phase can be: with a schedule the use of the room, else what the first person does.
std::vector<std::string> phases_of(const ScriptSpec& script) {
  std::set<std::string> phases;
  for (const TrialSpec& trial : script.trials) {
    if (trial.schedule || trial.occupancy) {
      for (const std::string_view use : {phase_empty, phase_occupied, phase_meeting, phase_cleaning})
        phases.emplace(use);
      if (trial.schedule && trial.schedule->household) phases.emplace(phase_asleep);
      continue;
    }
    phases.emplace(phase_outside);
    phases.insert(phases_of_body.begin(), phases_of_body.end());
    // Whoever an effect adds to nobody is the first.
    if (trial.people.empty()) phases.emplace(phase_working);
    for (std::size_t i = 0; !trial.people.empty() && i < trial.people.front().actions.size(); ++i) {
      const ScriptedAction& action = trial.people.front().actions[i];
      if (!action.phase.empty()) phases.insert(action.phase);
      if (action.phase.empty() && facts_of(action.what).desk_work != nullptr) phases.emplace(phase_working);
    }
  }
  return {phases.begin(), phases.end()};
}

std::string names_of(std::span<const Activity> activities) {
  std::string text;
  for (const Activity one : activities)
    text += (text.empty() ? "" : ", ") + std::string(activity_names[static_cast<std::size_t>(one)]);
  return text;
}

class ScriptCheck {
 public:
  ScriptCheck(const ScriptSpec& script, Diagnostics& diagnostics)
      : script_(script), faults_(script.name, diagnostics) {}

  void run() {
    const SpecPath path("script");
    faults_.fields(script_, path);
    faults_.error_if(path.field("name"), line_fault(script_.name));
    check_sensing(path.field("sensing"));
    if (!faults_.few(path.field("trials"), script_.trials.size(), limits::trials)) return;
    if (!faults_.few(path.field("effects"), script_.effects.size(), limits::list_entries)) return;
    Names ids("trial");
    for (std::size_t i = 0; i < script_.trials.size(); ++i) check_trial(script_.trials[i], path.item("trials", i), ids);
    const SpecPath summary = path.field("summary");
    check_phases(script_, [&](std::size_t phase, const std::string& message) {
      faults_.error(summary.item("phases", phase), message);
    });
    faults_.together(script_, path);
  }

 private:
  void check_sensing(const SpecPath& path) {
    const SensingSpec& sensing = script_.sensing;
    faults_.fields(sensing, path);
    const auto longest_s = static_cast<long long>(accepted::window_s.max);
    const IntegerRange window{.min = 1, .max = longest_s * std::max(1, sensing.tick_rate_hz)};
    if (window.holds(sensing.ticks_per_window)) return;
    faults_.error(path.field("ticks_per_window"),
                  "expected " + window.text() + ", got " + std::to_string(sensing.ticks_per_window));
  }

  void check_id(const std::string& id, const SpecPath& path, Names& ids) {
    if (id.empty()) faults_.error(path.field("id"), "expected a text that isn't empty");
    faults_.error_if(path.field("id"), line_fault(id));
    faults_.error_if(path.field("id"), ids.fault_of_adding(id));
  }

  void check_trial(const TrialSpec& trial, const SpecPath& path, Names& ids) {
    check_id(trial.id, path, ids);
    faults_.fields(trial, path);
    faults_.together(trial, path);
    if (!faults_.few(path.field("people"), trial.people.size(), limits::people)) return;
    Names people("person");
    for (std::size_t i = 0; i < trial.people.size(); ++i) check_person(trial.people[i], path.item("people", i), people);
    if (!faults_.few(path.field("pets"), trial.pets.size(), limits::list_entries)) return;
    for (std::size_t i = 0; i < trial.pets.size(); ++i) {
      check_id(trial.pets[i].id, path.item("pets", i), people);
      faults_.fields(trial.pets[i], path.item("pets", i));
    }
    if (trial.schedule) check(*trial.schedule, path.field("schedule"), faults_);
    if (trial.occupancy) check(*trial.occupancy, script_.begin, path.field("occupancy"), faults_);
  }

  void check_person(const PersonSpec& person, const SpecPath& path, Names& ids) {
    check_id(person.id, path, ids);
    faults_.fields(person, path);
    faults_.fields(person.seat_scatter, path.field("seat_scatter"));
    const SpecPath warmth = path.field("warmth");
    faults_.fields(person.warmth, warmth);
    faults_.together(person.warmth, warmth);
    if (!person.body_mesh_file.empty() && person.body_meshes.empty()) {
      faults_.error(path.field("body_mesh_file"), "its meshes weren't read, as read_script() reads them");
    }
    for (const auto& [part, solid] : person.body_meshes) {
      faults_.error_if(path.field("body_meshes"), body_part_fault(part));
      faults_.error_if(path.field("body_meshes"), body_mesh_fault(solid.surface->mesh()));
    }
    if (!faults_.few(path.field("actions"), person.actions.size(), limits::actions)) return;
    for (std::size_t i = 0; i < person.actions.size(); ++i)
      check_action(person, person.actions[i], path.item("actions", i));
  }

  void check_action(const PersonSpec& person, const ScriptedAction& action, const SpecPath& path) {
    faults_.error_if(path.field("phase"), line_fault(action.phase));
    faults_.fields(action, path);
    faults_.error_if(path.field("activity"), activity_fault(person, action));
    std::visit([&](const auto& what) { faults_.fields(what, path); }, action.what);
    if (const auto* appear = std::get_if<action::Appear>(&action.what)) check_point(appear->point, path.field("point"));
    if (const auto* follow = std::get_if<action::Follow>(&action.what)) check_follow(*follow, path);
    const auto* walk = std::get_if<action::Walk>(&action.what);
    if (walk == nullptr) return;
    if (walk->points.empty()) faults_.error(path.field("points"), "expected a list that isn't empty");
    if (!faults_.few(path.field("points"), walk->points.size(), limits::walk_points)) return;
    for (std::size_t i = 0; i < walk->points.size(); ++i) check_point(walk->points[i], path.item("points", i));
  }

  void check_follow(const action::Follow& follow, const SpecPath& path) {
    faults_.error_if(path.field("points"), follow_fault(follow.times_s, follow.points, follow.headings_deg));
    if (!faults_.few(path.field("points"), follow.points.size(), limits::walk_points)) return;
    for (std::size_t i = 0; i < follow.points.size(); ++i) check_point(follow.points[i], path.item("points", i));
  }

  void check_point(const Vec2& point, const SpecPath& path) {
    faults_.number(path, point.x, accepted::on_floor_m);
    faults_.number(path, point.y, accepted::on_floor_m);
  }

  const ScriptSpec& script_;
  SpecFaults faults_;
};

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

bool are_as_many(const CountsSpec& counts, std::size_t k) {
  return counts.people[k] == counts.people[k - 1] &&
         std::ranges::all_of(counts.areas, [k](const auto& area) { return area.people[k] == area.people[k - 1]; });
}

std::optional<DataSpan> data_span(const OccupancySpec& occupancy) {
  const std::vector<double> moments = moments_of(occupancy);
  if (moments.empty()) return std::nullopt;
  return DataSpan{moments.front(), moments.back()};
}

const std::string& data_begin(const OccupancySpec& occupancy) noexcept {
  static const std::string none;
  return occupancy.counts      ? occupancy.counts->begin
         : occupancy.places    ? occupancy.places->begin
         : occupancy.positions ? occupancy.positions->begin
                               : none;
}

const std::string& data_file(const OccupancySpec& occupancy) noexcept {
  static const std::string none;
  return occupancy.counts      ? occupancy.counts->file
         : occupancy.places    ? occupancy.places->file
         : occupancy.positions ? occupancy.positions->file
                               : none;
}
std::string& data_file(OccupancySpec& occupancy) noexcept {
  return const_cast<std::string&>(data_file(std::as_const(occupancy)));
}

OccupancyRuns runs_of(const OccupancySpec& occupancy, const std::string& begin) {
  const std::optional<RunClock> own = clock_from(data_begin(occupancy)), given = clock_from(begin);
  const std::optional<RunClock> data = own ? own : given;
  const DataSpan span = data_span(occupancy).value_or(DataSpan{});
  if (!has_days(occupancy)) {
    // Seconds of the run begin with it; a clock's moments where the script says, or with the first of them.
    const double from_s = own && given ? static_cast<double>(given->begin_s - own->begin_s) : own ? span.first_s : 0.0;
    std::optional<RunClock> clock = data;
    if (clock) clock->begin_s += std::llround(from_s);
    return {clock, span.last_s - from_s, {from_s}};
  }
  const double from_s = 3600.0 * occupancy.from_h.value_or(0.0), to_s = 3600.0 * occupancy.to_h.value_or(24.0);
  OccupancyRuns runs{data, std::round(to_s - from_s), {}};
  const double midnight_s = data->begin_second();  // before second 0 of the data
  double last_day = -1.0;
  for (const double moment_s : moments_of(occupancy)) {
    const double day = std::floor((moment_s + midnight_s) / seconds_a_day);
    const double in_day_s = moment_s + midnight_s - day * seconds_a_day;
    if (day == last_day || in_day_s < from_s || in_day_s > to_s) continue;
    runs.begins_s.push_back(day * seconds_a_day - midnight_s + from_s);
    last_day = day;
  }
  if (!runs.begins_s.empty()) runs.clock->begin_s += std::llround(runs.begins_s.front());
  return runs;
}

std::vector<std::string> seats_of(const OccupancySpec& occupancy, const SceneSpec& scene) {
  return occupancy.seats.empty() ? ids_of(scene.seats) : occupancy.seats;
}
std::vector<std::string> entrances_of(const OccupancySpec& occupancy, const SceneSpec& scene) {
  return occupancy.entrances.empty() ? ids_of(scene.entrances) : occupancy.entrances;
}

std::string activity_fault(const PersonSpec& person, const ScriptedAction& action) {
  return std::visit(
      [&](const auto& what) -> std::string {
        if constexpr (requires { what.activity; }) {
          if (!what.activity) return {};
          if (person.style != MotionStyle::natural) return "an activity needs `style: natural` of the person";
          const auto known = facts_of(what).may_be_asked;
          if (std::ranges::find(known, *what.activity) == known.end()) return "expected one of " + names_of(known);
        }
        return {};
      },
      action.what);
}

std::string body_part_fault(const std::string& part) {
  const std::vector<std::string> parts(body_part_names.begin(), body_part_names.end());
  if (std::ranges::find(parts, part) != parts.end()) return {};
  return "no part of the body is called '" + part + "'" + near_or_all(part, parts);
}

std::string body_mesh_fault(const TriMesh& mesh) {
  constexpr double farthest_m = 3.0;  // assumed; 2.5 to 10 would do: nobody's part is longer, one in millimetres is
  const auto is_near = [](const Vec3& p) { return glm::length(p) <= farthest_m; };
  if (std::ranges::all_of(mesh.positions, is_near)) return {};
  return "its mesh reaches more than 3 m from the part's origin; metres are expected, in the part's frame";
}

void check_together(const WarmthSpec& warmth, const TellFault& tell) {
  const auto tell_if = [&](std::string_view field, const std::string& fault) {
    if (!fault.empty()) tell(field, fault);
  };
  for (const std::string& part : warmth.bare) tell_if("bare", body_part_fault(part));
  for (const auto& [part, temperature_c] : warmth.parts_c) {
    tell_if("parts_c", body_part_fault(part));
    if (!accepted::skin_c.holds(temperature_c)) tell("parts_c", part + ": expected " + accepted::skin_c.text());
  }
}

void check_together(const TrialSpec& trial, const TellFault& tell) {
  if (trial.schedule && trial.duration_s) {
    tell("duration_s", "a run lasts from its `from` to its `to`: leave out duration_s");
  }
  if (trial.occupancy && has_days(*trial.occupancy) && trial.duration_s)
    tell("duration_s", "a run lasts from `from` to `to` of its occupancy: leave out duration_s");
  if (trial.schedule && trial.occupancy)
    tell("occupancy", "a schedule says who is there as well: leave out one of them");
}

void check_phases(const ScriptSpec& script, const std::function<void(std::size_t, const std::string&)>& tell) {
  if (script.summary.phases.empty()) return;
  const std::vector<std::string> known = phases_of(script);
  for (std::size_t i = 0; i < script.summary.phases.size(); ++i) {
    const std::string& phase = script.summary.phases[i];
    if (std::ranges::find(known, phase) != known.end()) continue;
    tell(i, "no run has a phase '" + phase + "'" + near_or_all(phase, known));
  }
}

void check_together(const ScriptSpec& script, const TellFault& tell) {
  const auto has_schedule = [](const TrialSpec& trial) { return trial.schedule.has_value(); };
  if (!script.begin.empty() && !clock_from(script.begin)) {
    tell("begin", "expected the date and time at which runs begin, e.g. 2026-03-02T07:00, got '" + script.begin + "'");
  } else if (!script.begin.empty() && std::ranges::any_of(script.trials, has_schedule)) {
    tell("begin", "a schedule's `first_day` and `from` say when its runs begin: leave out `begin`");
  }
  constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  if (script.replicates < 0 || script.trials.size() * static_cast<std::size_t>(script.replicates) <= most) return;
  tell("replicates", "trials times replicates are more than " + std::to_string(most) + " runs");
}

void check(const ScriptSpec& script, Diagnostics& diagnostics) { ScriptCheck(script, diagnostics).run(); }

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
