// Readers of coverage studies, walk tests, placements and the nuisance, which share their keys.
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <string>

#include "io/reader_parts.hpp"
#include "io/yaml_map.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/io.hpp"
#include "pirsim/survey.hpp"

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

/// `seed` and `effects` of any survey.
void read_seed_and_effects(YamlMap& map, std::uint64_t& seed, std::vector<EffectSpec>& effects) {
  seed = map.unsigned_integer("seed", seed);
  effects = read_effects(map.list("effects"), map.faults());
  pirsim::effects::check(effects, map.faults());
}

/// sensing, spacing_m, duration_s, without, target, seed and effects.
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

/// A file of format version 1; all its faults are told at once.
template <typename Fill>
auto read_versioned(const std::filesystem::path& file, std::span<const std::string> overrides, const char* what,
                    const char* version_key, Fill fill) {
  const YamlNode root = YamlNode::load(read_input(file), overrides);
  Diagnostics faults;
  YamlMap map(root, faults, what);
  check_version(map, version_key);
  auto spec = fill(map);
  map.finish();
  faults.throw_if_errors();
  return spec;
}

}  // namespace

CoverageSpec read_coverage(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_versioned(file, overrides, "coverage study", "pirsim_coverage", [&](YamlMap& map) {
    CoverageSpec spec;
    spec.name = map.text("name", stem_of_input(file));
    read_coverage_keys(map, spec);
    return spec;
  });
}

namespace {

Vec3 read_point(YamlMap& map, const std::string& key) {
  const std::vector<double> p = map.required_numbers(key, 3, {.min = -1e4, .max = 1e4});
  return {p[0], p[1], p[2]};
}

using ModelPlaces = std::map<std::string, Where>;

SensorSpec read_sensor(const YamlNode& node, std::size_t index, ModelPlaces& models, Diagnostics& faults) {
  YamlMap map(node, faults, "sensor");
  SensorSpec sensor;
  sensor.id = map.text("id", "PIR" + std::to_string(index + 1));
  const std::string fault = name_fault(sensor.id);
  if (!fault.empty()) faults.error(map.where("id"), "sensor: id: '" + sensor.id + "': " + fault);
  sensor.model = map.required_text("model");
  models.try_emplace(sensor.model, map.where("model"));
  const Vec3 position = read_point(map, "position_m");
  const double yaw_deg = map.number("yaw_deg", 0.0, {.min = -360.0, .max = 360.0});
  sensor.world_from_sensor = mounted(position, yaw_deg, map.number("tilt_deg", 20.0, {.min = -90.0, .max = 90.0}));
  map.finish();
  return sensor;
}

SensorSetSpec read_set(const YamlNode& node, ModelPlaces& models, Diagnostics& faults) {
  YamlMap map(node, faults, "set");
  SensorSetSpec set;
  set.id = map.required_text("id");
  for (const YamlNode& sensor : map.list("sensors")) {
    set.sensors.push_back(read_sensor(sensor, set.sensors.size(), models, faults));
    set.where.push_back(sensor.where());
  }
  map.finish();
  return set;
}

PlacementSearchSpec read_search(const YamlNode& node, ModelPlaces& models, Diagnostics& faults) {
  YamlMap map(node, faults, "search");
  PlacementSearchSpec search;
  search.n_sensors = map.required_integer("n_sensors", {.min = 1, .max = 20});
  search.model = map.required_text("model");
  models.try_emplace(search.model, map.where("model"));
  search.evaluations = map.integer("evaluations", search.evaluations, {.min = 1, .max = 100000});
  for (const YamlNode& item : map.required_list("lines")) {
    YamlMap line(item, faults, "line");
    MountingLineSpec& spec = search.lines.emplace_back();
    spec.from = read_point(line, "from_m");
    spec.to = read_point(line, "to_m");
    spec.yaw_deg = line.number("yaw_deg", 0.0, {.min = -360.0, .max = 360.0});
    spec.tilt_deg = line.number("tilt_deg", spec.tilt_deg, {.min = -90.0, .max = 90.0});
    line.finish();
  }
  map.finish();
  return search;
}

}  // namespace

