// YAML as an immutable tree in which every node knows its place. The only door to yaml-cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/disk/file.hpp"
#include "model/core/range.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {

/// Values of `${name}`.
using Variables = std::map<std::string, std::string, std::less<>>;

struct YamlKey {
  std::string name;
  Where where;
};
struct YamlTree;

/// A node of a YAML document; cheap to copy, keeps what it needs alive.
class YamlNode {
 public:
  explicit YamlNode(std::shared_ptr<const YamlTree> tree) : tree_(std::move(tree)) {}

  /// Reads a text with one document, within the limits of schema/limits.hpp; a map that
  /// has a key twice is refused. Each override `a.b.0.c=value` (value: YAML) then replaces or adds one node; list
  /// items are addressed by number from 0. Throws Error: io (no file), input (content), usage (an override).
  [[nodiscard]] static YamlNode load(const Input& input, std::span<const std::string> overrides = {});
  /// Reads a text from memory; `name` stands in messages.
  [[nodiscard]] static YamlNode parse(std::string_view text, const std::string& name,
                                      std::span<const std::string> overrides = {});

  [[nodiscard]] Where where() const;
  [[nodiscard]] bool is_null() const noexcept;
  [[nodiscard]] bool is_scalar() const noexcept;
  [[nodiscard]] bool is_list() const noexcept;
  [[nodiscard]] bool is_map() const noexcept;

  [[nodiscard]] std::vector<YamlNode> items() const;  ///< of a list; values of a map in file order; else empty
  [[nodiscard]] std::size_t n_items() const noexcept;
  /// Of a map: the value of a key, if it is there.
  [[nodiscard]] std::optional<YamlNode> value_of(std::string_view key) const;
  /// Of it and all below, as often as aliases repeat them.
  [[nodiscard]] std::size_t n_values() const noexcept;
  [[nodiscard]] std::vector<YamlKey> keys() const;  ///< of a map, matching items(); else empty

  /// As YAML that reads back the same, without comments: maps in block style, what lies below a list on one line.
  [[nodiscard]] std::string to_yaml() const;

  // A scalar's value. A fault is reported as "<what>: expected ..." and gives a value within the range, or "".
  [[nodiscard]] double number(Diagnostics& faults, std::string_view what, NumberRange range = {}) const;
  [[nodiscard]] long long integer(Diagnostics& faults, std::string_view what, IntegerRange range = {}) const;
  [[nodiscard]] std::string text(Diagnostics& faults, std::string_view what) const;
  [[nodiscard]] std::string prose(Diagnostics& faults, std::string_view what) const;  ///< text of several lines
  [[nodiscard]] bool flag(Diagnostics& faults, std::string_view what) const;          ///< true or false
  /// Index into `names`; none after a fault.
  [[nodiscard]] std::optional<std::size_t> choice(Diagnostics& faults, std::string_view what,
                                                  const std::vector<std::string>& names) const;

  /// This tree with every `${name}` in its scalars (not its keys) replaced; `$${` stands for a plain `${`. A
  /// name that isn't in `variables` is reported once a place and left as it is.
  [[nodiscard]] YamlNode with(const Variables& variables, Diagnostics& faults) const;

 private:
  std::shared_ptr<const YamlTree> tree_;
};

/// `text` with every `${name}` replaced; see YamlNode::with.
[[nodiscard]] std::string substitute(std::string_view text, const Variables& variables, const Where& where,
                                     Diagnostics& faults);

// Storage behind YamlNode, and what builds and edits it.

using YamlTreePtr = std::shared_ptr<const YamlTree>;

/// Where without a string of its own, since a file may have a million nodes.
struct YamlPlace {
  std::shared_ptr<const std::string> file;
  int line = 0;
  int column = 0;
  [[nodiscard]] Where where() const { return {file ? *file : std::string{}, line, column}; }
};

struct YamlTreeKey {
  std::string name;
  YamlPlace place;
};

/// Immutable; subtrees are shared where the file has aliases.
struct YamlTree {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  YamlPlace place;
  std::string scalar;
  std::vector<YamlTreeKey> keys;      ///< of a map
  std::vector<YamlTreePtr> children;  ///< items of a list, values of a map
  std::size_t expanded_nodes = 1;     ///< of the subtree, shared parts counted as often as they appear
};

/// Throws Error(input) with line and column; an empty document is a null node.
[[nodiscard]] YamlTreePtr parse_yaml_tree(std::string_view text, const std::string& file);

/// `root` with one override `a.b.0.c=value` applied. Throws Error(usage).
[[nodiscard]] YamlTreePtr apply_override(const YamlTreePtr& root, const std::string& override_text);

// Reads the keys of one YAML map with their types and defaults, and refuses the keys that nobody asked for.

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

  // Lists. One of more than `most` items is a fault, and empty: it is counted before anything is made of it. Of numbers
  // and texts one alone may stand without brackets.

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
  void bring_home() const;

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
