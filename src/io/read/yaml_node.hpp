// YAML as an immutable tree in which every node knows its place. The only door to yaml-cpp.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/range.hpp"
#include "io/files/input.hpp"
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

}  // namespace pirsim::io
