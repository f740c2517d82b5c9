#include "pirsim/io.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "io/coverage_keys.hpp"
#include "io/effect_reader.hpp"
#include "io/sensing_reader.hpp"
#include "pirsim/effects.hpp"

namespace pirsim::io {
namespace {

TurnSpec read_turn(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "turn");
  TurnSpec turn;
  const std::vector<double> axis = map.required_numbers("axis", 3, {.min = -1e6, .max = 1e6});
  turn.axis = {axis[0], axis[1], axis[2]};
  if (glm::length(turn.axis) < 1e-9) faults.error(map.where("axis"), "axis: expected a direction, not a point");
  turn.deg_per_s = map.required_number("deg_per_s", {.min = -3600.0, .max = 3600.0});
  map.finish();
  return turn;
}

XShapesSpec read_x_shapes(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "x_shapes");
  XShapesSpec target;
  target.heights_m = map.numbers("heights_m", target.heights_m, {.min = 0.0, .max = 10.0});
  target.bar_length_m = map.number("bar_length_m", target.bar_length_m, {.above = 0.0, .max = 5.0});
  target.bar_width_m = map.number("bar_width_m", target.bar_width_m, {.above = 0.0, .max = 1.0});
  target.temperature_c = map.number("temperature_c", target.temperature_c, {.min = -50.0, .max = 200.0});
  if (target.bar_width_m > target.bar_length_m) {
    faults.error(map.where("bar_width_m"), "bar_width_m: a bar can't be wider than it is long");
  }
  if (map.has("turns")) {
    target.turns.clear();
    for (const YamlNode& turn : map.required_list("turns")) target.turns.push_back(read_turn(turn, faults));
  }
  map.finish();
  return target;
}

}  // namespace

void read_coverage_keys(YamlMap& map, CoverageSpec& spec) {
  Diagnostics& faults = map.faults();
  spec.sensing = read_sensing(map.child("sensing"), faults);
  spec.spacing_m = map.number("spacing_m", spec.spacing_m, {.min = 0.005, .max = 10.0});
  spec.duration_s = map.number("duration_s", spec.duration_s, {.above = 0.0, .max = 3600.0});
  const double windows = spec.duration_s * spec.sensing.tick_rate_hz / spec.sensing.ticks_per_window;
  if (std::abs(windows - std::round(windows)) > 1e-9 * windows || windows < 1.0) {
    faults.error(map.where("duration_s"), "duration_s: expected a whole number of windows");
  }
  for (const YamlNode& item : map.list("without")) {
    spec.without.push_back(item.text(faults, "without"));
    spec.without_where.push_back(item.where());
  }
  YamlMap target(map.required_child("target"), faults, "target");
  spec.target = read_x_shapes(target.required_child("x_shapes"), faults);
  target.finish();
  read_seed_and_effects(map, spec.seed, spec.effects);
}

void read_seed_and_effects(YamlMap& map, std::uint64_t& seed, std::vector<EffectSpec>& effects) {
  seed = map.unsigned_integer("seed", seed);
  effects = read_effects(map.list("effects"), map.faults());
  pirsim::effects::check(effects, map.faults());
}

void check_version(YamlMap& map, const std::string& key) {
  constexpr int format_version = 1;
  const int version = map.required_integer(key);
  if (!map.has(key) || version == format_version) return;
  map.faults().error(map.where(key), "format version " + std::to_string(version) +
                                         " isn't known: this pirsim reads version " + std::to_string(format_version));
}

CoverageSpec read_coverage(const std::filesystem::path& file, std::span<const std::string> overrides) {
  const YamlNode root = YamlNode::load(file, overrides);
  Diagnostics faults;
  YamlMap map(root, faults, "coverage study");
  check_version(map, "pirsim_coverage");
  CoverageSpec spec;
  spec.name = map.text("name", file.stem().string());
  read_coverage_keys(map, spec);
  map.finish();
  faults.throw_if_errors();
  return spec;
}

}  // namespace pirsim::io
