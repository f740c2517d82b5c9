// `--set a.b.0.c=value`: one node of a tree replaced.
#include <algorithm>
#include <optional>

#include "io/files/atomic_file.hpp"
#include "io/read/yaml_node.hpp"

namespace pirsim::io {
namespace {

struct Override {
  Where where;  ///< names the whole option
  std::vector<std::string> path;
  YamlTreePtr value;
};

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// Gives every node of a parsed value the option as its place.
YamlTreePtr relocated(const YamlTreePtr& tree, const YamlPlace& place) {
  auto copy = std::make_shared<YamlTree>(*tree);
  copy->place = place;
  for (YamlTreeKey& key : copy->keys) key.place = place;
  for (YamlTreePtr& child : copy->children) child = relocated(child, place);
  return copy;
}

Override parse_override(const std::string& text) {
  const YamlPlace place{std::make_shared<const std::string>("--set " + text), 0, 0};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw Error(ErrorCode::usage, place.where(), "expected key.key=value");
  std::vector<std::string> path = split(std::string_view(text).substr(0, equals), '.');
  if (std::find(path.begin(), path.end(), std::string{}) != path.end()) {
    throw Error(ErrorCode::usage, place.where(), "expected key.key=value: a key is empty");
  }
  try {
    const std::string value_text = text_from(text.substr(equals + 1), *place.file);
    const YamlTreePtr value = parse_yaml_tree(value_text, *place.file);
    return {place.where(), std::move(path), relocated(value, place)};
  } catch (const Error& fault) {
    throw Error(ErrorCode::usage, place.where(), fault.issues().front().message);
  }
}

std::size_t list_index(const std::string& text, std::size_t size, const Where& where) {
  const std::optional<std::size_t> index = parse_number<std::size_t>(text);
  if (!index || *index > size) {
    throw Error(ErrorCode::usage, where,
                "'" + text + "' is not an index of this list of " + std::to_string(size) + ", which count from 0 (" +
                    std::to_string(size) + " adds one)");
  }
  return *index;
}

void count_values(YamlTree& tree) {
  tree.expanded_nodes = 1;
  for (const YamlTreePtr& child : tree.children) tree.expanded_nodes += child->expanded_nodes;
}

YamlTreePtr replaced(const YamlTreePtr& tree, const Override& change, std::size_t depth) {
  if (depth == change.path.size()) return change.value;
  const std::string& name = change.path[depth];
  auto copy = std::make_shared<YamlTree>(*tree);
  if (tree->kind == YamlTree::Kind::scalar) {
    throw Error(ErrorCode::usage, change.where, "nothing can be set below the value '" + tree->scalar + "'");
  }
  if (tree->kind == YamlTree::Kind::list) {
    const std::size_t index = list_index(name, tree->children.size(), change.where);
    if (index == tree->children.size()) {
      auto empty = std::make_shared<YamlTree>();
      empty->place = change.value->place;
      copy->children.push_back(std::move(empty));
    }
    YamlTreePtr& child = copy->children[index];
    child = replaced(child, change, depth + 1);
    count_values(*copy);
    return copy;
  }
  copy->kind = YamlTree::Kind::map;  // of an empty node
  const auto key = std::find_if(copy->keys.begin(), copy->keys.end(), [&](const auto& k) { return k.name == name; });
  if (key != copy->keys.end()) {
    YamlTreePtr& child = copy->children[static_cast<std::size_t>(key - copy->keys.begin())];
    child = replaced(child, change, depth + 1);
    count_values(*copy);
    return copy;
  }
  auto empty = std::make_shared<YamlTree>();
  empty->place = change.value->place;
  copy->keys.push_back({name, change.value->place});
  copy->children.push_back(replaced(empty, change, depth + 1));
  count_values(*copy);
  return copy;
}

}  // namespace

YamlTreePtr apply_override(const YamlTreePtr& root, const std::string& override_text) {
  return replaced(root, parse_override(override_text), 0);
}

}  // namespace pirsim::io
