// What the commands that draw a room or a home have in common.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "io/read/yaml_map.hpp"
#include "pirsim/dataset.hpp"

namespace pirsim::app {

struct DrawOptions {
  std::filesystem::path recipe;  ///< or settings
  std::filesystem::path output;
  std::vector<std::string> settings;            ///< "width_m=6"
  std::map<std::string, std::string> as_typed;  ///< "--set width_m=6": "--width 6"
  std::optional<std::uint64_t> seed;            ///< default: the recipe's, or 1
  int number = 1;
  Inputs inputs;
};

/// An option that stands for a key of what is drawn.
void offer_setting(CLI::App& command, DrawOptions& options, const std::string& name, const std::string& key,
                   const std::string& value, const std::string& what);
/// The recipe and --set, --sensors, --seed, --number, -o and --quiet. what: "room".
void offer_drawing(CLI::App& command, DrawOptions& options, const std::string& what);

/// Reads the settings as a map of keys; faults name the options as they were typed.
void read_settings(const DrawOptions& options, const std::string& what, const std::function<void(io::YamlMap&)>& read);
/// The recipe, which goes without settings. Throws Error(usage) if the output is one of its inputs, and if the room of
/// that number is a file.
[[nodiscard]] dataset::RecipeSpec recipe_to_draw_from(const DrawOptions& options);
/// Throws Error(usage) for a missing output and a name that isn't of a scene.
void check_scene_output(const DrawOptions& options, const std::string& example);

/// " a b c"
[[nodiscard]] std::string listed(const std::vector<std::string>& ids);
/// " PIR1 (EKMC1601111)", one behind the other.
[[nodiscard]] std::string listed(const std::vector<SensorSpec>& sensors);

}  // namespace pirsim::app
