// Reader of walk tests.
#include <optional>
#include <string>

#include "io/read/reader_parts.hpp"
#include "io/read/survey_parts.hpp"
#include "pirsim/io.hpp"
#include "pirsim/survey.hpp"

namespace pirsim::io {
namespace {

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

WalkTestSpec read_walk_test(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_versioned(YamlNode::load(read_input(file), overrides), "walk test", "pirsim_walk_test",
                        [&](YamlMap& map) { return read(map, stem_of_input(file)); });
}

}  // namespace pirsim::io
