// Reads the keys of one YAML map with their types and defaults, and refuses the keys that nobody asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/read/yaml_node.hpp"
#include "schema/limits.hpp"

namespace pirsim::io {

/// Use: construct, read every key that the format knows, call finish(). Faults go to `faults` with their place; a
/// getter then returns its default (of a required key: some value of the right type) so that reading goes on.
class YamlMap {
 public:
  /// what: names the map in messages, "person". Anything but a map is a fault; an empty node is an empty map.
  YamlMap(YamlNode node, Diagnostics& faults, std::string what);

  [[nodiscard]] Where where() const { return node_.where(); }
  [[nodiscard]] Where where(const std::string& key) const;  ///< of the value, or of the map if it isn't there
  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] Diagnostics& faults() const { return *faults_; }
  [[nodiscard]] std::string label(const std::string& key) const;  ///< "person: stature_m"

  [[nodiscard]] double number(const std::string& key, double otherwise, NumberRange range = {});
  [[nodiscard]] double required_number(const std::string& key, NumberRange range = {});
  [[nodiscard]] std::optional<double> optional_number(const std::string& key, NumberRange range = {});
  [[nodiscard]] int integer(const std::string& key, int otherwise, IntegerRange range = {});
  [[nodiscard]] int required_integer(const std::string& key, IntegerRange range = {});
  [[nodiscard]] std::uint64_t unsigned_integer(const std::string& key, std::uint64_t otherwise);  ///< up to 2^63 - 1
  [[nodiscard]] bool flag(const std::string& key, bool otherwise);
  [[nodiscard]] std::string text(const std::string& key, std::string otherwise = {});
  [[nodiscard]] std::string prose(const std::string& key, std::string otherwise = {});  ///< of several lines
  [[nodiscard]] std::string required_text(const std::string& key);                      ///< and not empty

  /// One of several names, each standing for a value: `choice("way", Way::find, {{"find", Way::find}, ...})`.
  template <typename Value>
  [[nodiscard]] Value choice(const std::string& key, Value otherwise,
                             const std::vector<std::pair<std::string, Value>>& names) {
    const std::optional<YamlNode> node = child(key);
    if (!node) return otherwise;
    std::vector<std::string> list;
    for (const auto& [name, value] : names) list.push_back(name);
    const std::optional<std::size_t> index = node->choice(*faults_, label(key), list);
    return index ? names[*index].second : otherwise;
  }

  // Lists. One of more than `most` items is a fault, and empty: it is counted before anything is made of it.

  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::vector<double> otherwise,
                                            NumberRange range = {});
  /// A list of exactly `size` numbers, such as a point; zeros after a fault.
  [[nodiscard]] std::vector<double> required_numbers(const std::string& key, std::size_t size, NumberRange range = {});
  [[nodiscard]] std::vector<std::string> texts(const std::string& key, std::vector<std::string> otherwise = {});

  [[nodiscard]] std::optional<YamlNode> child(const std::string& key);
  [[nodiscard]] YamlNode required_child(const std::string& key);  ///< an empty node if it isn't there
  /// Items of a list; none if the key isn't there or has no value.
  [[nodiscard]] std::vector<YamlNode> list(const std::string& key, std::size_t most = limits::list_entries);
  /// And not empty.
  [[nodiscard]] std::vector<YamlNode> required_list(const std::string& key, std::size_t most = limits::list_entries);

  /// Reports the key if it isn't there.
  void require(const std::string& key);

  /// The keys that were asked for so far, present or not.
  [[nodiscard]] const std::vector<std::string>& asked() const noexcept { return asked_; }
  /// Call when every known key was asked for, present or not: reports the others.
  void finish() const;

 private:
  [[nodiscard]] std::optional<YamlNode> find(const std::string& key) const;
  void report_missing(const std::string& key) const;

  YamlNode node_;
  Diagnostics* faults_;
  std::string what_;
  std::vector<std::string> asked_;  ///< in the order of asking, without repetition
};

/// What is said of a list that is too long: "more than 1000 actions".
[[nodiscard]] std::string too_many(std::size_t most, const std::string& what);
/// Items of a list of at most so many; none after a fault.
[[nodiscard]] std::vector<YamlNode> read_list(const YamlNode& node, Diagnostics& faults, const std::string& what,
                                              std::size_t most = limits::list_entries);
/// A list's items as numbers; see YamlNode::number.
[[nodiscard]] std::vector<double> read_numbers(const YamlNode& node, Diagnostics& faults, std::string_view what,
                                               NumberRange range = {});

}  // namespace pirsim::io
