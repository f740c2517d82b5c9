// Storage behind YamlNode, and what builds and edits it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/yaml_node.hpp"

namespace pirsim::io {

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
