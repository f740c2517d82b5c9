// Specs as YAML: every field whose form is plain, in the order of its description. What a file leaves out (an empty
// list, an option that isn't given, the default style) isn't written.
#pragma once

#include <yaml-cpp/yaml.h>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "model/schema/fields.hpp"
#include "pirsim/csv.hpp"

namespace pirsim::io {

[[nodiscard]] inline YAML::Node number(double value) { return YAML::Node(csv_number(value)); }

/// "08:30"; times are read in minutes.
[[nodiscard]] inline std::string time_of_day(double hours) {
  const auto minutes = static_cast<int>(std::lround(60.0 * hours));
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%02d:%02d", minutes / 60, minutes % 60);
  return text.data();
}

template <Described Spec>
[[nodiscard]] YAML::Node written(const Spec& spec);

/// Nothing of what a file leaves out. plain: the field's default.
template <typename Value>
[[nodiscard]] std::optional<YAML::Node> written(const Value& value, const Value& plain) {
  if constexpr (Described<Value>) {
    return written(value);
  } else if constexpr (std::is_same_v<Value, double>) {
    return number(value);
  } else if constexpr (std::is_same_v<Value, MotionStyle>) {
    return value == plain ? std::nullopt : std::optional(YAML::Node(word_of(value)));
  } else if constexpr (Worded<Value>) {
    return YAML::Node(word_of(value));
  } else if constexpr (requires { value.has_value(); }) {
    return value ? written(*value, *value) : std::nullopt;
  } else if constexpr (requires { value.empty(); }) {
    if (value.empty() && plain.empty()) return std::nullopt;
    if constexpr (std::is_same_v<Value, std::string>) {
      return YAML::Node(value);
    } else if constexpr (requires { typename Value::mapped_type; }) {
      YAML::Node map;
      for (const auto& [key, one] : value) map[key] = *written(one, one);
      return map;
    } else {
      YAML::Node list(YAML::NodeType::Sequence);
      for (const auto& one : value) list.push_back(*written(one, one));
      if constexpr (std::is_same_v<Value, std::vector<double>>) list.SetStyle(YAML::EmitterStyle::Flow);
      return list;
    }
  } else {
    return YAML::Node(value);
  }
}

template <Described Spec>
YAML::Node written(const Spec& spec) {
  const Spec plain{};
  YAML::Node map(YAML::NodeType::Map);
  each_field<Spec>([&](const auto& field) {
    using F = std::remove_cvref_t<decltype(field)>;
    if (field.use != Use::study) return;
    const auto& value = spec.*field.member;
    if constexpr (TimeField<F>) {
      const std::optional<double> hours = value;
      if (hours) map[key_of(field)] = time_of_day(*hours);
    } else if (const auto node = written(value, plain.*field.member)) {
      map[field.name] = *node;
    }
  });
  return map;
}

/// The numbers of a spec alone.
template <Described Spec>
void write_numbers(const Spec& spec, YAML::Node& map) {
  each_number(spec, [&](const char* key, const auto& value, const auto&) {
    if (const auto node = written(value, value)) map[key] = *node;
  });
}

}  // namespace pirsim::io
