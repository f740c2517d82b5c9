// The node hierarchy of the scene that is shown, flattened into world transforms. Private to io.
#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "io/gltf_document.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::io::detail {

struct PlacedNode {
  int node = 0;  ///< index into `nodes`
  glm::dmat4 world_from_node{1.0};
};

/// Nodes of the default scene, children after parents, in file order. Faults: no scene, a node below itself or below
/// two parents, transforms that are singular, not finite or out of the world.
[[nodiscard]] std::vector<PlacedNode> place_nodes(const GltfDocument& document, Diagnostics& remarks);

/// The rigid part of a transform: looks along its -Z exactly, +Y as near as it can be; scale and mirroring drop out.
[[nodiscard]] Frame rigid_frame(const glm::dmat4& world_from_node);

}  // namespace pirsim::io::detail
