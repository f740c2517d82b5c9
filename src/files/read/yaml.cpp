#include "files/read/yaml.hpp"

#include <yaml-cpp/emitter.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "files/disk/file.hpp"
#include "model/core/text.hpp"
#include "model/schema/limits.hpp"

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

/// Leaves out what was told at that place in these words.
void take_back(Diagnostics& faults, const Where& where, const std::string& message) {
  Diagnostics kept;
  for (const Issue& issue : faults.issues()) {
    if (issue.where == where && issue.message == message) continue;
    issue.severity == Severity::error ? kept.error(issue.where, issue.message)
                                      : kept.warning(issue.where, issue.message);
  }
  faults = std::move(kept);
}

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

class TreeBuilder final : public YAML::EventHandler {
 public:
  explicit TreeBuilder(const std::string& file) : file_(std::make_shared<const std::string>(file)) {}

  [[nodiscard]] YamlTreePtr root() const { return root_; }
  [[nodiscard]] const Diagnostics& faults() const { return faults_; }
  [[nodiscard]] YamlPlace place(const YAML::Mark& mark) const {
    if (mark.is_null()) return {file_, 0, 0};
    return {file_, mark.line + 1, mark.column + 1};  // yaml-cpp counts from 0
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (std::exchange(started_, true)) refuse(mark, "a second document; expected one per file");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_as_key(mark);
    add({YamlTree::Kind::null, place(mark), {}, {}, {}}, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_as_key(mark);
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) refuse(mark, "an alias that refers to itself");
    attach(found->second);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_unknown(tag, mark);
    if (expects_key()) {
      refuse_invisible(mark, value, Lines::one);
      return add_key(mark, value);
    }
    refuse_invisible(mark, value, Lines::many);
    add({YamlTree::Kind::scalar, place(mark), value, {}, {}}, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    refuse_unknown(tag, mark);
    open(YamlTree::Kind::list, mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    refuse_unknown(tag, mark);
    open(YamlTree::Kind::map, mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YamlTree tree;
    YAML::anchor_t anchor = 0;
    std::map<std::string, YamlPlace> names;  ///< keys so far
  };

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& message) const {
    throw Error(ErrorCode::input, place(mark).where(), message);
  }
  [[nodiscard]] bool expects_key() const {
    return !open_.empty() && open_.back().tree.kind == YamlTree::Kind::map &&
           open_.back().tree.keys.size() == open_.back().tree.children.size();
  }
  void refuse_as_key(const YAML::Mark& mark) const {
    // yaml-cpp takes a bracket that is never closed for a key.
    if (expects_key()) refuse(mark, "expected a name as key (is a bracket left open?)");
  }
  /// `!3` is a tag and an empty value, which somebody who writes it seldom means. Standard tags say what pirsim expects
  /// anyway; `?` and `!` are what yaml-cpp says of values without one.
  void refuse_unknown(const std::string& tag, const YAML::Mark& mark) const {
    if (tag.empty() || tag == "?" || tag == "!" || tag.starts_with("tag:yaml.org,2002:")) return;
    refuse(mark, "the tag '" + tag + "' isn't known (a text that begins with ! stands in quotes)");
  }
  /// Names go to rows, pages and terminals; a text of several lines may still be a description.
  void refuse_invisible(const YAML::Mark& mark, const std::string& value, Lines lines) const {
    if (const std::string found = invisible_character(value, lines); !found.empty())
      refuse(mark, "'" + value + "' contains " + found);
  }
  void add_key(const YAML::Mark& mark, const std::string& name) {
    Open& map = open_.back();
    const auto [first, is_new] = map.names.emplace(name, place(mark));
    if (!is_new) {
      faults_.error(place(mark).where(),
                    "key '" + name + "' appears twice (first in line " + std::to_string(first->second.line) + ")");
    }
    map.tree.keys.push_back({name, place(mark)});
  }
  void open(YamlTree::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    refuse_as_key(mark);
    if (open_.size() >= limits::yaml_levels)
      refuse(mark, "nested more than " + std::to_string(limits::yaml_levels) + " levels deep");
    open_.push_back({{kind, place(mark), {}, {}, {}}, anchor, {}});
  }
  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    add(std::move(done.tree), done.anchor);
  }
  void add(YamlTree tree, YAML::anchor_t anchor) {
    auto node = std::make_shared<const YamlTree>(std::move(tree));
    if (anchor != 0) anchors_[anchor] = node;
    attach(std::move(node));
  }
  void attach(YamlTreePtr node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    YamlTree& parent = open_.back().tree;
    parent.expanded_nodes += node->expanded_nodes;
    if (parent.expanded_nodes > limits::yaml_values) {
      throw Error(ErrorCode::input, parent.place.where(),
                  "more than " + std::to_string(limits::yaml_values) + " values once aliases are followed");
    }
    parent.children.push_back(std::move(node));
  }

  std::shared_ptr<const std::string> file_;
  bool started_ = false;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, YamlTreePtr> anchors_;
  YamlTreePtr root_;
  Diagnostics faults_;
};

/// What usually lies behind a fault whose name says little.
std::string advice(const std::string& fault) {
  for (const char* often : {YAML::ErrorMsg::END_OF_MAP, YAML::ErrorMsg::END_OF_SEQ, YAML::ErrorMsg::MAP_VALUE,
                            YAML::ErrorMsg::BLOCK_ENTRY}) {
    if (fault == often) return "; check the indentation, here and above";
  }
  return {};
}

enum class Below { maps, list };

void emit(YAML::Emitter& out, const YamlTree& tree, Below below) {
  switch (tree.kind) {
    case YamlTree::Kind::null:
      out << YAML::Null;
      return;
    case YamlTree::Kind::scalar:
      out << tree.scalar;
      return;
    case YamlTree::Kind::list:
      // A list of maps takes a line an item, and each item is whole on it.
      out << (below == Below::list ? YAML::Flow : YAML::Block) << YAML::BeginSeq;
      for (const YamlTreePtr& child : tree.children) emit(out, *child, Below::list);
      out << YAML::EndSeq;
      return;
    case YamlTree::Kind::map:
      out << (below == Below::list ? YAML::Flow : YAML::Block) << YAML::BeginMap;
      for (std::size_t i = 0; i < tree.keys.size(); ++i) {
        out << YAML::Key << tree.keys[i].name << YAML::Value;
        emit(out, *tree.children[i], below);
      }
      out << YAML::EndMap;
      return;
  }
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

YamlMap::YamlMap(YamlNode node, Diagnostics& faults, std::string what)
    : node_(std::move(node)), faults_(&faults), what_(std::move(what)) {
  if (!node_.is_map() && !node_.is_null()) faults.error(node_.where(), what_ + ": expected a map of keys and values");
}

Where YamlMap::where(const std::string& key) const {
  const std::optional<YamlNode> node = find(key);
  return node ? node->where() : where();
}
bool YamlMap::has(const std::string& key) const { return find(key).has_value(); }

std::string YamlMap::label(const std::string& key) const { return what_ + ": " + key; }

std::optional<YamlNode> YamlMap::find(const std::string& key) const { return node_.value_of(key); }

std::optional<YamlNode> YamlMap::child(const std::string& key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
  return find(key);
}
void YamlMap::require(const std::string& key) {
  if (!child(key)) report_missing(key);
}
void YamlMap::report_missing(const std::string& key) const {
  if (node_.is_map() || node_.is_null()) faults_->error(where(), what_ + ": '" + key + "' is missing");
}
YamlNode YamlMap::required_child(const std::string& key) {
  if (std::optional<YamlNode> node = child(key)) return *node;
  report_missing(key);
  return YamlNode(std::make_shared<const YamlTree>());
}

double YamlMap::number(const std::string& key, double otherwise, NumberRange range) {
  return optional_number(key, range).value_or(otherwise);
}
double YamlMap::required_number(const std::string& key, NumberRange range) {
  if (const std::optional<double> value = optional_number(key, range)) return *value;
  report_missing(key);
  return 0.0;
}
std::optional<double> YamlMap::optional_number(const std::string& key, NumberRange range) {
  const std::optional<YamlNode> node = child(key);
  if (!node) return std::nullopt;
  return node->number(*faults_, label(key), range);
}
int YamlMap::integer(const std::string& key, int otherwise, IntegerRange range) {
  const std::optional<YamlNode> node = child(key);
  return node ? static_cast<int>(node->integer(*faults_, label(key), range)) : otherwise;
}
int YamlMap::required_integer(const std::string& key, IntegerRange range) {
  if (!has(key)) report_missing(key);
  return integer(key, 0, range);
}
std::uint64_t YamlMap::unsigned_integer(const std::string& key, std::uint64_t otherwise) {
  const std::optional<YamlNode> node = child(key);
  if (!node) return otherwise;
  return static_cast<std::uint64_t>(
      node->integer(*faults_, label(key), {.min = 0, .max = std::numeric_limits<long long>::max()}));
}
bool YamlMap::flag(const std::string& key, bool otherwise) {
  const std::optional<YamlNode> node = child(key);
  return node ? node->flag(*faults_, label(key)) : otherwise;
}
std::string YamlMap::text(const std::string& key, std::string otherwise) {
  const std::optional<YamlNode> node = child(key);
  return node ? node->text(*faults_, label(key)) : otherwise;
}
std::string YamlMap::prose(const std::string& key, std::string otherwise) {
  const std::optional<YamlNode> node = child(key);
  return node ? node->prose(*faults_, label(key)) : otherwise;
}
std::string YamlMap::required_text(const std::string& key) {
  const std::optional<YamlNode> node = child(key);
  if (!node) {
    report_missing(key);
    return {};
  }
  std::string value = node->text(*faults_, label(key));
  if (node->is_scalar() && value.empty())
    faults_->error(node->where(), label(key) + ": expected a text that isn't empty");
  return value;
}

std::vector<double> YamlMap::numbers(const std::string& key, std::vector<double> otherwise, NumberRange range) {
  const std::optional<YamlNode> node = child(key);
  if (!node) return otherwise;
  if (node->is_scalar()) return {node->number(*faults_, label(key), range)};
  return read_numbers(*node, *faults_, label(key), range);
}
std::vector<double> YamlMap::required_numbers(const std::string& key, std::size_t size, NumberRange range) {
  const std::optional<YamlNode> node = child(key);
  if (!node) {
    report_missing(key);
    return std::vector<double>(size, 0.0);
  }
  std::vector<double> values = read_numbers(*node, *faults_, label(key), range);
  if (node->is_list() && values.size() != size) {
    faults_->error(node->where(), label(key) + ": expected " + std::to_string(size) + " numbers, got " +
                                      std::to_string(values.size()));
  }
  values.resize(size, 0.0);
  return values;
}
std::vector<std::string> YamlMap::texts(const std::string& key, std::vector<std::string> otherwise) {
  const std::optional<YamlNode> node = child(key);
  if (!node) return otherwise;
  if (node->is_scalar()) return {node->text(*faults_, label(key))};
  std::vector<std::string> values;
  for (const YamlNode& item : list(key)) {
    values.push_back(item.text(*faults_, label(key)));
    if (std::ranges::find(values.begin(), values.end() - 1, values.back()) == values.end() - 1) continue;
    faults_->error(item.where(), label(key) + ": '" + values.back() + "' is named twice");
  }
  return values;
}

std::vector<YamlNode> YamlMap::list(const std::string& key, std::size_t most) {
  const std::optional<YamlNode> node = child(key);
  if (!node || node->is_null()) return {};
  return read_list(*node, *faults_, label(key), most);
}
std::vector<YamlNode> YamlMap::required_list(const std::string& key, std::size_t most) {
  const std::optional<YamlNode> node = child(key);
  if (!node) {
    report_missing(key);
    return {};
  }
  if (node->is_null() || (node->is_list() && node->n_items() == 0)) {
    faults_->error(node->where(), label(key) + ": expected a list that isn't empty");
  }
  return list(key, most);
}

void YamlMap::finish() const {
  for (const YamlKey& key : node_.keys()) {
    if (std::find(asked_.begin(), asked_.end(), key.name) != asked_.end()) continue;
    const std::string meant = did_you_mean(key.name, asked_);
    for (const std::string& asked : asked_) {  // the key that is meant is misspelt, and not missing as well
      if (!meant.empty() && did_you_mean(key.name, {asked}) == meant)
        take_back(*faults_, where(), what_ + ": '" + asked + "' is missing");
    }
    faults_->error(key.where, what_ + ": unknown key '" + key.name + "'" + meant);
  }
  const bool is_root = !asked_.empty() && asked_.front().starts_with("pirsim_");
  if (is_root) bring_home();
}

/// Says of keys that nothing knows where they stand that this map, a file's outermost, has such a key.
void YamlMap::bring_home() const {
  constexpr std::string_view unknown = ": unknown key '";
  Diagnostics told;
  for (const auto& [severity, where, message] : faults_->issues()) {
    std::string text = message;
    if (const std::size_t at = text.find(unknown); at != std::string::npos && text.substr(0, at) != what_) {
      const std::string key = text.substr(at + unknown.size(), text.size() - at - unknown.size() - 1);
      if (std::ranges::find(asked_, key) != asked_.end() && !has(key))
        text += ": it belongs to the " + what_ + " itself, at the left margin";
    }
    severity == Severity::error ? told.error(where, text) : told.warning(where, text);
  }
  *faults_ = std::move(told);
}

std::string too_many(std::size_t most, const std::string& what) {
  return "more than " + std::to_string(most) + ' ' + what;
}

std::vector<YamlNode> read_list(const YamlNode& node, Diagnostics& faults, const std::string& what, std::size_t most) {
  if (!node.is_list()) {
    faults.error(node.where(), what + ": expected a list");
    return {};
  }
  if (node.n_items() <= most) return node.items();
  faults.error(node.where(), what + ": " + too_many(most, "entries") + ", namely " + std::to_string(node.n_items()));
  return {};
}

std::vector<double> read_numbers(const YamlNode& node, Diagnostics& faults, std::string_view what, NumberRange range) {
  if (!node.is_list()) {
    faults.error(node.where(), std::string(what) + ": expected a list of numbers");
    return {};
  }
  std::vector<double> values;
  for (const YamlNode& item : read_list(node, faults, std::string(what)))
    values.push_back(item.number(faults, what, range));
  return values;
}

// `--set a.b.0.c=value`: one node of a tree replaced.

YamlTreePtr apply_override(const YamlTreePtr& root, const std::string& override_text) {
  return replaced(root, parse_override(override_text), 0);
}

// yaml-cpp's events to a tree. Its own node type is not used: it drops repeated keys without a word and hides how
// large a document becomes when aliases are followed.

YamlTreePtr parse_yaml_tree(std::string_view text, const std::string& file) {
  TreeBuilder builder(file);
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& fault) {
    throw Error(ErrorCode::input, builder.place(fault.mark).where(), "not YAML: " + fault.msg + advice(fault.msg));
  }
  builder.faults().throw_if_errors();
  if (builder.root() != nullptr) return builder.root();
  auto empty = std::make_shared<YamlTree>();
  empty->place = builder.place({});
  return empty;
}

std::string YamlNode::to_yaml() const {
  YAML::Emitter out;
  emit(out, *tree_, Below::maps);
  return std::string(out.c_str()) + '\n';
}

}  // namespace pirsim::io
