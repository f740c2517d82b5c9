#include "pirsim/io.hpp"

#include <algorithm>
#include <cstdint>
#include <set>

#include "io/read/reader_parts.hpp"
#include "io/read/yaml_map.hpp"
#include "schema/body_part_names.hpp"
#include "schema/clock.hpp"

namespace pirsim::io {
namespace {

using detail::BodyMeshReader;

SummarySpec read_summary(YamlMap& script) {
  SummarySpec summary;
  read_part(script, "summary", summary, [&](YamlMap& map) {
    summary.reference_file = map.text("reference");
    summary.where = map.where("reference");
  });
  return summary;
}

WarmthSpec read_warmth(YamlMap& person) {
  WarmthSpec warmth;
  read_part(person, "warmth", warmth, [&](YamlMap& map) {
    if (const auto child = map.child("parts_c")) {
      YamlMap known(*child, map.faults(), "parts_c");
      for (const std::string_view part : body_part_names) {
        const std::string name(part);
        if (const auto temperature = known.optional_number(name, accepted::skin_c)) warmth.parts_c[name] = *temperature;
      }
      known.finish();
    }
    check_together(warmth, faults_by_key(map));
  });
  return warmth;
}

constexpr double natural_speed_m_s = 1.2;  // indoors; Ref: [Weidmann1993] has 1.34 in the open

/// What a person's text refers to.
struct Surroundings {
  BodyMeshReader body_meshes;
  ScriptTime time;
};

PersonSpec read_person(const YamlNode& node, Surroundings& around, Diagnostics& faults) {
  YamlMap map(node, faults, "person");
  PersonSpec person;
  person.id = map.required_text("id");
  read_part(map, "seat_scatter", person.seat_scatter);
  person.body_mesh_file = map.text("body_mesh");
  person.body_meshes = around.body_meshes.read(person.body_mesh_file, map.where("body_mesh"), faults);
  read_fields(map, person);
  const bool has_own_speed = map.has("walking_speed_m_s");
  if (person.style == MotionStyle::natural && !has_own_speed) person.walking_speed_m_s = natural_speed_m_s;
  person.warmth = read_warmth(map);
  for (const YamlNode& action : map.list("actions", limits::actions))
    person.actions.push_back(read_action(action, around.time, faults));
  for (const ScriptedAction& action : person.actions) {
    const std::string fault = activity_fault(person, action);
    if (!fault.empty()) faults.error(action.where, fault);
  }
  map.finish();
  return person;
}

std::vector<PersonSpec> read_people(const std::vector<YamlNode>& nodes, const Variables& variables,
                                    Surroundings& around, Diagnostics& faults) {
  std::vector<PersonSpec> people;
  Names ids("person");
  for (const YamlNode& node : nodes) {
    people.push_back(read_person(node.with(variables, faults), around, faults));
    const std::string fault = ids.fault_of_adding(people.back().id);
    if (!fault.empty()) faults.error(node.where(), fault);
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
std::vector<TrialSpec> read_listed_trials(const YamlNode& list, Surroundings& around, Diagnostics& faults) {
  std::vector<TrialSpec> trials;
  Names ids("trial");
  for (const YamlNode& item : read_list(list, faults, "trials", limits::trials)) {
    YamlMap map(item, faults, "trial");
    trials.push_back({map.required_text("id"), read_people(map.list("people", limits::people), {}, around, faults)});
    read_numbers(map, trials.back());
    const std::string fault = ids.fault_of_adding(trials.back().id);
    if (!fault.empty()) faults.error(item.where(), fault);
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
                                   Surroundings& around, Diagnostics& faults) {
  if (!node) return {{"1", read_people(people, {}, around, faults)}};
  if (node->is_list()) {
    if (!people.empty())
      faults.error(people.front().where(), "`people` belongs inside each listed trial, not beside `trials`");
    return read_listed_trials(*node, around, faults);
  }
  YamlMap map(*node, faults, "trials");
  std::vector<TrialSpec> trials;
  Names ids("trial");
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
    trial.people = read_people(people, variables, around, found);
    const std::string fault = ids.fault_of_adding(trial.id);
    if (!fault.empty() && !pattern.empty() && !found.has_errors()) found.error(map.where("id"), fault);
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
  if (faults.has_errors() || schedule.household) return;
  const std::int64_t first = day_number(schedule.first_day, schedule.where);
  for (std::int64_t day = first; day < first + std::min(n_days, 7); ++day) {
    if (is_working_day(day)) return;
  }
  faults.warning(
      YamlMap(node, faults, "schedule").where("first_day"),
      "schedule: nobody comes on Saturdays and Sundays, and there is no other day from " + schedule.first_day + " on");
}

/// Actions after the end of a run that lasts for a given time.
void warn_of_what_never_begins(const ScriptSpec& script, const ScriptTime& time, Diagnostics& faults) {
  for (const TrialSpec& trial : script.trials) {
    const auto end_s = time.day_s ? time.day_s : trial.duration_s;
    for (const PersonSpec& person : trial.people) {
      for (const ScriptedAction& action : person.actions) {
        if (!end_s || !action.at_s || *action.at_s < *end_s) continue;
        faults.warning(action.where, "'" + person.id + "' is to begin this at " +
                                         moment_text(time.clock, *action.at_s) + ", but the run ends at " +
                                         moment_text(time.clock, *end_s) + ": it never happens");
      }
    }
  }
}

/// The schedule or occupancy that stands beside the trials.
void add_people_of_all(const TrialSpec& every_trial, std::vector<TrialSpec>& trials, Diagnostics& faults) {
  if (!every_trial.schedule && !every_trial.occupancy) return;
  const bool is_schedule = every_trial.schedule.has_value();
  const Where& where = is_schedule ? every_trial.schedule->where : every_trial.occupancy->where;
  if (const auto& occupancy = every_trial.occupancy;
      occupancy && occupancy->counts && trials.size() * occupancy->counts->times_s.size() > limits::measured_rows) {
    return faults.error(where, "occupancy: " + std::to_string(trials.size()) + " trials of " +
                                   std::to_string(occupancy->counts->times_s.size()) + " readings each are " +
                                   too_many(limits::measured_rows, "readings"));
  }
  for (TrialSpec& trial : trials) {
    trial.schedule = every_trial.schedule;
    trial.occupancy = every_trial.occupancy;
    check_together(trial, [&](std::string_view, const std::string& message) {
      faults.error(where, (is_schedule ? "schedule: " : "occupancy: ") + message);
    });
  }
}

/// name: of the script, if it doesn't say; files: those that it may name.
ScriptSpec script_of(const YamlNode& root, const std::string& name, const detail::FilesBeside& files) {
  Diagnostics faults;
  YamlMap map(root, faults, "script");
  check_version(map, "pirsim_script");
  ScriptSpec script;
  script.name = map.text("name", name);
  script.directory = files.folder.string();
  read_numbers(map, script);
  script.sensing = read_sensing(map.child("sensing"), faults);
  script.summary = read_summary(map);
  script.begin = map.text("begin");
  TrialSpec every_trial;
  every_trial.schedule = read_schedule(map.child("schedule"), faults);
  detail::OccupancyReader occupancy(files);
  every_trial.occupancy = occupancy.read(map.child("occupancy"), script.begin, faults);
  Surroundings around{BodyMeshReader(files), time_of(script, every_trial, faults)};
  script.trials = read_trials(map.child("trials"), map.list("people", limits::people), around, faults);
  read_numbers(map, every_trial);
  for (TrialSpec& trial : script.trials) {
    if (!trial.duration_s) trial.duration_s = every_trial.duration_s;
  }
  const auto& schedule = every_trial.schedule;
  if (schedule) warn_of_days_off(*map.child("schedule"), *schedule, script.replicates, faults);
  add_people_of_all(every_trial, script.trials, faults);
  warn_of_what_never_begins(script, around.time, faults);
  if (!faults.has_errors() && map.has("summary")) {
    const std::vector<YamlNode> phases = YamlMap(*map.child("summary"), faults, "summary").list("phases");
    check_phases(script, [&](std::size_t phase, const std::string& message) {
      faults.error(phases[phase].where(), "summary.phases: " + message);
    });
  }
  script.effects = read_effects(map.list("effects"), faults);
  check_together(script, [&](std::string_view field, const std::string& message) {
    faults.error(map.where(std::string(field)), std::string(field) + ": " + message);
  });
  map.finish();
  faults.throw_if_errors();
  script.files = around.body_meshes.files();
  script.files.insert(script.files.end(), occupancy.files().begin(), occupancy.files().end());
  script.warnings = faults.warnings();
  return script;
}

}  // namespace

ScriptSpec read_script(const std::filesystem::path& file, std::span<const std::string> overrides,
                       std::span<const std::filesystem::path> data_directories) {
  const Input input = read_input(file);
  ScriptSpec script =
      script_of(YamlNode::load(input, overrides), stem_of_input(file), {folder_of_input(file), data_directories});
  script.files.insert(script.files.begin(), input.file());
  return script;
}

ScriptSpec parse_script(std::string_view text, const std::string& name, std::span<const std::string> overrides,
                        std::span<const std::filesystem::path> data_directories) {
  return script_of(YamlNode::parse(text, name, overrides), stem_of_input(name),
                   {folder_of_input(name), data_directories});
}

}  // namespace pirsim::io
