#include "effects/catalogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/text.hpp"
#include "effects/kit.hpp"

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

std::string judged_as(std::string_view name) {
  const EffectInfo& info = find(name).info;
  return info.same_as.empty() ? info.name : info.same_as;
}

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

}  // namespace pirsim::effects
