// Who lives in a home of a recipe: read as ranges, drawn once a home.
#pragma once

#include "io/read/yaml_map.hpp"
#include "pirsim/dataset.hpp"
#include "pirsim/random.hpp"

namespace pirsim::dataset {

/// Reads `household:` of a home.
[[nodiscard]] HouseholdRangesSpec read_household_ranges(const io::YamlNode& node, Diagnostics& faults);

/// A resident for each place to sleep that the home has.
[[nodiscard]] HouseholdSpec draw_household(const HouseholdRangesSpec& ranges, const SceneSpec& home, Stream& stream);

}  // namespace pirsim::dataset
