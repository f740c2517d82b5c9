#include "engine/effects/catalogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <utility>

#include "engine/effects/kit.hpp"
#include "model/core/text.hpp"
#include "pirsim/response.hpp"

namespace pirsim::effects {

// The order in which effects act: the room and its people, the optics, what disturbs the element, what the electronics
// make of it, and the books.
const std::vector<const Effect*>& catalogue() {
  static const std::vector<Effect> entries = [] {
    std::vector<Effect> all;
    for (const auto group : {room_effects, people_effects, mounting_effects, motion_effects, lens_effects,
                             environment_effects, electronics_effects, books_effects})
      std::ranges::move(group(), std::back_inserter(all));
    return all;
  }();
  static const std::vector<const Effect*> effects = [] {
    std::vector<const Effect*> all;
    for (const Effect& entry : entries) all.push_back(&entry);
    return all;
  }();
  return effects;
}

std::string_view name(Family family) noexcept {
  static constexpr std::array<std::string_view, 8> names{"optics",      "person",      "mounting", "occlusion",
                                                         "electronics", "environment", "motion",   "data"};
  return names[static_cast<std::size_t>(family)];
}
std::string_view name(Reach reach) noexcept {
  static constexpr std::array<std::string_view, 3> names{"geometry", "triggers", "rows"};
  return names[static_cast<std::size_t>(reach)];
}
std::string_view name(Scale scale) noexcept {
  static constexpr std::array<std::string_view, 3> names{"linear", "logarithmic", "whole"};
  return names[static_cast<std::size_t>(scale)];
}
std::string_view name(Survey survey) noexcept { return survey == Survey::coverage ? "coverage study" : "walk test"; }

const Effect& find(std::string_view name) {
  const auto& all = catalogue();
  const auto found = std::ranges::find_if(all, [&](const Effect* effect) { return effect->info.name == name; });
  if (found != all.end()) return **found;
  std::vector<std::string> names;
  for (const Effect* effect : all) names.push_back(effect->info.name);
  // "softzone" is too far from "soft_zone_edges" to be a slip of the keys, but hardly means anything else.
  const auto bare = [](std::string_view text) {
    std::string letters(text);
    std::erase_if(letters, [](char c) { return c == '_' || c == '-' || c == ' '; });
    return letters;
  };
  const auto holds = [&](const std::string& known) { return bare(known).find(bare(name)) != std::string::npos; };
  const auto longer = std::ranges::find_if(names, holds);
  const bool slip = !did_you_mean(name, names).empty() || name.empty() || longer == names.end();
  throw Error(ErrorCode::usage, "'" + std::string(name) + "' is not an effect" +
                                    (slip ? near_or_all(name, names) : " (did you mean '" + *longer + "'?)"));
}

std::vector<EffectInfo> list() {
  std::vector<EffectInfo> infos;
  for (const Effect* effect : catalogue()) infos.push_back(effect->info);
  return infos;
}

const EffectInfo& info(std::string_view name) { return find(name).info; }

std::vector<const Effect*> catalogue_for(const ScriptSpec& script) {
  const bool counts = std::ranges::any_of(
      script.trials, [](const TrialSpec& trial) { return trial.occupancy && trial.occupancy->counts; });
  std::vector<const Effect*> all = catalogue();
  std::erase_if(all, [&](const Effect* effect) { return effect->info.needs == Needs::counts && !counts; });
  return all;
}

std::vector<std::string> twins_of(std::string_view name) {
  std::vector<std::string> twins;
  for (const Effect* effect : catalogue()) {
    if (effect->info.same_as == name) twins.push_back(effect->info.name);
  }
  return twins;
}

bool applies(const ParameterInfo& parameter, const EffectSpec& effect) {
  const auto& [choice, word] = parameter.only_if;
  if (choice.empty()) return true;
  return effects::word(effect, choice) == word;
}

const ParameterInfo& strength_parameter(const EffectSpec& effect) {
  return *std::ranges::find_if(find(effect.name).info.parameters, [&](const ParameterInfo& parameter) {
    return parameter.role == Role::strength && applies(parameter, effect);
  });
}

bool is_off(const EffectSpec& effect) {
  const EffectSpec complete = resolved(find(effect.name), effect);
  return std::ranges::all_of(find(effect.name).info.parameters, [&](const ParameterInfo& parameter) {
    return parameter.role == Role::detail || !applies(parameter, effect) ||
           complete.parameters.at(parameter.name) == parameter.off;
  });
}

EffectSpec resolved(const Effect& effect, EffectSpec spec) {
  for (const ParameterInfo& parameter : effect.info.parameters) {
    if (applies(parameter, spec)) spec.parameters.try_emplace(parameter.name, parameter.typical);
  }
  return spec;
}

EffectSpec off(const Effect& effect) {
  EffectSpec spec{effect.info.name, {}, {}, {}};
  for (const ParameterInfo& parameter : effect.info.parameters) {
    if (applies(parameter, spec)) spec.parameters[parameter.name] = parameter.off;
  }
  return spec;
}

StudyInForce in_force(SceneSpec scene, const ScriptSpec& script) {
  Diagnostics diagnostics;
  pirsim::check(scene, diagnostics);
  pirsim::check(script, diagnostics);
  diagnostics.throw_if_errors();
  check(script.effects, scene, diagnostics);
  diagnostics.throw_if_errors();
  StudyInForce study = as_given(std::move(scene), script);
  for (const Effect* effect : catalogue()) {
    for (const EffectSpec& spec : script.effects) {
      if (effect->alter == nullptr || spec.name != effect->info.name || is_off(spec)) continue;
      effect->alter(study, resolved(*effect, spec));
    }
  }
  return study;
}

namespace {

double drawn_value(const ParameterInfo& parameter, Stream& stream) {
  const double u = stream.uniform();
  switch (parameter.scale) {
    case Scale::logarithmic:
      return parameter.low * std::pow(parameter.high / parameter.low, u);
    case Scale::whole:
      return std::min(parameter.high, std::floor(parameter.low + u * (parameter.high - parameter.low + 1.0)));
    case Scale::linear:
      break;
  }
  return parameter.low + u * (parameter.high - parameter.low);
}

std::string with_unit(double value, const std::string& unit) {
  std::ostringstream out;
  out << value << (unit.empty() ? "" : " ") << unit;
  return out.str();
}

std::string range_of(const ParameterInfo& parameter) {
  std::ostringstream out;
  out << parameter.low;
  if (parameter.low != parameter.high) out << " to " << parameter.high;
  if (!parameter.unit.empty()) out << ' ' << parameter.unit;
  if (parameter.scale == Scale::logarithmic) out << ", logarithmic";
  return out.str();
}

/// What a script may say.
std::string limits_of(const ParameterInfo& parameter) {
  std::ostringstream out;
  out << parameter.least << " to " << parameter.most;
  if (!parameter.unit.empty()) out << ' ' << parameter.unit;
  return out.str();
}

std::string off_of(const ParameterInfo& parameter) {
  return parameter.role == Role::detail ? "-" : with_unit(parameter.off, parameter.unit);
}

/// Of the range, and with which choice the parameter means anything.
std::string source_of(const ParameterInfo& parameter) {
  const auto& [choice, word] = parameter.only_if;
  return choice.empty() ? parameter.source : parameter.source + "; only with " + choice + ": " + word;
}

std::string values_of(const ChoiceInfo& choice) {
  if (choice.kind == ChoiceKind::sensor) return "a sensor's name";
  if (choice.kind == ChoiceKind::mesh) return "a mesh's name";
  return joined(choice.words, ", ");
}

std::string in_script(const Effect& effect) {
  std::ostringstream out;
  out << "- " << effect.info.name << ": {";
  std::string separator;
  for (const ParameterInfo& parameter : effect.info.parameters) {
    if (parameter.role == Role::detail || !applies(parameter, {effect.info.name, {}, {}, {}})) continue;
    out << separator << parameter.name << ": " << parameter.typical;
    separator = ", ";
  }
  out << '}';
  return out.str();
}

std::string same_as_sentence(const EffectInfo& info) {
  return "It changes the model as " + info.same_as + " does, so reconcile judges both as one, by that name.";
}

/// With which the name of a parameter in that unit ends.
std::string_view suffix_of(const std::string& unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> suffixes{{{"m", "_m"},
                                                                                   {"s", "_s"},
                                                                                   {"deg", "_deg"},
                                                                                   {"K", "_k"},
                                                                                   {"Hz", "_hz"},
                                                                                   {"%", "_percent"},
                                                                                   {"1/s", "_per_s"},
                                                                                   {"m/s", "_m_s"}}};
  const auto* found = std::ranges::find(suffixes, unit, [](const auto& entry) { return entry.first; });
  return found == suffixes.end() ? std::string_view() : found->second;
}

std::string spaced(std::string text) {
  std::ranges::replace(text, '_', ' ');
  return text;
}

/// As limits_of(), off_of() and range_of() give them, but without the unit with which the parameter's name ends.
ParameterInfo without_named_unit(ParameterInfo parameter) {
  const std::string_view suffix = suffix_of(parameter.unit);
  if (!suffix.empty() && parameter.name.ends_with(suffix)) parameter.unit.clear();
  return parameter;
}

void add_markdown(std::ostream& out, const Effect& effect) {
  const EffectInfo& info = effect.info;
  out << "### " << info.name << '\n' << info.summary << "\n\n";
  out << "Fingerprint: " << info.fingerprint << ".\n";
  if (!info.confused_with.empty()) out << "Easily taken for: " << joined(info.confused_with, ", ") << ".\n";
  if (!info.same_as.empty()) out << same_as_sentence(info) << "\n";
  if (!info.in_analog.empty()) out << "With analog sensors: " << info.in_analog << ".\n";
  out << "\n| key | off | typical | prior | accepted | source |\n|---|---|---|---|---|---|\n";
  for (const ParameterInfo& given : info.parameters) {
    const ParameterInfo parameter = without_named_unit(given);
    out << "| `" << parameter.name << "` | " << (parameter.role == Role::detail ? "" : off_of(parameter) + " ") << "| "
        << with_unit(parameter.typical, parameter.unit) << " | " << range_of(parameter) << " | " << limits_of(parameter)
        << " | " << source_of(parameter) << " |\n";
  }
  for (const ChoiceInfo& choice : info.choices) {
    out << "| `" << choice.name << "` | | " << choice.otherwise << " | | " << values_of(choice) << " | |\n";
  }
  out << '\n';
}

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

EffectSpec draw_from_prior(const Effect& effect, const SceneSpec& scene, const ScriptSpec& script, Stream& stream) {
  EffectSpec spec{effect.info.name, {}, {}, {}};
  for (const ParameterInfo& parameter : effect.info.parameters) {
    spec.parameters[parameter.name] = drawn_value(parameter, stream);
  }
  for (const ChoiceInfo& choice : effect.info.choices) {
    const auto pick = [&](const auto& list) { return list[stream.index(static_cast<std::uint32_t>(list.size()))]; };
    if (is_word(choice.kind)) spec.choices[choice.name] = pick(choice.words);
    if (choice.kind == ChoiceKind::sensor && stream.index(2) == 1) spec.choices[choice.name] = pick(scene.sensors).id;
  }
  if (effect.draw != nullptr) effect.draw(spec, scene, script, stream);
  for (const ParameterInfo& parameter : effect.info.parameters) {
    if (!applies(parameter, spec)) spec.parameters.erase(parameter.name);
  }
  return spec;
}

EffectSpec settled(EffectSpec effect, const SceneSpec& scene) {
  const Effect& entry = find(effect.name);
  if (entry.settle != nullptr) entry.settle(effect, scene);
  return effect;
}

std::string phrase_of(const ParameterInfo& parameter) {
  if (!parameter.phrase.empty()) return parameter.phrase;
  std::string_view name = parameter.name;
  const std::string_view suffix = suffix_of(parameter.unit);
  if (name.ends_with(suffix)) name.remove_suffix(suffix.size());
  return spaced(std::string(name));
}

std::string phrase_of(const ChoiceInfo& choice, const std::string& value) {
  return spaced(choice.name) + " " + (is_word(choice.kind) ? spaced(value) : value);
}

std::string list_text() {
  std::size_t longest = 0;
  for (const Effect* effect : catalogue()) longest = std::max(longest, effect->info.name.size());
  std::ostringstream out;
  for (const Effect* effect : catalogue()) {
    out << std::left << std::setw(static_cast<int>(longest) + 1) << effect->info.name << std::setw(13)
        << name(effect->info.family);
    const ParameterInfo& strength = effect->info.parameters.front();
    const std::string range = range_of(strength);
    out << std::setw(46)
        << (strength.name + " (off " + off_of(strength) + "; " + range.substr(0, range.find(',')) + ")")
        << effect->info.summary << '\n';
  }
  return out.str();
}

std::string to_text(const Effect& effect) {
  const EffectInfo& info = effect.info;
  std::ostringstream out;
  out << info.name << " (" << name(info.family) << ")\n" << info.summary << "\n\n";
  out << "fingerprint:      " << info.fingerprint << '\n';
  out << "easily taken for: " << joined(info.confused_with, ", ") << '\n';
  if (!info.same_as.empty()) out << "in data:          " << same_as_sentence(info) << '\n';
  if (!info.in_analog.empty()) out << "analog sensors:   " << info.in_analog << '\n';
  out << "acts in:          " << info.stage << " (" << name(info.reach) << ")\n\nparameters:\n";
  for (const ParameterInfo& parameter : info.parameters) {
    out << "  " << std::left << std::setw(16) << parameter.name << "off " << std::setw(8) << off_of(parameter)
        << "typical " << std::setw(10) << with_unit(parameter.typical, parameter.unit) << "prior "
        << range_of(parameter) << "\n                  accepted: " << limits_of(parameter)
        << "\n                  source: " << source_of(parameter) << '\n';
  }
  for (const ChoiceInfo& choice : info.choices) {
    out << "  " << std::left << std::setw(16) << choice.name << values_of(choice) << " (else: " << choice.otherwise
        << ")\n";
  }
  out << "\nin a script:\n  effects:\n    " << in_script(effect) << '\n';
  return out.str();
}

std::string list_markdown() {
  std::ostringstream out;
  constexpr std::array families{Family::optics,      Family::person,      Family::mounting, Family::occlusion,
                                Family::electronics, Family::environment, Family::motion,   Family::data};
  for (const Family family : families) {
    out << "## " << name(family) << '\n';
    for (const Effect* effect : catalogue()) {
      if (effect->info.family == family) add_markdown(out, *effect);
    }
  }
  return out.str();
}

// Faults of `effects:`, all at once.

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
