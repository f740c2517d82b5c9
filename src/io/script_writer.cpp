#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "io/schedule_writer.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/io.hpp"
#include "schema/clock.hpp"

namespace pirsim::io {
namespace {

YAML::Node number(double value) { return YAML::Node(csv_number(value)); }

YAML::Node point(const Vec2& p) {
  YAML::Node node;
  node.push_back(number(p.x));
  node.push_back(number(p.y));
  node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

const char* name(Activity activity) { return activity_names[static_cast<std::size_t>(activity)]; }

/// Adds an action's key and value to its entry.
struct ActionWriter {
  YAML::Node entry;

  void operator()(const action::Wait& wait) {
    if (wait.activity) {
      entry["wait"]["duration_s"] = number(wait.duration_s);
      entry["wait"]["activity"] = name(*wait.activity);
    } else {
      entry["wait_s"] = number(wait.duration_s);
    }
  }
  void operator()(const action::Appear& appear) {
    entry["appear"]["at_xz_m"] = point(appear.point);
    entry["appear"]["heading_deg"] = number(appear.heading_deg);
  }
  void operator()(const action::Enter& enter) { entry["enter"] = enter.entrance; }
  void operator()(const action::Walk& walk) {
    entry["walk"]["to_xz_m"] = YAML::Node(YAML::NodeType::Sequence);
    for (const Vec2& p : walk.points) entry["walk"]["to_xz_m"].push_back(point(p));
    if (walk.activity) entry["walk"]["activity"] = name(*walk.activity);
  }
  void operator()(const action::Sit& sit) {
    const action::Sit plain{sit.seat};
    if (sit.wait_s == plain.wait_s && sit.if_taken == plain.if_taken) {
      entry["sit"] = sit.seat;
      return;
    }
    entry["sit"]["seat"] = sit.seat;
    entry["sit"]["wait_s"] = number(sit.wait_s);
    entry["sit"]["if_taken"] = sit.if_taken == action::IfTaken::other_seat ? "other_seat" : "next_action";
  }
  void operator()(const action::Work& work) {
    YAML::Node node;
    node["duration_s"] = number(work.duration_s);
    node["arm_amplitude_m"] = number(work.arm_amplitude_m);
    node["arm_period_s"] = number(work.arm_period_s);
    node["tilt_choices_deg"] = YAML::Node(YAML::NodeType::Sequence);
    for (const double tilt : work.tilt_choices_deg) node["tilt_choices_deg"].push_back(number(tilt));
    node["tilt_choices_deg"].SetStyle(YAML::EmitterStyle::Flow);
    node["tilt_every_s"] = number(work.tilt_every_s);
    if (work.activity) node["activity"] = name(*work.activity);
    entry["work"] = node;
  }
  void operator()(const action::Rise&) { entry["rise"] = YAML::Node(YAML::NodeType::Null); }
  void operator()(const action::Turn& turn) { entry["turn"]["heading_deg"] = number(turn.heading_deg); }
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
  node["stature_m"] = number(person.stature_m);
  node["mass_kg"] = number(person.mass_kg);
  node["walking_speed_m_s"] = number(person.walking_speed_m_s);
  node["seat_scatter"]["position_sd_m"] = number(person.seat_scatter.position_sd_m);
  node["seat_scatter"]["heading_sd_deg"] = number(person.seat_scatter.heading_sd_deg);
  if (!person.body_mesh_file.empty()) node["body_mesh"] = person.body_mesh_file;
  if (person.style == MotionStyle::natural) node["style"] = "natural";
  node["warmth"]["skin_c"] = number(person.warmth.skin_c);
  node["warmth"]["clothing_clo"] = number(person.warmth.clothing_clo);
  node["warmth"]["bare"] = person.warmth.bare;
  for (const auto& [part, temperature] : person.warmth.parts_c) node["warmth"]["parts_c"][part] = number(temperature);
  node["actions"] = YAML::Node(YAML::NodeType::Sequence);
  for (const ScriptedAction& action : person.actions) node["actions"].push_back(write(action, clock));
  escape_variables(node);
  return node;
}

YAML::Node write(const SensingSpec& sensing) {
  YAML::Node node;
  node["tick_rate_hz"] = sensing.tick_rate_hz;
  node["window_s"] = number(static_cast<double>(sensing.ticks_per_window) / sensing.tick_rate_hz);
  node["rays_per_zone"] = static_cast<int>(sensing.rays_per_zone);
  node["change_per"] = sensing.change_per == ChangePer::cluster ? "cluster" : "beam";
  node["reader"] = sensing.reader == Reader::in_step ? "in_step" : "free_running";
  if (sensing.response) node["response"] = *sensing.response == Response::analog ? "analog" : "zones";
  node["ambient_c"] = number(sensing.ambient_c);
  node["analog_rays_per_zone"] = sensing.analog_rays_per_zone;
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

}  // namespace

ScriptSpec moved(ScriptSpec script, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const auto move = [&](std::string& file) {
    if (file.empty() || fs::path(file).is_absolute()) return;
    const fs::path there = fs::absolute(fs::path(script.directory) / file);
    const fs::path from_here =
        fs::weakly_canonical(there).lexically_relative(fs::weakly_canonical(fs::absolute(folder)));
    file = (from_here.empty() ? there : from_here).generic_string();
  };
  move(script.summary.reference_file);
  for (TrialSpec& trial : script.trials) {
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
    root["schedule"] = to_node(*script.trials.front().schedule);
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
