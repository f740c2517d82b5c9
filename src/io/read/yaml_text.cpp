#include <yaml-cpp/emitter.h>

#include "io/read/yaml_node.hpp"

namespace pirsim::io {
namespace {

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

std::string YamlNode::to_yaml() const {
  YAML::Emitter out;
  emit(out, *tree_, Below::maps);
  return std::string(out.c_str()) + '\n';
}

}  // namespace pirsim::io
