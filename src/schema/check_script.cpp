#include "pirsim/script.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "core/text.hpp"
#include "geom/triangle_surface.hpp"
#include "schema/action_facts.hpp"
#include "schema/body_part_names.hpp"
#include "schema/clock.hpp"
#include "schema/occupancy_runs.hpp"
#include "schema/phase_names.hpp"
#include "schema/spec_faults.hpp"

namespace pirsim {
namespace {

/// What a row's phase can be: with a schedule the use of the room, else what the first person does.
std::vector<std::string> phases_of(const ScriptSpec& script) {
  std::set<std::string> phases;
  for (const TrialSpec& trial : script.trials) {
    if (trial.schedule || trial.occupancy) {
      for (const std::string_view use : {phase_empty, phase_occupied, phase_meeting, phase_cleaning})
        phases.emplace(use);
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

}  // namespace

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

}  // namespace pirsim
