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

/// A cell is crossed from edge to edge.
void fit_path(YamlMap& map, WalkTestSpec& spec) {
  spec.path_m = spec.spacing_m;
  if (!range_of(field_of<&WalkTestSpec::path_m>(), spec).holds(spec.path_m))
    map.faults().error(map.where("spacing_m"),
                       "spacing_m: nobody can walk across so small a cell: expected 0.5 or more");
}

WalkTestSpec read(YamlMap& map, const std::string& name) {
  WalkTestSpec spec;
  spec.name = name;
  const auto standard = map.choice<std::optional<WalkStandard>>(
      "standard", std::nullopt,
      words_of<std::optional<WalkStandard>, WalkStandard>(field_of<&WalkTestSpec::standard>()));
  if (standard) spec = walk_test_after(*standard);
  spec.name = map.text("name", spec.name);
  spec.sensing = read_sensing(map.child("sensing"), map.faults());
  read_numbers_of<&WalkTestSpec::spacing_m, &WalkTestSpec::seed>(map, spec);
  if (const auto node = map.child("person")) {
    YamlMap person(*node, map.faults(), "person");
    read_numbers(person, spec.person);
    person.finish();
  }
  bool is_path_given = false;
  read_part(map, "major_motion", spec.major, [&](YamlMap& own) {
    read_major(own, spec);
    is_path_given = own.has("path_m");
  });
  read_part(map, "minor_motion", spec.minor, [&](YamlMap& own) { read_minor(own, spec); });
  constexpr double largest_cell_m = 0.9144 + 1e-9;
  if (standard && spec.spacing_m > largest_cell_m)
    map.faults().error(map.where("spacing_m"), "spacing_m: a cell of NEMA WD 7 has sides of at most 3 ft (0.9144 m)");
  if (standard && !is_path_given) fit_path(map, spec);
  spec.effects = read_survey_effects(map);
  return spec;
}

}  // namespace

WalkTestSpec read_walk_test(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_versioned(YamlNode::load(read_input(file), overrides), "walk test", "pirsim_walk_test",
                        [&](YamlMap& map) { return read(map, stem_of_input(file)); });
}

WalkTestSpec read_walk_test(WalkStandard standard, std::span<const std::string> overrides) {
  const std::string word(word_of(standard)), text = "pirsim_walk_test: 1\nstandard: " + word + "\n";
  return read_versioned(YamlNode::parse(text, "--standard " + word, overrides), "walk test", "pirsim_walk_test",
                        [&](YamlMap& map) { return read(map, word); });
}

}  // namespace pirsim::io
