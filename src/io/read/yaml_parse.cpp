// yaml-cpp's events to a tree. Its own node type is not used: it drops repeated keys without a word and hides how
// large a document becomes when aliases are followed.
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <map>
#include <sstream>
#include <utility>

#include "core/text.hpp"
#include "io/read/yaml_node.hpp"
#include "schema/limits.hpp"

namespace pirsim::io {
namespace {

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

}  // namespace

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

}  // namespace pirsim::io
