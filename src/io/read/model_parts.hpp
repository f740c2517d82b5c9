// A model as it is, without marks: what has triangles, where it is, and what it and the groups around it are called.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

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
