// Parts of scripts, studies and sensor files, each read by one function. Private to io.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/yaml_map.hpp"
#include "io/yaml_node.hpp"
#include "pirsim/io.hpp"
#include "pirsim/schedule.hpp"
#include "pirsim/script.hpp"
#include "pirsim/sensor.hpp"
#include "schema/check_specs.hpp"
#include "schema/clock.hpp"
#include "schema/fields.hpp"

namespace pirsim::io {

/// Reads what is there of the numbers of a spec that each_number() lists; the others keep their values.
template <typename Spec>
void read_numbers(YamlMap& map, Spec& spec) {
  each_number(spec, [&](const std::string& key, auto& value, const auto& range) {
    using Value = std::remove_reference_t<decltype(value)>;
    if constexpr (std::same_as<Value, double>) {
      value = map.number(key, value, range);
    } else if constexpr (std::same_as<Value, std::vector<double>>) {
      value = map.numbers(key, value, range);
    } else if constexpr (std::same_as<Value, int>) {
      value = map.integer(key, value, range);
    } else if constexpr (std::same_as<Value, std::uint64_t>) {
      value = map.unsigned_integer(key, value);
    } else if constexpr (std::same_as<Value, std::optional<double>>) {
      if (const auto given = map.optional_number(key, range)) value = given;
    } else {
      static_assert(std::same_as<Value, std::optional<int>>);
      const int given = map.integer(key, value.value_or(0), range);
      if (map.has(key)) value = given;
    }
  });
}
/// Takes the faults of check_together() to the keys of a map: "amplifier: expected high_hz above low_hz".
[[nodiscard]] inline TellFault faults_of(const YamlMap& map, const std::string& what) {
  return [&map, what](std::string_view field, const std::string& message) {
    map.faults().error(map.where(std::string(field)), what + ": " + message);
  };
}
/// The same where the field itself stands in front: "bare: no part ...".
[[nodiscard]] inline TellFault faults_by_key(const YamlMap& map) {
  return [&map](std::string_view field, const std::string& message) {
    map.faults().error(map.where(std::string(field)), std::string(field) + ": " + message);
  };
}

/// A format version at the top of a file, which has to be 1.
void check_version(YamlMap& map, const std::string& key);

// The `sensing` block, which all kinds of studies share.

[[nodiscard]] SensingSpec read_sensing(const std::optional<YamlNode>& node, Diagnostics& faults);

// `effects:` of a script.

/// Items are `name` or `name: {parameter: number, choice: text}`. What names mean is the catalogue's business.
[[nodiscard]] std::vector<EffectSpec> read_effects(const std::vector<YamlNode>& items, Diagnostics& faults);

// One entry of a person's `actions`.

/// What `at` of an action refers to.
struct ScriptTime {
  std::optional<RunClock> clock;     ///< none: the script doesn't say when a run begins
  std::optional<double> day_s = {};  ///< of a schedule: how much of each day is simulated
};

/// `- sit: S1`, with `at_s` or `at`, and `phase`, beside the action where wanted; `- rise` alone may be a plain word.
[[nodiscard]] ScriptedAction read_action(const YamlNode& node, const ScriptTime& time, Diagnostics& faults);

// When a script's people are there: its `schedule`, or its `begin`.

[[nodiscard]] std::optional<ScheduleSpec> read_schedule(const std::optional<YamlNode>& node, Diagnostics& faults);
/// Reads `begin` as well; check_together() tells what is wrong with it.
[[nodiscard]] ScriptTime read_time(YamlMap& script, const std::optional<ScheduleSpec>& schedule, ScriptSpec& spec);

}  // namespace pirsim::io

namespace pirsim::io::detail {

// Bodies as glTF meshes, one a part.

/// Reads each file once, however many people wear it.
class BodyMeshReader {
 public:
  /// folder: what file names are relative to.
  explicit BodyMeshReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The mesh of every node that has one; a node's name is its part's, a node's frame is its part's frame. Faults of
  /// the file go to `faults` with their place in it; a missing file is a fault at `where`.
  [[nodiscard]] BodyMeshes read(const std::string& file, const Where& where, Diagnostics& faults);
  [[nodiscard]] const std::vector<InputFile>& files() const noexcept { return files_; }  ///< all that was read

 private:
  std::filesystem::path folder_;
  std::map<std::string, BodyMeshes> known_;
  std::vector<InputFile> files_;
};

}  // namespace pirsim::io::detail

namespace pirsim::io {

// A sensor file's element, amplifier and comparator.

/// Reads the maps `element`, `amplifier` and `comparator` of a sensor file; what isn't there keeps its default.
[[nodiscard]] DetectorSpec read_detector(YamlMap& sensor);

/// The names of their keys that need a source.
[[nodiscard]] const std::vector<std::string>& sourced_detector_keys();

}  // namespace pirsim::io

namespace pirsim::io::detail {

// What describes a sensor model: a file, or else a text that the library carries.

struct NamedText {
  std::string_view name, text;
};
/// The models of data/sensors.
[[nodiscard]] std::span<const NamedText> shipped_sensors();

struct FoundSensor {
  SensorModelSpec model;
  std::optional<InputFile> file;  ///< none for a shipped one
  std::vector<Issue> remarks;     ///< warnings
};

/// Where sensors of a scene are looked for.
class SensorSearch {
 public:
  /// `first` of the options, then `sensors` in the scene's folder and beside it, `$PIRSIM_DATA_DIR/sensors`, the data
  /// directories of the options; last what the library carries.
  SensorSearch(const SceneOptions& options, const std::filesystem::path& scene_folder);

  /// Nothing for a name that isn't known. Throws Error (io, input) for a faulty file.
  [[nodiscard]] std::optional<FoundSensor> find(const std::string& model) const;
  [[nodiscard]] std::vector<std::string> names() const;               ///< of all models, sorted, each once
  [[nodiscard]] std::string unknown(const std::string& model) const;  ///< what to say of one that isn't found

 private:
  std::vector<std::filesystem::path> folders_;
};

}  // namespace pirsim::io::detail
