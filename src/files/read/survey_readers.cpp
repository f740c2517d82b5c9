#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "files/read/reader_parts.hpp"
#include "files/read/yaml.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/io.hpp"
#include "pirsim/script.hpp"
#include "pirsim/survey.hpp"

// What the readers of surveys have in common. Private to io.

namespace pirsim::io {

/// `effects` of any survey.
[[nodiscard]] std::vector<EffectSpec> read_survey_effects(YamlMap& map);

/// A file of format version 1; all its faults are told at once.
template <typename Fill>
auto read_versioned(const YamlNode& root, const char* what, const char* version_key, Fill fill) {
  Diagnostics faults;
  YamlMap map(root, faults, what);
  check_version(map, version_key);
  auto spec = fill(map);
  map.finish();
  faults.throw_if_errors();
  return spec;
}

// Readers of coverage studies, placements and the nuisance, which share their keys.

std::vector<EffectSpec> read_survey_effects(YamlMap& map) {
  const std::vector<EffectSpec> effects = read_effects(map.list("effects"), map.faults());
  pirsim::effects::check(effects, map.faults());
  return effects;
}

namespace {

TurnSpec read_turn(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "turn");
  TurnSpec turn;
  const std::vector<double> axis = map.required_numbers("axis", 3, {.min = -1e6, .max = 1e6});
  turn.axis = {axis[0], axis[1], axis[2]};
  if (glm::length(turn.axis) < 1e-9) faults.error(map.where("axis"), "axis: expected a direction, not a point");
  map.require("deg_per_s");
  read_numbers(map, turn);
  map.finish();
  return turn;
}

XShapesSpec read_x_shapes(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "x_shapes");
  XShapesSpec target;
  read_numbers(map, target);
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

/// sensing, spacing_m, duration_s, without, target, seed and effects.
void read_coverage_keys(YamlMap& map, CoverageSpec& spec) {
  Diagnostics& faults = map.faults();
  spec.sensing = read_sensing(map.child("sensing"), faults);
  read_numbers(map, spec);
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
  spec.effects = read_survey_effects(map);
}

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
  const double yaw_deg = map.number("yaw_deg", 0.0, accepted::turned_deg);
  sensor.world_from_sensor = mounted(position, yaw_deg, map.number("tilt_deg", 20.0, accepted::tilted_deg));
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
  map.require("n_sensors");
  read_numbers(map, search);
  search.model = map.required_text("model");
  models.try_emplace(search.model, map.where("model"));
  for (const YamlNode& item : map.required_list("lines")) {
    YamlMap line(item, faults, "line");
    MountingLineSpec& spec = search.lines.emplace_back();
    spec.from = read_point(line, "from_m");
    spec.to = read_point(line, "to_m");
    read_numbers(line, spec);
    line.finish();
  }
  map.finish();
  return search;
}

PlacementLightSpec read_light(const YamlNode& node, const detail::FilesBeside& beside, Diagnostics& faults) {
  YamlMap map(node, faults, "light");
  PlacementLightSpec light;
  read_numbers(map, light);
  const std::string script = map.required_text("script");
  std::vector<std::string> overrides;
  if (map.child("replicates"))
    overrides.push_back("replicates=" + std::to_string(map.integer("replicates", 1, {.min = 1, .max = 1000})));
  map.finish();
  if (script.empty()) return light;
  const NamedFile named = beside.find(script, DataKind::studies);
  if (!named.fault.empty()) {
    faults.error(map.where("script"), "light: script: " + named.fault);
    return light;
  }
  try {
    light.people = read_script(named.path, overrides, beside.data_directories);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::io) throw;
    faults.error(map.where("script"), std::string("light: script: ") + error.what());
  }
  return light;
}

/// Numbers of the test itself that stand with the movement that they are about.
template <auto... members>
void read_numbers_of(YamlMap& map, WalkTestSpec& spec) {
  (read_number(map, spec, field_of<members>()), ...);
}

constexpr const char* forearm_keys[] = {"seat_height_m", "desk_height_m", "arm_amplitude_m", "arm_period_s"};

