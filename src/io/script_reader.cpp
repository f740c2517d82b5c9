#include "pirsim/io.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>

#include "core/near_names.hpp"
#include "io/reader_parts.hpp"
#include "io/yaml_map.hpp"
#include "schema/body_part_names.hpp"
#include "schema/phase_names.hpp"
#include "schema/schedule_people.hpp"

namespace pirsim::io {
namespace {

using detail::BodyMeshReader;

SummarySpec read_summary(const std::optional<YamlNode>& node, Diagnostics& faults) {
  SummarySpec summary;
  if (!node) return summary;
  YamlMap map(*node, faults, "summary");
  summary.phases = map.texts("phases");
  summary.reference_file = map.text("reference");
  map.finish();
  return summary;
}

WarmthSpec read_warmth(const std::optional<YamlNode>& node, Diagnostics& faults) {
  WarmthSpec warmth;
  if (!node) return warmth;
  constexpr NumberRange surface{.min = -50.0, .max = 60.0};
  const std::vector<std::string> parts(body_part_names.begin(), body_part_names.end());
  YamlMap map(*node, faults, "warmth");
  warmth.skin_c = map.number("skin_c", warmth.skin_c, surface);
  warmth.clothing_clo = map.number("clothing_clo", warmth.clothing_clo, {.min = 0.0, .max = 10.0});
  warmth.bare = map.texts("bare", warmth.bare);
  for (const std::string& part : warmth.bare) {
    if (std::ranges::find(parts, part) != parts.end()) continue;
    faults.error(map.where("bare"), "bare: no part of the body is called '" + part + "'" + did_you_mean(part, parts));
  }
  if (const auto child = map.child("parts_c")) {
    YamlMap known(*child, faults, "parts_c");
    for (const std::string& part : parts) {
      if (const auto temperature = known.optional_number(part, surface)) warmth.parts_c[part] = *temperature;
    }
    known.finish();
  }
  map.finish();
  return warmth;
}

/// What a row's phase can be: with a schedule the use of the room, else what the first person does.
std::vector<std::string> phases_of(const ScriptSpec& script) {
  std::set<std::string> phases;
  for (const TrialSpec& trial : script.trials) {
    if (trial.schedule) {
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
      if (action.phase.empty() && std::holds_alternative<action::Work>(action.what)) phases.emplace(phase_working);
    }
  }
  return {phases.begin(), phases.end()};
}

/// Of a phase that no run has, every sum would be 0.
void check_phases(const std::optional<YamlNode>& summary, const ScriptSpec& script, Diagnostics& faults) {
  if (script.summary.phases.empty()) return;
  const std::vector<std::string> known = phases_of(script);
  for (const YamlNode& item : YamlMap(*summary, faults, "summary").list("phases")) {
    const std::string phase = item.text(faults, "summary.phases");
    if (std::ranges::find(known, phase) != known.end()) continue;
    faults.error(item.where(), "summary.phases: no run has a phase '" + phase + "'" + near_or_all(phase, known));
  }
}

constexpr double natural_speed_m_s = 1.2;  // indoors; Ref: [Weidmann1993] has 1.34 in the open

/// The choreographed style would ignore them.
void refuse_activities(const PersonSpec& person, Diagnostics& faults) {
  if (person.style == MotionStyle::natural) return;
  for (const ScriptedAction& action : person.actions) {
    const bool has_activity = std::visit(
        [](const auto& what) {
          if constexpr (requires { what.activity; }) return what.activity.has_value();
          return false;
        },
        action.what);
    if (has_activity) faults.error(action.where, "an activity needs `style: natural` of the person");
  }
}

PersonSpec read_person(const YamlNode& node, BodyMeshReader& body_meshes, Diagnostics& faults) {
  YamlMap map(node, faults, "person");
  PersonSpec person;
  person.id = map.required_text("id");
  person.stature_m = map.number("stature_m", person.stature_m, {.min = 0.8, .max = 2.3});
  person.mass_kg = map.number("mass_kg", person.mass_kg, {.min = 10.0, .max = 250.0});
  if (const auto child = map.child("seat_scatter")) {
    YamlMap scatter(*child, faults, "seat_scatter");
    person.seat_scatter.position_sd_m = scatter.number("position_sd_m", 0.0, {.min = 0.0, .max = 0.2});
    person.seat_scatter.heading_sd_deg = scatter.number("heading_sd_deg", 0.0, {.min = 0.0, .max = 30.0});
    scatter.finish();
  }
  person.body_mesh_file = map.text("body_mesh");
  person.body_meshes = body_meshes.read(person.body_mesh_file, map.where("body_mesh"), faults);
  person.style = map.choice<MotionStyle>(
      "style", person.style, {{"choreographed", MotionStyle::choreographed}, {"natural", MotionStyle::natural}});
  const double speed_m_s = person.style == MotionStyle::natural ? natural_speed_m_s : person.walking_speed_m_s;
  person.walking_speed_m_s = map.number("walking_speed_m_s", speed_m_s, {.min = 0.1, .max = 3.0});
  person.warmth = read_warmth(map.child("warmth"), faults);
  for (const YamlNode& action : map.list("actions", limits::actions))
    person.actions.push_back(read_action(action, faults));
  refuse_activities(person, faults);
  map.finish();
  return person;
}

std::vector<PersonSpec> read_people(const std::vector<YamlNode>& nodes, const Variables& variables,
                                    BodyMeshReader& body_meshes, Diagnostics& faults) {
  std::vector<PersonSpec> people;
  std::set<std::string> ids;
  for (const YamlNode& node : nodes) {
    people.push_back(read_person(node.with(variables, faults), body_meshes, faults));
    if (!ids.insert(people.back().id).second) faults.error(node.where(), "a second person '" + people.back().id + "'");
  }
  return people;
}

/// Every combination of the values of `for_each`, the last variable changing fastest.
std::vector<Variables> combinations(const std::optional<YamlNode>& for_each, Diagnostics& faults) {
  std::vector<Variables> result{{}};
  if (!for_each) return result;
  if (!for_each->is_map()) faults.error(for_each->where(), "for_each: expected variables with lists of values");
  const std::vector<YamlKey> keys = for_each->keys();
  const std::vector<YamlNode> values = for_each->items();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::vector<Variables> extended;
    if (result.size() * values[i].n_items() > limits::trials) {
      faults.error(keys[i].where, "for_each: " + too_many(limits::trials, "combinations"));
      return result;
    }
    for (const Variables& variables : result) {
      for (const YamlNode& value : values[i].items()) {
        extended.push_back(variables);
        extended.back()[keys[i].name] = value.text(faults, keys[i].name);
      }
    }
    if (extended.empty()) faults.error(values[i].where(), keys[i].name + ": expected a list of values");
    result = std::move(extended);
  }
  return result;
}

/// Trials written out one by one, each with people of its own.
std::vector<TrialSpec> read_listed_trials(const YamlNode& list, BodyMeshReader& body_meshes, Diagnostics& faults) {
  std::vector<TrialSpec> trials;
  std::set<std::string> ids;
  for (const YamlNode& item : read_list(list, faults, "trials", limits::trials)) {
    YamlMap map(item, faults, "trial");
    trials.push_back(
        {map.required_text("id"), read_people(map.list("people", limits::people), {}, body_meshes, faults)});
    trials.back().duration_s = map.optional_number("duration_s", {.min = 1.0, .max = 1e7});
    if (!ids.insert(trials.back().id).second) faults.error(item.where(), "a second trial '" + trials.back().id + "'");
    map.finish();
  }
  return trials;
}

/// Are all trials together, each with its people, small enough to be written out?
bool fit_written_out(std::size_t n_trials, const std::vector<YamlNode>& people, Diagnostics& faults) {
  std::size_t n_values = 0;
  for (const YamlNode& person : people) n_values += person.n_values();
  if (n_values * n_trials <= limits::yaml_values) return true;
  faults.error(people.front().where(), "people: " + std::to_string(n_trials) + " trials of " +
                                           std::to_string(n_values) + " values each are " +
                                           too_many(limits::yaml_values, "values"));
  return false;
}

/// One trial for every combination of variables, all with the same people.
std::vector<TrialSpec> read_trials(const std::optional<YamlNode>& node, const std::vector<YamlNode>& people,
                                   BodyMeshReader& body_meshes, Diagnostics& faults) {
  if (!node) return {{"1", read_people(people, {}, body_meshes, faults)}};
  if (node->is_list()) {
    if (!people.empty())
      faults.error(people.front().where(), "`people` belongs inside each listed trial, not beside `trials`");
    return read_listed_trials(*node, body_meshes, faults);
  }
  YamlMap map(*node, faults, "trials");
  std::vector<TrialSpec> trials;
  std::set<std::string> ids;
  const auto all = combinations(map.child("for_each"), faults);
  const std::string pattern = map.required_text("id");
  map.finish();
  if (!fit_written_out(all.size(), people, faults)) return {};
  Diagnostics found;  // trials share their text: what is wrong in one is wrong in all, and said once
  for (const Variables& variables : all) {
    TrialSpec& trial = trials.emplace_back();
    trial.id = substitute(pattern, variables, map.where("id"), found);
    if (trial.id.empty() && !pattern.empty())
      found.error(map.where("id"), "trials: id: expected a text that isn't empty");
    trial.people = read_people(people, variables, body_meshes, found);
    if (!ids.insert(trial.id).second && !pattern.empty() && !found.has_errors())
      found.error(map.where("id"), "a second trial '" + trial.id + "'");
  }
  std::set<std::string> told;
  for (const Issue& issue : found.issues()) {
    if (!told.insert(to_string(issue)).second) continue;
    issue.severity == Severity::error ? faults.error(issue.where, issue.message)
                                      : faults.warning(issue.where, issue.message);
  }
  return trials;
}

void warn_of_days_off(const YamlNode& node, const ScheduleSpec& schedule, int n_days, Diagnostics& faults) {
  if (faults.has_errors()) return;
  const std::int64_t first = day_number(schedule.first_day, schedule.where);
  for (std::int64_t day = first; day < first + std::min(n_days, 7); ++day) {
    if (is_working_day(day)) return;
  }
  faults.warning(
      YamlMap(node, faults, "schedule").where("first_day"),
      "schedule: nobody comes on Saturdays and Sundays, and there is no other day from " + schedule.first_day + " on");
}

ScriptSpec script_of(const YamlNode& root, const std::filesystem::path& file) {
  Diagnostics faults;
  YamlMap map(root, faults, "script");
  check_version(map, "pirsim_script");
  ScriptSpec script;
  script.name = map.text("name", file.stem().string());
  const bool is_stream = file == "/dev/stdin";  // its own folder has nothing that a script could mean
  script.directory = is_stream ? std::string() : file.parent_path().string();
  script.seed = map.unsigned_integer("seed", script.seed);
  script.replicates = map.integer("replicates", script.replicates, {.min = 1, .max = 10000000});
  script.sensing = read_sensing(map.child("sensing"), faults);
  script.summary = read_summary(map.child("summary"), faults);
  BodyMeshReader body_meshes(file.parent_path());
  script.trials = read_trials(map.child("trials"), map.list("people", limits::people), body_meshes, faults);
  if (const auto duration_s = map.optional_number("duration_s", {.min = 1.0, .max = 1e7})) {
    for (TrialSpec& trial : script.trials) trial.duration_s = trial.duration_s.value_or(*duration_s);
  }
  if (const auto schedule = read_schedule(map.child("schedule"), faults)) {
    warn_of_days_off(*map.child("schedule"), *schedule, script.replicates, faults);
    for (TrialSpec& trial : script.trials) {
      if (trial.duration_s) {
        faults.error(schedule->where, "schedule: a run lasts from its `from` to its `to`: leave out duration_s");
      }
      trial.schedule = schedule;
    }
  }
  if (!faults.has_errors()) check_phases(map.child("summary"), script, faults);
  script.effects = read_effects(map.list("effects"), faults);
  if (script.trials.size() * static_cast<std::size_t>(script.replicates) > std::numeric_limits<std::uint32_t>::max()) {
    faults.error(map.where("replicates"), "trials times replicates are more than " +
                                              std::to_string(std::numeric_limits<std::uint32_t>::max()) + " runs");
  }
  map.finish();
  faults.throw_if_errors();
  script.files = body_meshes.files();
  script.warnings = faults.warnings();
  return script;
}

}  // namespace

ScriptSpec read_script(const std::filesystem::path& file, std::span<const std::string> overrides) {
  ScriptSpec script = script_of(YamlNode::load(file, overrides), file);
  script.files.insert(script.files.begin(), file.string());
  return script;
}

ScriptSpec parse_script(std::string_view text, const std::string& name, std::span<const std::string> overrides) {
  return script_of(YamlNode::parse(text, name, overrides), name);
}

void check(const ScriptSpec& script) {
  ScriptSpec values = script;
  for (TrialSpec& trial : values.trials) {
    for (PersonSpec& person : trial.people) person.body_mesh_file.clear();  // whose meshes have been read
  }
  try {
    (void)parse_script(to_yaml(values), script.name);
  } catch (const Error& error) {
    std::vector<Issue> issues = error.issues();
    for (Issue& issue : issues) issue.where = {script.name, 0, 0};  // nobody has the text
    throw Error(error.code(), std::move(issues));
  }
}

}  // namespace pirsim::io
