// Parts of scripts, studies and sensor files, each read by one function. Private to io.
#pragma once

#include <algorithm>
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

#include "files/read/yaml.hpp"
#include "model/schema/checks.hpp"
#include "model/schema/clock.hpp"
#include "model/schema/fields.hpp"
#include "pirsim/io.hpp"
#include "pirsim/schedule.hpp"
#include "pirsim/script.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::io {

/// "08:30", as hours.
[[nodiscard]] double read_hours(YamlMap& map, const std::string& key, double otherwise);

/// What a file may give as a number or as [least, most], of which one is drawn.
template <typename Value>
concept DrawnNumber = requires(Value value) {
  value.least;
  value.most;
};
template <typename Ends, typename Range>
void read_ends(YamlMap& map, const std::string& key, Ends& ends, const Range& range) {
  const std::optional<YamlNode> node = map.child(key);
  if (!node) return;
  const auto read_one = [&](const YamlNode& one) {
    if constexpr (std::same_as<Range, IntegerRange>) {
      return static_cast<int>(one.integer(map.faults(), map.label(key), range));
    } else {
      return one.number(map.faults(), map.label(key), range);
    }
  };
  if (node->is_scalar()) {
    ends.least = ends.most = read_one(*node);
    return;
  }
  const std::vector<YamlNode> items = node->items();
  if (!node->is_list() || items.size() != 2)
    return map.faults().error(node->where(), map.label(key) + ": expected a number, or [least, most]");
  ends = {read_one(items[0]), read_one(items[1])};
  if (ends.most < ends.least) {
    map.faults().error(items[1].where(), map.label(key) + ": the second number is less than the first");
    ends.most = ends.least;
  }
}

template <typename Ends, typename Range>
void read_optional_ends(YamlMap& map, const std::string& key, std::optional<Ends>& ends, const Range& range) {
  if (!map.child(key)) return;
  read_ends(map, key, ends.emplace(), range);
}

/// Reads one number; what isn't there keeps its value.
template <typename Spec, typename Value, typename Range>
void read_number(YamlMap& map, Spec& spec, const Field<Spec, Value, Range>& field) {
  Value& value = spec.*field.member;
  const std::string key = key_of(field);
  const auto range = range_of(field, std::as_const(spec));
  if constexpr (std::same_as<Range, TimeOfDay>) {
    if (map.child(key)) value = read_hours(map, key, std::optional<double>(value).value_or(0.0));
  } else if constexpr (std::same_as<Value, double>) {
    value = map.number(key, value, range);
  } else if constexpr (std::same_as<Value, std::vector<double>>) {
    value = map.numbers(key, value, range);
  } else if constexpr (DrawnNumber<Value>) {
    read_ends(map, key, value, range);
  } else if constexpr (requires { requires DrawnNumber<typename Value::value_type>; }) {
    read_optional_ends(map, key, value, range);
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
}
/// Reads what is there of a spec's numbers and times of day.
template <typename Spec>
void read_numbers(YamlMap& map, Spec& spec) {
  each_field<Spec>([&](const auto& field) {
    using F = std::remove_cvref_t<decltype(field)>;
    if constexpr (NumberField<F> || TimeField<F>) read_number(map, spec, field);
  });
}

/// The words that a field may have, and what they stand for: a value of the enumeration, or an optional one.
template <typename Value, typename Enum, typename Spec, typename Given, typename Range>
[[nodiscard]] std::vector<std::pair<std::string, Value>> words_of(const Field<Spec, Given, Range>& field) {
  std::vector<std::pair<std::string, Value>> words;
  if constexpr (std::same_as<Range, Unbounded>) {
    for (const auto& [word, value] : Words<Enum>::all) words.emplace_back(word, value);
  } else {
    for (const Enum value : field.range) words.emplace_back(word_of(value), value);
  }
  return words;
}
/// Reads a list of words, or a lone one, if it is there; an empty list is a fault where it isn't the default.
template <typename Enum, typename Spec, typename Range>
void read_words(YamlMap& map, std::vector<Enum>& value, const Field<Spec, std::vector<Enum>, Range>& field) {
  const std::optional<YamlNode> node = map.child(field.name);
  if (!node) return;
  std::vector<std::string> words;
  const auto known = words_of<Enum, Enum>(field);
  for (const auto& [word, meant] : known) words.push_back(word);
  const std::vector<YamlNode> items = node->is_scalar() ? std::vector{*node}
                                      : value.empty()   ? map.list(field.name)
                                                        : map.required_list(field.name);
  value.clear();
  for (const YamlNode& item : items) {
    const auto at = item.choice(map.faults(), map.label(field.name), words);
    if (!at) continue;
    if (std::ranges::find(value, known[*at].second) != value.end())
      map.faults().error(item.where(), map.label(field.name) + ": '" + known[*at].first + "' is named twice");
    value.push_back(known[*at].second);
  }
}
/// Reads every field whose form is plain: words, lists of names, numbers, times of day. What isn't there keeps its
/// value. Numbers come last, since how many names there are may bound them.
template <typename Spec>
void read_fields(YamlMap& map, Spec& spec) {
  each_field<Spec>([&](const auto& field) {
    if (field.use == Use::reader) return;
    auto& value = spec.*field.member;
    using Value = std::remove_reference_t<decltype(value)>;
    if constexpr (Worded<Value>) {
      value = map.choice<Value>(field.name, value, words_of<Value, Value>(field));
    } else if constexpr (std::same_as<Value, std::vector<std::string>>) {
      value = map.texts(field.name, value);
    } else if constexpr (requires {
                           requires Worded<typename Value::value_type>;
                           value.push_back({});
                         }) {
      read_words(map, value, field);
    } else if constexpr (requires {
                           requires Worded<typename Value::value_type>;
                           value.has_value();
                         }) {
      value = map.choice<Value>(field.name, value, words_of<Value, typename Value::value_type>(field));
    }
  });
  read_numbers(map, spec);
}
/// Reads the map `key` into a part of a spec, if it is there; `also` reads or checks the rest of the map.
template <typename Spec, typename Also>
void read_part(YamlMap& above, const std::string& key, Spec& part, const Also& also) {
  const std::optional<YamlNode> node = above.child(key);
  if (!node) return;
  YamlMap map(*node, above.faults(), key);
  read_fields(map, part);
  also(map);
  map.finish();
}
template <typename Spec>
void read_part(YamlMap& above, const std::string& key, Spec& part) {
  read_part(above, key, part, [](YamlMap&) {});
}
template <typename Spec>
void read_part(YamlMap& above, const std::string& key, std::optional<Spec>& part) {
  if (above.child(key)) read_part(above, key, part.emplace());
}
/// Takes the faults of check_together() to the keys of a map: "amplifier: expected high_hz above low_hz".
[[nodiscard]] inline TellFault faults_of(const YamlMap& map, const std::string& what) {
  return [&map, what](std::string_view field, const std::string& message) {
    map.faults().error(map.where(std::string(field)), what + ": " + message);
  };
}
/// Tells faults of a map with the field itself in front: "bare: no part ...".
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
  std::optional<double> day_s = {};  ///< where every run is another day: how much of each is simulated
};