void read_major(YamlMap& map, WalkTestSpec& spec) {
  read_numbers_of<&WalkTestSpec::path_m, &WalkTestSpec::stop_s>(map, spec);
  if (!map.has("within_s")) return;
  if (map.has("stop_s"))
    map.faults().error(map.where("stop_s"), "stop_s: it says by itself how long motion counts; leave out within_s");
  spec.stop_s.reset();
}

void read_minor(YamlMap& map, WalkTestSpec& spec) {
  read_numbers_of<&WalkTestSpec::seat_height_m, &WalkTestSpec::desk_height_m, &WalkTestSpec::arm_amplitude_m,
                  &WalkTestSpec::arm_period_s>(map, spec);
  if (map.child("arm")) read_part(map, "arm", spec.arm ? *spec.arm : spec.arm.emplace());
  if (!spec.arm) return;
  for (const char* key : forearm_keys) {
    if (map.has(key))
      map.faults().error(map.where(key),
                         std::string(key) + ": is of a sitter's forearms, in whose place an arm swings");
  }
}

WalkTestSpec read(YamlMap& map, const std::string& name) {
  WalkTestSpec spec;
  spec.name = map.text("name", name);
  spec.sensing = read_sensing(map.child("sensing"), map.faults());
  read_numbers_of<&WalkTestSpec::spacing_m, &WalkTestSpec::seed>(map, spec);
  if (const auto node = map.child("person")) {
    YamlMap person(*node, map.faults(), "person");
    read_numbers(person, spec.person);
    person.finish();
  }
  read_part(map, "major_motion", spec.major, [&](YamlMap& own) { read_major(own, spec); });
  read_part(map, "minor_motion", spec.minor, [&](YamlMap& own) { read_minor(own, spec); });
  spec.effects = read_survey_effects(map);
  return spec;
}

}  // namespace

CoverageSpec read_coverage(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_versioned(YamlNode::load(read_input(file), overrides), "coverage study", "pirsim_coverage",
                        [&](YamlMap& map) {
                          CoverageSpec spec;
                          spec.name = map.text("name", stem_of_input(file));
                          read_coverage_keys(map, spec);
                          return spec;
                        });
}

PlacementSpec read_placements(const std::filesystem::path& file, std::span<const std::string> overrides,
                              std::span<const std::filesystem::path> data_directories) {
  return read_versioned(
      YamlNode::load(read_input(file), overrides), "placement study", "pirsim_placements", [&](YamlMap& map) {
        PlacementSpec spec;
        spec.coverage.name = map.text("name", stem_of_input(file));
        read_coverage_keys(map, spec.coverage);
        std::set<std::string> ids;
        for (const YamlNode& set : map.list("sets")) {
          spec.sets.push_back(read_set(set, spec.models, map.faults()));
          if (!ids.insert(spec.sets.back().id).second)
            map.faults().error(set.where(), "a second set '" + spec.sets.back().id + "'");
        }
        read_fields(map, spec);
        if (map.has("by")) spec.by_where = map.where("by");
        if (const auto light = map.child("light"))
          spec.light = read_light(*light, {folder_of_input(file), data_directories}, map.faults());
        if (spec.by == PlacementAim::false_off && !spec.light) {
          map.faults().error(spec.by_where,
                             "by: false_off: whose light? It needs `light: {script: week.yaml, delay_min: 10}`");
        }
        if (const auto search = map.child("search")) {
          spec.search = read_search(*search, spec.models, map.faults());
          if (spec.by != PlacementAim::area && spec.search->evaluations < spec.search->n_sensors) {
            map.faults().error(search->where(), "search: " + std::to_string(spec.search->n_sensors) +
                                                    " sensors need as many places: evaluations, by " +
                                                    word_of(spec.by) + " the number of places, is " +
                                                    std::to_string(spec.search->evaluations));
          }
        }
        return spec;
      });
}

NuisanceSpec read_nuisance(const std::filesystem::path& file) {
  return read_versioned(YamlNode::load(read_input(file)), "nuisance", "pirsim_nuisance", [&](YamlMap& map) {
    NuisanceSpec spec;
    read_numbers(map, spec);
    return spec;
  });
}

// Reader of walk tests.

WalkTestSpec read_walk_test(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_versioned(YamlNode::load(read_input(file), overrides), "walk test", "pirsim_walk_test",
                        [&](YamlMap& map) { return read(map, stem_of_input(file)); });
}

}  // namespace pirsim::io
