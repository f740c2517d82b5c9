#include "io/read/reader_parts.hpp"

#include <algorithm>
#include <cmath>

#include "io/files/atomic_file.hpp"
#include "io/read/file_kinds.hpp"
#include "io/read/yaml_map.hpp"
#include "pirsim/effects.hpp"

namespace pirsim::io {

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

}  // namespace pirsim::io