/// `- sit: S1`, with `at_s` or `at`, and `phase`, beside the action where wanted; `- rise` alone may be a plain word.
[[nodiscard]] ScriptedAction read_action(const YamlNode& node, const ScriptTime& time, Diagnostics& faults);

// When a script's people are there: its `schedule`, its `occupancy`, or its `begin`.

[[nodiscard]] std::optional<ScheduleSpec> read_schedule(const std::optional<YamlNode>& node, Diagnostics& faults);
/// What `at` refers to. Without faults so far, by the trial that all others are like.
[[nodiscard]] ScriptTime time_of(const ScriptSpec& script, const TrialSpec& trial, const Diagnostics& faults);

}  // namespace pirsim::io

namespace pirsim::io::detail {

/// The files that an input may name.
struct FilesBeside {
  std::filesystem::path folder;  ///< where the input lies
  std::span<const std::filesystem::path> data_directories{};

  [[nodiscard]] NamedFile find(const std::string& file, DataKind kind) const {
    return find_beside(folder, file, kind, data_directories);
  }
};

// Bodies as glTF meshes, one a part.

/// Reads each file once, however many people wear it.
class BodyMeshReader {
 public:
  explicit BodyMeshReader(FilesBeside beside) : beside_(std::move(beside)) {}

  /// The mesh of every node that has one; a node's name is its part's, a node's frame is its part's frame. Faults of
  /// the file go to `faults` with their place in it; a missing file is a fault at `where`.
  [[nodiscard]] BodyMeshes read(const std::string& file, const Where& where, Diagnostics& faults);
  [[nodiscard]] const std::vector<InputFile>& files() const noexcept { return files_; }  ///< all that was read

 private:
  FilesBeside beside_;
  std::map<std::string, BodyMeshes> known_;
  std::vector<InputFile> files_;
};

// Who is there by data.

class OccupancyReader {
 public:
  explicit OccupancyReader(FilesBeside beside) : beside_(std::move(beside)) {}

  /// Faults of the data go to `faults` with their place in the file. begin: the script's.
  [[nodiscard]] std::optional<OccupancySpec> read(const std::optional<YamlNode>& node, const std::string& begin,
                                                  Diagnostics& faults);
  [[nodiscard]] const std::vector<InputFile>& files() const noexcept { return files_; }  ///< all that was read

 private:
  FilesBeside beside_;
  std::vector<InputFile> files_;
};

}  // namespace pirsim::io::detail

namespace pirsim::io {

/// Those keys of a sensor file's element, amplifier and comparator that need a source.
[[nodiscard]] std::vector<std::string> sourced_detector_keys();

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
  [[nodiscard]] std::vector<std::string> names() const;  ///< of all models, sorted, each once
  /// The model that a product carries, by its name (SensorModelSpec::names) or the model's, however it is spelt; or "".
  [[nodiscard]] std::string carrier(const std::string& product) const;
  [[nodiscard]] std::string unknown(const std::string& model) const;  ///< what to say of one that isn't found

 private:
  std::vector<std::filesystem::path> folders_;
};

}  // namespace pirsim::io::detail
