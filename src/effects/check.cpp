// Faults of `effects:`, all at once.
#include <algorithm>
#include <sstream>

#include "core/text.hpp"
#include "effects/catalogue.hpp"
#include "pirsim/response.hpp"

namespace pirsim::effects {
namespace {

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::vector<std::string> names_of(const auto& items) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

std::vector<std::string> setting_names(const EffectInfo& info) {
  std::vector<std::string> names = names_of(info.parameters);
  for (const ChoiceInfo& choice : info.choices) names.push_back(choice.name);
  return names;
}

/// The nearest of its settings, or else all.
std::string nearest_or_all(const std::string& name, const EffectInfo& info) {
  const std::vector<std::string> names = setting_names(info);
  const std::string nearest = did_you_mean(name, names);
  if (!nearest.empty()) return nearest;
  return names.empty() ? "; it has none" : "; known are " + joined(names, ", ");
}

void check_parameters(const EffectSpec& spec, const EffectInfo& info, Diagnostics& diagnostics) {
  for (const auto& [name, value] : spec.parameters) {
    const auto known = std::ranges::find(info.parameters, name, &ParameterInfo::name);
    if (known == info.parameters.end()) {
      const bool is_choice = std::ranges::find(info.choices, name, &ChoiceInfo::name) != info.choices.end();
      diagnostics.error(spec.where, is_choice
                                        ? info.name + "." + name + ": expected a name, not a number"
                                        : info.name + " has no parameter '" + name + "'" + nearest_or_all(name, info));
    } else if (!(value >= known->least && value <= known->most)) {
      diagnostics.error(spec.where, info.name + "." + name + ": expected a number from " + text(known->least) + " to " +
                                        text(known->most) + ", not " + text(value));
    } else if (!applies(*known, spec)) {
      diagnostics.error(spec.where, info.name + "." + name + " means nothing without " + known->only_if.choice + ": " +
                                        known->only_if.word);
    }
  }
}

void check_choices(const EffectSpec& spec, const EffectInfo& info, const SceneSpec* scene, Diagnostics& diagnostics) {
  for (const auto& [name, value] : spec.choices) {
    const auto known = std::ranges::find(info.choices, name, &ChoiceInfo::name);
    if (known == info.choices.end()) {
      const bool is_number = std::ranges::find(info.parameters, name, &ParameterInfo::name) != info.parameters.end();
      diagnostics.error(spec.where, is_number
                                        ? info.name + "." + name + ": expected a number, not '" + value + "'"
                                        : info.name + " has no setting '" + name + "'" + nearest_or_all(name, info));
      continue;
    }
    std::vector<std::string> allowed = known->words;
    if (!is_word(known->kind) && scene == nullptr) continue;
    if (known->kind == ChoiceKind::sensor) {
      for (const SensorSpec& sensor : scene->sensors) allowed.push_back(sensor.id);
    } else if (known->kind == ChoiceKind::mesh) {
      allowed = names_of(scene->meshes);
    }
    if (std::ranges::find(allowed, value) != allowed.end()) continue;
    const std::string place = is_word(known->kind) ? "known here" : "in " + scene->name;
    diagnostics.error(spec.where,
                      info.name + "." + name + ": '" + value + "' is not " + place + near_or_all(value, allowed));
  }
}

void check_sense(const EffectSpec& spec, const Effect& effect, const SceneSpec* scene, Diagnostics& diagnostics) {
  if (scene == nullptr || effect.fault == nullptr) return;
  const std::string fault = effect.fault(spec, *scene);
  if (!fault.empty()) diagnostics.error(spec.where, spec.name + ": " + fault);
}

std::string made(const EffectSpec& spec, const ChoiceInfo& choice) {
  const auto named = spec.choices.find(choice.name);
  if (named != spec.choices.end()) return named->second;
  return is_word(choice.kind) ? choice.words.front() : "";
}

bool is_where(const ChoiceInfo& choice) { return choice.kind != ChoiceKind::variant; }

/// Whether both of two entries of an effect can act: for two sensors or walls, each named, in two ways, or in one way
/// at two places. Others would draw the same numbers, or the later would undo the earlier.
bool apart(const EffectSpec& a, const EffectSpec& b, const EffectInfo& info) {
  const auto which = std::ranges::find_if(info.choices, is_where);
  if (which == info.choices.end()) return false;
  const ChoiceInfo& choice = *which;
  const std::string x = made(a, choice), y = made(b, choice);
  if (choice.kind != ChoiceKind::word) return !x.empty() && !y.empty() && x != y;
  return x != y || std::ranges::any_of(info.parameters, [&](const ParameterInfo& parameter) {
           const auto value = [&](const EffectSpec& spec) {
             const auto given = spec.parameters.find(parameter.name);
             return given == spec.parameters.end() ? parameter.typical : given->second;
           };
           const bool says_where = parameter.role == Role::detail && parameter.only_if.choice == choice.name;
           return says_where && parameter.only_if.word == x && value(a) != value(b);
         });
}

std::string second_time(const EffectInfo& info) {
  std::string text = info.name + " stands here a second time";
  const auto which = std::ranges::find_if(info.choices, is_where);
  if (which != info.choices.end() && which->kind != ChoiceKind::word) text += " for the same " + which->name;
  return text;
}

void check_all(std::span<const EffectSpec> effects, const SceneSpec* scene, Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const EffectSpec& spec = effects[i];
    const auto known = std::ranges::find(catalogue(), spec.name, [](const Effect* e) { return e->info.name; });
    if (known == catalogue().end()) {
      std::vector<std::string> names;
      for (const Effect* effect : catalogue()) names.push_back(effect->info.name);
      std::string hint = did_you_mean(spec.name, names);
      if (hint.empty()) hint = "; known are " + joined(names, ", ");
      diagnostics.error(spec.where, "'" + spec.name + "' is not an effect" + hint);
      continue;
    }
    check_parameters(spec, (*known)->info, diagnostics);
    check_choices(spec, (*known)->info, scene, diagnostics);
    check_sense(spec, **known, scene, diagnostics);
    for (std::size_t before = 0; before < i; ++before) {
      if (effects[before].name == spec.name && !apart(effects[before], spec, (*known)->info))
        diagnostics.error(spec.where, second_time((*known)->info));
    }
  }
}

}  // namespace

void check(std::span<const EffectSpec> effects, Diagnostics& diagnostics) { check_all(effects, nullptr, diagnostics); }

void check(std::span<const EffectSpec> effects, const SceneSpec& scene, Diagnostics& diagnostics) {
  check_all(effects, &scene, diagnostics);
}

bool any_of_zones(const SceneSpec& scene, const SensingSpec& sensing) {
  return std::ranges::any_of(
      scene.sensors, [&](const SensorSpec& sensor) { return response_of(scene, sensing, sensor) == Response::zones; });
}

bool means_anything(const EffectInfo& info, const SceneSpec& scene, const SensingSpec& sensing) {
  return info.acts_on == ActsOn::all_sensors || any_of_zones(scene, sensing);
}

std::vector<Issue> idle(std::span<const EffectSpec> effects, const SceneSpec& scene, const SensingSpec& sensing) {
  Diagnostics remarks;
  for (const EffectSpec& spec : effects) {
    if (is_off(spec) || means_anything(find(spec.name).info, scene, sensing)) continue;
    remarks.warning(spec.where, spec.name + " does nothing here: it acts on sensors with response: zones, and " +
                                    "every sensor's response is analog");
  }
  return remarks.issues();
}

}  // namespace pirsim::effects
