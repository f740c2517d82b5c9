#include "io/read/yaml_node.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/text.hpp"
#include "io/files/atomic_file.hpp"

namespace pirsim::io {
namespace {

std::string describe(const YamlTree& tree) {
  switch (tree.kind) {
    case YamlTree::Kind::null:
      return "nothing";
    case YamlTree::Kind::list:
      return "a list";
    case YamlTree::Kind::map:
      return "a map";
    case YamlTree::Kind::scalar:
      break;
  }
  return "'" + shortened(tree.scalar) + "'";
}

std::string fault_text(std::string_view what, const std::string& expected, const YamlTree& tree) {
  return std::string(what) + ": expected " + expected + ", got " + describe(tree);
}

double fallback(const NumberRange& range) {
  if (std::isfinite(range.min)) return range.min;
  if (std::isfinite(range.max)) return range.max;
  return std::isfinite(range.above) ? range.above + 1.0 : 0.0;
}

/// Shares with `tree` whatever has nothing to replace, which is most of it.
YamlTreePtr substituted(const YamlTreePtr& tree, const Variables& variables, Diagnostics& faults) {
  std::shared_ptr<YamlTree> copy;
  const auto changed = [&]() -> YamlTree& {
    if (copy == nullptr) copy = std::make_shared<YamlTree>(*tree);
    return *copy;
  };
  if (tree->scalar.find("${") != std::string::npos)
    changed().scalar = substitute(tree->scalar, variables, tree->place.where(), faults);
  for (std::size_t i = 0; i < tree->children.size(); ++i) {
    YamlTreePtr child = substituted(tree->children[i], variables, faults);
    if (child != tree->children[i]) changed().children[i] = std::move(child);
  }
  if (copy != nullptr) return copy;
  return tree;
}

void report_once(Diagnostics& faults, const Where& where, const std::string& message) {
  const auto& issues = faults.issues();
  const bool known = std::any_of(issues.begin(), issues.end(),
                                 [&](const Issue& issue) { return issue.where == where && issue.message == message; });
  if (!known) faults.error(where, message);
}

}  // namespace

YamlNode YamlNode::load(const Input& input, std::span<const std::string> overrides) {
  if (input.bytes.starts_with("glTF")) {
    throw Error(ErrorCode::input, {input.path.string()}, "this is a glTF scene: `--scene` takes it");
  }
  return parse(input.bytes, input.path.string(), overrides);
}
YamlNode YamlNode::parse(std::string_view text, const std::string& name, std::span<const std::string> overrides) {
  YamlTreePtr root = parse_yaml_tree(text_from(std::string(text), name), name);
  for (const std::string& change : overrides) root = apply_override(root, change);
  return YamlNode(std::move(root));
}

Where YamlNode::where() const { return tree_->place.where(); }
bool YamlNode::is_null() const noexcept { return tree_->kind == YamlTree::Kind::null; }
bool YamlNode::is_scalar() const noexcept { return tree_->kind == YamlTree::Kind::scalar; }
bool YamlNode::is_list() const noexcept { return tree_->kind == YamlTree::Kind::list; }
bool YamlNode::is_map() const noexcept { return tree_->kind == YamlTree::Kind::map; }

std::vector<YamlNode> YamlNode::items() const {
  std::vector<YamlNode> nodes;
  nodes.reserve(tree_->children.size());
  for (const YamlTreePtr& child : tree_->children) nodes.emplace_back(child);
  return nodes;
}
std::size_t YamlNode::n_items() const noexcept { return tree_->children.size(); }
std::size_t YamlNode::n_values() const noexcept { return tree_->expanded_nodes; }
std::optional<YamlNode> YamlNode::value_of(std::string_view key) const {
  const auto found = std::ranges::find(tree_->keys, key, &YamlTreeKey::name);
  if (found == tree_->keys.end()) return std::nullopt;
  return YamlNode(tree_->children[static_cast<std::size_t>(found - tree_->keys.begin())]);
}
std::vector<YamlKey> YamlNode::keys() const {
  std::vector<YamlKey> keys;
  keys.reserve(tree_->keys.size());
  for (const YamlTreeKey& key : tree_->keys) keys.push_back({key.name, key.place.where()});
  return keys;
}

double YamlNode::number(Diagnostics& faults, std::string_view what, NumberRange range) const {
  const std::optional<double> value = is_scalar() ? parse_number<double>(tree_->scalar) : std::nullopt;
  if (value && range.holds(*value)) return *value;
  faults.error(where(), fault_text(what, range.text(), *tree_));
  return fallback(range);
}
long long YamlNode::integer(Diagnostics& faults, std::string_view what, IntegerRange range) const {
  const std::optional<long long> value = is_scalar() ? parse_number<long long>(tree_->scalar) : std::nullopt;
  if (value && range.holds(*value)) return *value;
  faults.error(where(), fault_text(what, range.text(), *tree_));
  return range.min;
}
std::string YamlNode::text(Diagnostics& faults, std::string_view what) const {
  std::string value = prose(faults, what);
  if (const std::string fault = line_fault(value); !fault.empty())
    faults.error(where(), std::string(what) + ": " + fault);
  return value;
}
std::string YamlNode::prose(Diagnostics& faults, std::string_view what) const {
  if (is_scalar()) return tree_->scalar;
  faults.error(where(), fault_text(what, "a text", *tree_));
  return {};
}
bool YamlNode::flag(Diagnostics& faults, std::string_view what) const {
  if (is_scalar() && tree_->scalar == "true") return true;
  if (is_scalar() && tree_->scalar == "false") return false;
  faults.error(where(), fault_text(what, "true or false", *tree_));
  return false;
}
std::optional<std::size_t> YamlNode::choice(Diagnostics& faults, std::string_view what,
                                            const std::vector<std::string>& names) const {
  const auto found = is_scalar() ? std::find(names.begin(), names.end(), tree_->scalar) : names.end();
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  const std::string hint = is_scalar() ? did_you_mean(tree_->scalar, names) : std::string{};
  faults.error(where(), fault_text(what, (names.size() > 1 ? "one of " : "") + list, *tree_) + hint);
  return std::nullopt;
}

YamlNode YamlNode::with(const Variables& variables, Diagnostics& faults) const {
  return YamlNode(substituted(tree_, variables, faults));
}

std::string substitute(std::string_view text, const Variables& variables, const Where& where, Diagnostics& faults) {
  std::string result;
  while (true) {
    const std::size_t begin = text.find("${");
    if (begin == std::string_view::npos) return result.append(text);
    if (begin > 0 && text[begin - 1] == '$') {  // escaped: drop one dollar sign
      result.append(text.substr(0, begin)).append("{");
      text.remove_prefix(begin + 2);
      continue;
    }
    result.append(text.substr(0, begin));
    const std::size_t end = text.find('}', begin);
    if (end == std::string_view::npos) {
      report_once(faults, where, "'${' without its '}'");
      return result.append(text.substr(begin));
    }
    const std::string_view name = text.substr(begin + 2, end - begin - 2);
    if (const auto found = variables.find(name); found != variables.end()) {
      result += found->second;
    } else {
      std::vector<std::string> known;
      for (const auto& [key, value] : variables) known.push_back(key);
      report_once(faults, where, "'${" + std::string(name) + "}' is not defined" + did_you_mean(name, known));
      result.append(text.substr(begin, end - begin + 1));
    }
    text.remove_prefix(end + 1);
  }
}

}  // namespace pirsim::io
