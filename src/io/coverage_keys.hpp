// What the readers of coverage studies, walk tests and placements share. Private to io.
#pragma once

#include <string>

#include "io/yaml_map.hpp"
#include "pirsim/survey.hpp"

namespace pirsim::io {

/// A top-level format version, which has to be 1.
void check_version(YamlMap& map, const std::string& key);
/// `seed` and `effects` of any survey.
void read_seed_and_effects(YamlMap& map, std::uint64_t& seed, std::vector<EffectSpec>& effects);
/// sensing, spacing_m, duration_s, without, target, seed and effects.
void read_coverage_keys(YamlMap& map, CoverageSpec& spec);

}  // namespace pirsim::io
