#include "pirsim/io.hpp"

#include "io/coverage_keys.hpp"
#include "io/sensing_reader.hpp"

namespace pirsim::io {
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
  spec.person.stature_m = map.number("stature_m", spec.person.stature_m, {.min = 0.8, .max = 2.3});
  spec.person.mass_kg = map.number("mass_kg", spec.person.mass_kg, {.min = 10.0, .max = 250.0});
  spec.person.walking_speed_m_s =
      map.number("walking_speed_m_s", spec.person.walking_speed_m_s, {.min = 0.1, .max = 3.0});
  map.finish();
}

}  // namespace

WalkTestSpec read_walk_test(const std::filesystem::path& file, std::span<const std::string> overrides) {
  const YamlNode root = YamlNode::load(file, overrides);
  Diagnostics faults;
  YamlMap map(root, faults, "walk test");
  check_version(map, "pirsim_walk_test");
  WalkTestSpec spec;
  spec.name = map.text("name", file.stem().string());
  spec.sensing = read_sensing(map.child("sensing"), faults);
  spec.spacing_m = map.number("spacing_m", spec.spacing_m, {.min = 0.05, .max = 10.0});
  spec.person.id = "walker";
  if (const auto node = map.child("person")) read_person(*node, spec, faults);
  if (const auto node = map.child("major_motion")) read_major(*node, spec, faults);
  if (const auto node = map.child("minor_motion")) read_minor(*node, spec, faults);
  read_seed_and_effects(map, spec.seed, spec.effects);
  map.finish();
  faults.throw_if_errors();
  return spec;
}

}  // namespace pirsim::io
