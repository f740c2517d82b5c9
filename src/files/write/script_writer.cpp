#include "files/write/script_writer.hpp"

#include <yaml-cpp/yaml.h>
#include <cmath>
#include <filesystem>
#include <optional>

#include "model/schema/check_script.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/io.hpp"

namespace pirsim::io {
namespace {

YAML::Node point(const Vec2& p) {
  YAML::Node node;
  node.push_back(number(p.x));
  node.push_back(number(p.y));
  node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

/// Adds an action's key and value to its entry.
struct ActionWriter {
  YAML::Node entry;

  void operator()(const action::Wait& wait) {
    if (wait.activity) {
      entry["wait"] = written(wait);
    } else {
      entry["wait_s"] = number(wait.duration_s);
    }
  }
  void operator()(const action::Appear& appear) {
    if (!appear.place.empty()) {
      entry["appear"]["place"] = appear.place;
      entry["appear"]["posture"] = word_of(appear.posture);
      return;
    }
    entry["appear"]["at_xz_m"] = point(appear.point);
    entry["appear"]["heading_deg"] = number(appear.heading_deg);
  }
  void operator()(const action::Enter& enter) { entry["enter"] = enter.entrance; }
  void operator()(const action::Walk& walk) {
    entry["walk"]["to_xz_m"] = YAML::Node(YAML::NodeType::Sequence);
    for (const Vec2& p : walk.points) entry["walk"]["to_xz_m"].push_back(point(p));
    if (walk.activity) entry["walk"]["activity"] = word_of(*walk.activity);
  }
  void operator()(const action::Sit& sit) {
    entry["sit"] = same(sit, action::Sit{sit.seat}) ? YAML::Node(sit.seat) : written(sit);
  }
  void operator()(const action::Lie& lie) { entry["lie"] = written(lie); }
  void operator()(const action::Stand& stand) { entry["stand"] = written(stand); }
  void operator()(const action::Work& work) { entry["work"] = written(work); }
  void operator()(const action::Rise&) { entry["rise"] = YAML::Node(YAML::NodeType::Null); }
  void operator()(const action::Turn& turn) { entry["turn"] = written(turn); }
  void operator()(const action::Follow& follow) {
    YAML::Node rows(YAML::NodeType::Sequence);
    for (std::size_t i = 0; i < follow.times_s.size(); ++i) {
      YAML::Node row = point(follow.points[i]);
      YAML::Node whole;
      whole.push_back(number(follow.times_s[i]));
      for (const auto& entry : row) whole.push_back(entry);
      if (!follow.headings_deg.empty()) whole.push_back(number(follow.headings_deg[i]));
      whole.SetStyle(YAML::EmitterStyle::Flow);
      rows.push_back(whole);
    }
    entry["follow"]["t_x_z"] = rows;
  }
  void operator()(const action::Leave& leave) { entry["leave"] = leave.entrance; }
};

/// On a script's own clock, a moment is written as the time that it shows.
YAML::Node write(const ScriptedAction& action, const std::optional<RunClock>& clock) {
  ActionWriter writer;
  std::visit(writer, action.what);
  if (action.at_s) {
    const bool is_shown = clock && *action.at_s == std::floor(*action.at_s);
    writer.entry[is_shown ? "at" : "at_s"] = is_shown ? clock->shortest_text(*action.at_s) : csv_number(*action.at_s);
  }
  if (!action.phase.empty()) writer.entry["phase"] = action.phase;
  return writer.entry;
}

/// Texts of people are read with their `${variables}` put in.
void escape_variables(YAML::Node node) {
  if (node.IsScalar()) {
    std::string text = node.Scalar();
    for (std::size_t at = 0; (at = text.find("${", at)) != std::string::npos; at += 3) text.insert(at, "$");
    if (text != node.Scalar()) node = text;
  } else if (node.IsSequence()) {
    for (YAML::Node item : node) escape_variables(item);
  } else if (node.IsMap()) {
    for (const auto& entry : node) escape_variables(entry.second);
  }
}

YAML::Node write(const PersonSpec& person, const std::optional<RunClock>& clock) {
  YAML::Node node;
  node["id"] = person.id;
  write_numbers(person, node);
  node["seat_scatter"] = written(person.seat_scatter);
  if (!person.body_mesh_file.empty()) node["body_mesh"] = person.body_mesh_file;
  if (person.style != PersonSpec{}.style) node["style"] = word_of(person.style);
  node["warmth"] = written(person.warmth);
  node["actions"] = YAML::Node(YAML::NodeType::Sequence);
  for (const ScriptedAction& action : person.actions) node["actions"].push_back(write(action, clock));
  escape_variables(node);
  return node;
}

YAML::Node write(const SensingSpec& sensing) {
  YAML::Node node;
  node["tick_rate_hz"] = sensing.tick_rate_hz;
  node["window_s"] = number(static_cast<double>(sensing.ticks_per_window) / sensing.tick_rate_hz);
  const YAML::Node others = written(sensing);
  for (const auto& entry : others) {
    if (entry.first.Scalar() != "ticks_per_window") node[entry.first.Scalar()] = entry.second;
  }
  return node;
}

YAML::Node write(const EffectSpec& effect) {
  YAML::Node settings(YAML::NodeType::Map);
  for (const auto& [name, value] : effect.parameters) settings[name] = number(value);
  for (const auto& [name, choice] : effect.choices) settings[name] = choice;
  YAML::Node node;
  node[effect.name] = settings;
  return node;
}

YAML::Node write(const OccupancySpec& occupancy) {
  YAML::Node node;
  const std::string& file = data_file(occupancy);
  if (file.empty()) throw Error(ErrorCode::usage, "an occupancy that wasn't read from a file can't be written as YAML");
  node[occupancy.counts ? "counts" : occupancy.places ? "places" : "positions"] = file;
  if (occupancy.counts && !occupancy.counts->time.empty()) node["time"] = occupancy.counts->time;
  if (occupancy.counts && !occupancy.counts->column.empty()) node["people"] = occupancy.counts->column;
  if (occupancy.counts) {
    for (const AreaCountsSpec& area : occupancy.counts->areas) node["areas"][area.area] = area.column;
  }
  if (occupancy.from_h) node["from"] = time_of_day(*occupancy.from_h);
  if (occupancy.to_h) node["to"] = time_of_day(*occupancy.to_h);
  write_numbers(occupancy, node);
  if (!occupancy.seats.empty()) node["seats"] = occupancy.seats;
  if (!occupancy.entrances.empty()) node["entrances"] = occupancy.entrances;
  node["style"] = word_of(occupancy.style);
  return node;
}

}  // namespace

ScriptSpec moved(ScriptSpec script, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const auto move = [&](std::string& file) {
    if (file.empty() || fs::path(file).is_absolute()) return;
    const fs::path there = fs::absolute(fs::path(script.directory) / file);
    if (!fs::path(file).has_parent_path() && !fs::exists(there)) return;  // a shipped one is found from everywhere
    const fs::path from_here =
        fs::weakly_canonical(there).lexically_relative(fs::weakly_canonical(fs::absolute(folder)));
    file = (from_here.empty() ? there : from_here).generic_string();
  };
  move(script.summary.reference_file);
  for (TrialSpec& trial : script.trials) {
    if (trial.occupancy && !data_file(*trial.occupancy).empty()) move(data_file(*trial.occupancy));
    for (PersonSpec& person : trial.people) move(person.body_mesh_file);
  }
  script.directory = folder.string();
  return script;
}

std::string to_yaml(const ScriptSpec& script) {
  YAML::Node root;
  root["pirsim_script"] = 1;
  root["name"] = script.name;
  root["seed"] = script.seed;
  root["replicates"] = script.replicates;
  if (!script.begin.empty()) root["begin"] = script.begin;
  root["sensing"] = write(script.sensing);
  root["summary"]["phases"] = script.summary.phases;
  root["summary"]["reference"] = script.summary.reference_file;
  // Read scripts have one schedule for all trials.
  if (!script.trials.empty() && script.trials.front().schedule) {
    root["schedule"] = written(*script.trials.front().schedule);
    if (script.trials.front().schedule->household) {  // whose days are always as long
      root["schedule"].remove("from");
      root["schedule"].remove("to");
    }
  }
  if (!script.trials.empty() && script.trials.front().occupancy)
    root["occupancy"] = write(*script.trials.front().occupancy);
  if (!script.trials.empty()) {
    for (const PetSpec& pet : script.trials.front().pets) root["pets"].push_back(written(pet));
  }
  const std::optional<RunClock> clock = clock_from(script.begin);
  for (const TrialSpec& trial : script.trials) {
    YAML::Node node;
    node["id"] = trial.id;
    if (trial.duration_s) node["duration_s"] = number(*trial.duration_s);
    for (const PersonSpec& person : trial.people) node["people"].push_back(write(person, clock));
    root["trials"].push_back(node);
  }
  for (const EffectSpec& effect : script.effects) root["effects"].push_back(write(effect));
  YAML::Emitter out;
  out << root;
  return std::string(out.c_str()) + '\n';
}

}  // namespace pirsim::io
