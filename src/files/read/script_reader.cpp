#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "files/disk/file.hpp"
#include "files/read/gltf_document.hpp"
#include "files/read/reader_parts.hpp"
#include "files/read/yaml.hpp"
#include "model/schema/actions.hpp"
#include "model/schema/check_script.hpp"
#include "model/schema/clock.hpp"
#include "model/schema/words.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/io.hpp"

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

std::vector<PetSpec> read_pets(const std::vector<YamlNode>& nodes, Diagnostics& faults) {
  std::vector<PetSpec> pets;
  Names ids("pet");
  for (const YamlNode& node : nodes) {
    YamlMap map(node, faults, "pets");
    PetSpec& pet = pets.emplace_back();
    map.require("kind");
    read_fields(map, pet);
    pet.id = map.text("id", word_of(pet.kind));
    pet.where = node.where();
    const std::string fault = ids.fault_of_adding(pet.id);
    if (!fault.empty()) faults.error(node.where(), fault);
    map.finish();
  }
  return pets;
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
  every_trial.pets = read_pets(map.list("pets", limits::list_entries), faults);
  for (TrialSpec& trial : script.trials) {
    if (!trial.duration_s) trial.duration_s = every_trial.duration_s;
    trial.pets = every_trial.pets;
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

/// Then the value is a name, and may look like a number: `sensor: 1`.
bool is_choice(const std::string& effect, const std::string& setting) {
  const std::vector<effects::EffectInfo> known = effects::list();
  return std::ranges::any_of(known, [&](const effects::EffectInfo& info) {
    return info.name == effect &&
           std::ranges::find(info.choices, setting, &effects::ChoiceInfo::name) != info.choices.end();
  });
}

void read_setting(const YamlKey& key, const YamlNode& value, EffectSpec& effect, Diagnostics& faults) {
  const std::string what = effect.name + "." + key.name;
  const std::string text = value.text(faults, what);
  if (!value.is_scalar()) return;
  if (!is_choice(effect.name, key.name) && parse_number<double>(text)) {
    effect.parameters[key.name] = value.number(faults, what);
  } else {
    effect.choices[key.name] = text;
  }
}

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
std::string time_key_of(std::string_view field) {
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

Vec2 read_point(const YamlNode& node, Diagnostics& faults, std::string_view what) {
  const std::vector<double> xz = read_numbers(node, faults, what, accepted::on_floor_m);
  if (xz.size() == 2) return {xz[0], xz[1]};
  if (node.is_list()) faults.error(node.where(), std::string(what) + ": expected two numbers, x and z");
  return Vec2(0.0);
}

enum class Form { scalar, map, either };

struct ActionKind {
  const char* key;
  Action (*read)(const YamlNode&, const ActionKind&, Diagnostics&);
  Form form;
  const char* example;
  const char* required = nullptr;  ///< a key of the map
};

Action read_wait_s(const YamlNode& node, const ActionKind&, Diagnostics& faults) {
  action::Wait wait;
  each_number(wait, [&](const char*, double& value, const NumberRange& range) {
    value = node.number(faults, "wait_s", range);
  });
  return wait;
}
Action read_appear(const YamlNode& node, const ActionKind&, Diagnostics& faults) {
  action::Appear appear;
  if (!node.is_map()) {
    appear.place = node.text(faults, "appear");
    return appear;
  }
  YamlMap map(node, faults, "appear");
  if (map.has("place")) {
    appear.place = map.required_text("place");
    appear.posture = map.choice("posture", appear.posture,
                                words_of<LyingPosture, LyingPosture>(field_of<&action::Appear::posture>()));
  } else {
    appear.point = read_point(map.required_child("at_xz_m"), faults, "at_xz_m");
    read_numbers(map, appear);
  }
  map.finish();
  return appear;
}
Action read_walk(const YamlNode& node, const ActionKind&, Diagnostics& faults) {
  YamlMap map(node, faults, "walk");
  action::Walk walk;
  for (const YamlNode& point : map.required_list("to_xz_m", limits::walk_points))
    walk.points.push_back(read_point(point, faults, "to_xz_m"));
  read_fields(map, walk);
  map.finish();
  return walk;
}
Action read_rise(const YamlNode& node, const ActionKind&, Diagnostics& faults) {
  if (!node.is_null() && !node.is_scalar()) faults.error(node.where(), "rise: expected nothing");
  return action::Rise{};
}
/// A map of fields.
template <typename What>
Action read_map(const YamlNode& node, const ActionKind& kind, Diagnostics& faults) {
  YamlMap map(node, faults, kind.key);
  What what;
  if (kind.required != nullptr) map.require(kind.required);
  read_fields(map, what);
  map.finish();
  return what;
}
/// The name of an entrance, a seat or a place, or a map with more; kind.required is the name's key there.
template <typename What, std::string What::*name>
Action read_name(const YamlNode& node, const ActionKind& kind, Diagnostics& faults) {
  What what;
  if (kind.required == nullptr || !node.is_map()) {
    what.*name = node.text(faults, kind.key);
    return what;
  }
  YamlMap map(node, faults, kind.key);
  what.*name = map.required_text(kind.required);
  read_fields(map, what);
  map.finish();
  return what;
}
Action read_follow(const YamlNode& node, const ActionKind&, Diagnostics& faults) {
  YamlMap map(node, faults, "follow");
  action::Follow follow;
  for (const YamlNode& row : map.required_list("t_x_z", limits::walk_points)) {
    const std::vector<double> numbers = read_numbers(row, faults, "t_x_z");
    if (numbers.size() != 3 && numbers.size() != 4) {
      if (row.is_list()) faults.error(row.where(), "t_x_z: expected three numbers, t, x and z, or four with a heading");
      continue;
    }
    follow.times_s.push_back(numbers[0]);
    follow.points.emplace_back(numbers[1], numbers[2]);
    if (numbers.size() == 4) follow.headings_deg.push_back(numbers[3]);
  }
  const std::string fault = follow_fault(follow.times_s, follow.points, follow.headings_deg);
  if (!fault.empty() && !faults.has_errors()) faults.error(map.where("t_x_z"), "t_x_z: " + fault);
  map.finish();
  return follow;
}

constexpr std::array<ActionKind, 13> action_kinds{
    {{"wait_s", read_wait_s, Form::scalar, "{wait_s: 60}"},
     {"wait", read_map<action::Wait>, Form::map, "{wait: {duration_s: 60}}", "duration_s"},
     {"appear", read_appear, Form::either, "{appear: bed}"},
     {"enter", read_name<action::Enter, &action::Enter::entrance>, Form::scalar, "{enter: door, at: \"09:00\"}"},
     {"walk", read_walk, Form::map, "{walk: {to_xz_m: [[1, -2], [3, -2]]}}"},
     {"sit", read_name<action::Sit, &action::Sit::seat>, Form::either, "{sit: S1, at: \"09:00\"}", "seat"},
     {"lie", read_name<action::Lie, &action::Lie::place>, Form::either, "{lie: bed, at: \"23:00\"}", "place"},
     {"stand", read_name<action::Stand, &action::Stand::place>, Form::either, "{stand: stove, at: \"12:00\"}", "place"},
     {"work", read_map<action::Work>, Form::map, "{work: {duration_s: 180}}"},
     {"rise", read_rise, Form::scalar, "{rise: , at: \"10:00\"}"},
     {"turn", read_map<action::Turn>, Form::map, "{turn: {heading_deg: 90}}", "heading_deg"},
     {"leave", read_name<action::Leave, &action::Leave::entrance>, Form::scalar, "{leave: door, at: \"17:00\"}"},
     {"follow", read_follow, Form::map, "{follow: {t_x_z: [[0, 1, -2], [5, 3, -2]]}}"}}};

/// A value of another form than the action takes is told with an example.
Action read_value(const ActionKind& kind, const YamlNode& value, Diagnostics& faults) {
  Diagnostics told;
  Action action = kind.read(value, kind, told);
  const bool fits = (value.is_map() && kind.form != Form::scalar) || (value.is_scalar() && kind.form != Form::map);
  for (const Issue& issue : told.issues()) {
    const bool is_of_form = !fits && issue.where == value.where();
    faults.error(issue.where, issue.message + (is_of_form ? std::string("; for example ") + kind.example : ""));
  }
  return action;
}

std::vector<std::string> action_names() {
  std::vector<std::string> names;
  for (const ActionKind& kind : action_kinds) names.emplace_back(kind.key);
  return names;
}

/// The nearest name, or else all that there are.
std::string hint(const std::string& name) {
  const std::vector<std::string> names = action_names();
  std::string text = did_you_mean(name, names);
  if (!text.empty()) return text;
  for (const std::string& known : names) text += (text.empty() ? "; known are " : ", ") + known;
  return text;
}

/// The moment of the run that `at` names. The caller knows that the action has it.
std::optional<double> read_at(YamlMap& map, const ScriptTime& time) {
  Diagnostics& faults = map.faults();
  const std::string text = map.text("at");
  const auto refuse = [&](const std::string& why) {
    faults.error(map.where("at"), "at: " + why);
    return std::nullopt;
  };
  if (map.has("at_s")) return refuse("stands beside at_s, and an action begins once: leave out one of them");
  if (!time.clock) {
    constexpr const char* why =
        "the script has no clock: add `begin: 2026-03-02T00:00`, the date and time at which a run begins, at its top, "
        "or write at_s, the seconds since a run began";
    return refuse(why);
  }
  const auto at_s = time.clock->run_seconds(text);
  if (!at_s) return refuse("expected a time of day, e.g. 06:45, or a date and a time, e.g. 2026-03-03T06:45");
  if (time.day_s) {
    if (text.find('-') != std::string::npos)
      return refuse("with a schedule every run is another day: leave out the date");
    if (*at_s > *time.day_s)
      return refuse(text + " isn't between the schedule's `from` and `to`, the part of a day that is simulated");
  }
  if (*at_s < 0.0) return refuse(text + " is before the run begins, at " + time.clock->text(0.0));
  if (!accepted::at_s.holds(*at_s)) return refuse(text + " is more than 115 days after the run begins");
  return at_s;
}

bool stands_beside_an_action(const std::string& key) { return key == "at_s" || key == "at" || key == "phase"; }

ScriptedAction read_action_map(const YamlNode& node, const ScriptTime& time, Diagnostics& faults) {
  YamlMap map(node, faults, "action");
  ScriptedAction action;
  action.where = node.where();
  action.at_s = map.optional_number("at_s", accepted::at_s);
  static_cast<void>(map.text("at"));  // known, so that finish() can suggest it
  if (map.has("at")) action.at_s = read_at(map, time);
  action.phase = map.text("phase");
  int found = 0;
  for (const ActionKind& kind : action_kinds) {
    if (!map.has(kind.key)) {
      static_cast<void>(map.child(kind.key));  // known, so that finish() can suggest it
      continue;
    }
    action.where = map.where(kind.key);
    action.what = read_value(kind, *map.child(kind.key), faults);
    ++found;
  }
  const std::vector<YamlKey> keys = node.keys();
  if (found == 0 && keys.size() == 1 && !stands_beside_an_action(keys[0].name)) {
    faults.error(keys[0].where, "'" + keys[0].name + "' isn't an action" + hint(keys[0].name));
    return action;
  }
  map.finish();
  if (found > 1) faults.error(node.where(), "one action per entry: start each with its own '-'");
  const bool nothing_else = std::ranges::all_of(keys, stands_beside_an_action, &YamlKey::name);
  if (found == 0 && nothing_else && (node.is_map() || node.is_null()))
    faults.error(node.where(), "an action is missing, e.g. `sit: S1`");
  return action;
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

void check_version(YamlMap& map, const std::string& key) {
  constexpr int format_version = 1;
  refuse_other_kinds(map, key);
  const std::size_t n_told = map.faults().issues().size();
  const int version = map.required_integer(key);
  if (map.faults().issues().size() != n_told || version == format_version) return;
  map.faults().error(map.where(key), "format version " + std::to_string(version) +
                                         " isn't known: this pirsim reads version " + std::to_string(format_version));
}

double read_hours(YamlMap& map, const std::string& key, double otherwise) {
  const std::string text = map.text(key);
  constexpr std::size_t to_minutes = 5;
  const auto hours = text.size() <= to_minutes ? clock_hours(text) : std::nullopt;
  if (!hours) map.faults().error(map.where(key), key + ": expected a time of day from 00:00 to 24:00, e.g. 08:30");
  return hours.value_or(otherwise);
}

SensingSpec read_sensing(const std::optional<YamlNode>& node, Diagnostics& faults) {
  SensingSpec sensing;
  if (!node) return sensing;
  YamlMap map(*node, faults, "sensing");
  read_fields(map, sensing);
  const double window_s = map.number("window_s", 1.0, accepted::window_s);
  const double ticks = window_s * sensing.tick_rate_hz;
  if (std::abs(ticks - std::round(ticks)) > 1e-9 * ticks || ticks < 1.0) {
    faults.error(map.where("window_s"),
                 "window_s: expected a whole number of ticks of 1/" + std::to_string(sensing.tick_rate_hz) + " s");
  }
  sensing.ticks_per_window = static_cast<int>(std::lround(ticks));
  map.finish();
  return sensing;
}

std::vector<EffectSpec> read_effects(const std::vector<YamlNode>& items, Diagnostics& faults) {
  std::vector<EffectSpec> effects;
  for (const YamlNode& item : items) {
    EffectSpec& effect = effects.emplace_back();
    effect.where = item.where();
    if (item.is_scalar()) {
      effect.name = item.text(faults, "effect");
      continue;
    }
    const std::vector<YamlKey> names = item.keys();
    if (names.size() != 1) {
      faults.error(item.where(), "one effect per entry, as `- dead_time: {dead_s: 2}`");
      continue;
    }
    effect.name = names[0].name;
    effect.where = names[0].where;
    const YamlNode settings = item.items()[0];
    if (!settings.is_map() && !settings.is_null()) {
      faults.error(settings.where(), effect.name + ": expected parameters by name");
    }
    const std::vector<YamlKey> keys = settings.keys();
    const std::vector<YamlNode> values = settings.items();
    for (std::size_t i = 0; i < keys.size(); ++i) read_setting(keys[i], values[i], effect, faults);
  }
  return effects;
}

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
    faults.error(map.where(time_key_of(field)), is_date ? message : "schedule: " + message);
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

ScriptedAction read_action(const YamlNode& node, const ScriptTime& time, Diagnostics& faults) {
  if (!node.is_scalar()) return read_action_map(node, time, faults);
  const std::string word = node.text(faults, "action");
  if (word != "rise") {
    const bool is_known = std::ranges::any_of(action_kinds, [&](const ActionKind& kind) { return kind.key == word; });
    faults.error(node.where(), "'" + word + "' " +
                                   (is_known ? "needs a value: `" + word + ": ...`" : "isn't an action" + hint(word)));
  }
  return {action::Rise{}, std::nullopt, {}, node.where()};
}

}  // namespace pirsim::io
