#include "pirsim/control.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "io/files/input.hpp"
#include "io/read/reader_parts.hpp"

namespace pirsim::control {
namespace {

constexpr NumberRange delay_min{.min = 0.0, .max = 1440.0}, reaction_s{.min = 0.0, .max = 3600.0};

/// The map of that name, if it is there.
template <typename Part, typename Read>
void read_part(io::YamlMap& above, const std::string& key, std::optional<Part>& part, Read read) {
  const auto node = above.child(key);
  if (!node) return;
  io::YamlMap map(*node, above.faults(), key);
  read(map, part.emplace());
  map.finish();
}

double hours(io::YamlMap& map, const std::string& key, double otherwise) {
  return map.has(key) ? io::read_hours(map, key, otherwise) : (static_cast<void>(map.child(key)), otherwise);
}

/// One number, or several.
std::vector<double> read_delays(io::YamlMap& map, const std::vector<double>& otherwise) {
  const auto node = map.child("delay_min");
  if (!node || !node->is_list()) return {map.number("delay_min", otherwise.front(), delay_min)};
  const std::vector<double> delays = map.numbers("delay_min", {}, delay_min);
  if (delays.empty()) map.faults().error(node->where(), "delay_min: expected a number, or several");
  for (auto delay = delays.begin(); delay != delays.end(); ++delay) {
    if (std::find(delays.begin(), delay, *delay) == delay) continue;
    const io::YamlNode again = map.list("delay_min")[static_cast<std::size_t>(delay - delays.begin())];
    map.faults().error(again.where(), "delay_min: " + shortest_number(*delay) + " is named twice");
  }
  return delays.empty() ? otherwise : delays;
}

LightSpec read_light(const io::YamlNode& node, std::size_t index, Diagnostics& faults) {
  io::YamlMap map(node, faults, "light");
  LightSpec light;
  light.where = node.where();
  light.area = map.text("area");
  light.id = map.text("id", light.area.empty() ? "light_" + std::to_string(index + 1) : light.area);
  light.sensors = map.texts("sensors");
  read_part(map, "together", light.together, [](io::YamlMap& own, TogetherSpec& together) {
    together.sensors = own.integer("sensors", together.sensors, {.min = 1, .max = 1000});
    together.within_s = own.number("within_s", together.within_s, reaction_s);
  });
  light.delays_min = read_delays(map, light.delays_min);
  read_part(map, "manual", light.manual, [](io::YamlMap& own, ManualSpec& manual) {
    manual.switch_s = own.number("switch_s", manual.switch_s, reaction_s);
    manual.grace_s = own.number("grace_s", manual.grace_s, reaction_s);
  });
  if (map.child("wave_s")) light.wave_s = map.number("wave_s", 0.0, reaction_s);
  if (light.wave_s && light.manual)
    faults.error(map.where("wave_s"), "wave_s: with `manual`, who is in the dark uses the switch instead");
  light.timer = map.choice<Timer>("timer", light.timer, {{"restarts", Timer::restarts}, {"runs_out", Timer::runs_out}});
  light.least_on_min = map.number("least_on_min", light.least_on_min, delay_min);
  light.door = map.text("door");
  light.settle_s = map.number("settle_s", light.settle_s, reaction_s);
  if (map.has("settle_s") && light.door.empty())
    faults.error(map.where("settle_s"), "settle_s: of its door, and the light has no `door`");
  read_part(map, "night", light.night, [](io::YamlMap& own, NightSpec& night) {
    night.from_h = hours(own, "from", night.from_h);
    night.to_h = hours(own, "to", night.to_h);
    night.delay_min = own.number("delay_min", night.delay_min, delay_min);
  });
  light.from_h = hours(map, "from", light.from_h);
  light.to_h = hours(map, "to", light.to_h);
  light.power_w = map.number("power_w", light.power_w, {.min = 0.0, .max = 1e6});
  light.at_most_a_week = map.number("at_most_a_week", light.at_most_a_week, {.min = 1e-3, .max = 1e4});
  if (map.has("sensors") && light.sensors.empty())
    faults.error(map.where("sensors"), "sensors: light '" + light.id + "' has none that could switch it");
  const bool is_whole_day = light.from_h == 0.0 && light.to_h == 24.0;
  if (!is_whole_day && std::fmod(light.from_h, 24.0) == std::fmod(light.to_h, 24.0))
    faults.error(map.where("to"), "light: `to` is `from`: it is never dark");
  if (const std::string bad = name_fault(light.id); !bad.empty())
    faults.error(map.where("id"), "light: id: '" + light.id + "': " + bad);
  map.finish();
  return light;
}

RuleSpec read(const io::YamlNode& root, const std::string& name) {
  Diagnostics faults;
  io::YamlMap map(root, faults, "rule");
  io::check_version(map, "pirsim_control");
  RuleSpec rule;
  rule.name = map.text("name", name);
  Names ids("light");
  for (const io::YamlNode& node : map.required_list("lights", limits::list_entries)) {
    const LightSpec light = read_light(node, rule.lights.size(), faults);
    const std::string again = ids.fault_of_adding(light.id);
    if (!again.empty()) faults.error(light.where, again);
    rule.lights.push_back(light);
  }
  map.finish();
  faults.throw_if_errors();
  return rule;
}

}  // namespace

RuleSpec read_rule(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read(io::YamlNode::load(io::read_input(file), overrides), io::stem_of_input(file));
}

RuleSpec parse_rule(std::string_view text, const std::string& name) {
  return read(io::YamlNode::parse(text, name), name);
}

}  // namespace pirsim::control