PlacementSpec read_placements(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_versioned(file, overrides, "placement study", "pirsim_placements", [&](YamlMap& map) {
    PlacementSpec spec;
    spec.coverage.name = map.text("name", stem_of_input(file));
    read_coverage_keys(map, spec.coverage);
    std::set<std::string> ids;
    for (const YamlNode& set : map.list("sets")) {
      spec.sets.push_back(read_set(set, spec.models, map.faults()));
      if (!ids.insert(spec.sets.back().id).second)
        map.faults().error(set.where(), "a second set '" + spec.sets.back().id + "'");
    }
    if (const auto search = map.child("search")) spec.search = read_search(*search, spec.models, map.faults());
    return spec;
  });
}

namespace {

void read_requirement(YamlMap& map, WalkRequirement& requirement) {
  requirement.within_s = map.number("within_s", requirement.within_s, {.above = 0.0, .max = 600.0});
  requirement.probability = map.number("probability", requirement.probability, {.above = 0.0, .max = 1.0});
  requirement.directions = map.integer("directions", requirement.directions, {.min = 1, .max = 360});
}

void read_major(const YamlNode& node, WalkTestSpec& spec, Diagnostics& faults) {
  YamlMap map(node, faults, "major_motion");
  read_requirement(map, spec.major);
  spec.path_m = map.number("path_m", spec.path_m, {.min = 0.5, .max = 20.0});
  map.finish();
}

void read_minor(const YamlNode& node, WalkTestSpec& spec, Diagnostics& faults) {
  YamlMap map(node, faults, "minor_motion");
  read_requirement(map, spec.minor);
  spec.seat_height_m = map.number("seat_height_m", spec.seat_height_m, {.min = 0.3, .max = 0.8});
  spec.desk_height_m = map.number("desk_height_m", spec.desk_height_m, {.min = 0.5, .max = 1.1});
  spec.arm_amplitude_m = map.number("arm_amplitude_m", spec.arm_amplitude_m, {.min = 0.0, .max = 0.15});
  spec.arm_period_s = map.number("arm_period_s", spec.arm_period_s, {.min = 0.5, .max = 60.0});
  map.finish();
}

void read_person(const YamlNode& node, WalkTestSpec& spec, Diagnostics& faults) {
  YamlMap map(node, faults, "person");
  read_numbers(map, spec.person);
  map.finish();
}

}  // namespace

WalkTestSpec read_walk_test(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_versioned(file, overrides, "walk test", "pirsim_walk_test", [&](YamlMap& map) {
    WalkTestSpec spec;
    spec.name = map.text("name", stem_of_input(file));
    spec.sensing = read_sensing(map.child("sensing"), map.faults());
    spec.spacing_m = map.number("spacing_m", spec.spacing_m, {.min = 0.05, .max = 10.0});
    if (const auto node = map.child("person")) read_person(*node, spec, map.faults());
    if (const auto node = map.child("major_motion")) read_major(*node, spec, map.faults());
    if (const auto node = map.child("minor_motion")) read_minor(*node, spec, map.faults());
    read_seed_and_effects(map, spec.seed, spec.effects);
    return spec;
  });
}

NuisanceSpec read_nuisance(const std::filesystem::path& file) {
  return read_versioned(file, {}, "nuisance", "pirsim_nuisance", [&](YamlMap& map) {
    NuisanceSpec spec;
    spec.seat_position_m = map.number("seat_position_m", spec.seat_position_m, {.min = 0.0, .max = 0.2});
    spec.sensor_yaw_deg = map.number("sensor_yaw_deg", spec.sensor_yaw_deg, {.min = 0.0, .max = 10.0});
    spec.sensor_tilt_deg = map.number("sensor_tilt_deg", spec.sensor_tilt_deg, {.min = 0.0, .max = 10.0});
    spec.body_size = map.number("body_size", spec.body_size, {.min = 0.0, .max = 0.2});
    spec.arm_amplitude = map.number("arm_amplitude", spec.arm_amplitude, {.min = 0.0, .max = 0.5});
    spec.uneven_arms = map.number("uneven_arms", spec.uneven_arms, {.min = 0.0, .max = 1.0});
    spec.trunk_sway_deg = map.number("trunk_sway_deg", spec.trunk_sway_deg, {.min = 0.0, .max = 12.0});
    return spec;
  });
}

}  // namespace pirsim::io
