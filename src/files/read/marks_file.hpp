// Marks beside a scene: a file that says what the nodes of a model are that is left as it is, and what else is in the
// room. Private to io.
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "files/read/gltf_geometry.hpp"
#include "files/read/scene_parts.hpp"
#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/input_file.hpp"

namespace pirsim::io::detail {

/// Nodes by their name, in which `*` stands for any text and `?` for any character.
struct NodePattern {
  std::string text;
  Where where;
  [[nodiscard]] bool matches(std::string_view name) const;
};

struct MarksFile {
  struct OfNodes {
    NodePattern nodes;
    GivenMark mark;  ///< who bears it is known once the nodes are
  };
  struct Placed {
    NodeMark mark;
    glm::dmat4 world_from_mark{1.0};
  };
  InputFile file;
  glm::dmat4 room_from_model{1.0};   ///< to metres, +Y up, and the room's own origin
  std::vector<NodePattern> ignored;  ///< with all that is below them
  std::vector<OfNodes> of_nodes;
  std::vector<Placed> placed;  ///< in the room
};

/// Throws Error(io), and Error(input) with all faults of the file.
[[nodiscard]] MarksFile read_marks_file(const std::filesystem::path& file, GroupedWarnings& warnings);

/// What a marks file says of a scene's nodes, by their index.
struct MarksOfNodes {
  std::map<int, NodePattern> ignored;  ///< meshes that aren't loaded, and the pattern that says so
  std::map<int, NodeMark> marks;
};

/// Faults: a pattern that matches no node of the scene, a node that two match.
[[nodiscard]] MarksOfNodes marks_of_nodes(const MarksFile& marks, const GltfDocument& document,
                                          const PlacedNodes& nodes, Diagnostics& faults, GroupedWarnings& warnings);

/// " in marks.yaml:4:7", for messages that name a second place.
[[nodiscard]] std::string in_place(const Where& where);

/// A node's name, its mesh's if it has none itself, "mesh 4" or "node 4" if that has none either.
[[nodiscard]] std::string node_name(const tinygltf::Model& model, int node);

}  // namespace pirsim::io::detail

// A model as it is, without marks: what has triangles, where it is, and what it and the groups around it are called.

namespace pirsim::io {

/// What has a mesh, or groups such.
struct ModelNode {
  std::string name;  ///< as patterns of a marks file name it
  int parent = -1;   ///< index; -1: none
};
struct ModelPart {
  int node = 0;  ///< index into the model's
  TriMesh mesh;  ///< in the file's own frame and unit
};
struct ModelParts {
  std::vector<ModelNode> nodes;  ///< parents before children; hidden ones are left out
  std::vector<ModelPart> parts;
  std::vector<Issue> warnings;
};

/// Throws Error(io) and Error(input) as read_scene() does.
[[nodiscard]] ModelParts read_model_parts(const std::filesystem::path& file);

}  // namespace pirsim::io
