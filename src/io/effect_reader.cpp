#include "io/effect_reader.hpp"

#include <algorithm>

#include "io/text_input.hpp"
#include "pirsim/effects.hpp"

namespace pirsim::io {
namespace {

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

}  // namespace

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
      faults.error(item.where(), "an effect an entry, as `- dead_time: {dead_s: 2}`");
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

}  // namespace pirsim::io
