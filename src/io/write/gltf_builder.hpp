// Arrays, meshes and nodes of a glTF document that is written, solids as triangles among them. Private to io.
#pragma once

#include <tiny_gltf.h>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::io {

// Triangles of solids, for pictures: rays are traced against the solids themselves.

struct SolidMesh {
  std::vector<Vec3> positions;         ///< on the solid's surface, in its frame
  std::vector<Vec3> normals;           ///< outward, unit, one a position
  std::vector<std::uint32_t> indices;  ///< three a triangle, counter-clockwise from outside
};

/// Of primitives closed; a sphere of radius r is missed by 0.02 r at most. A mesh is its own, flat shaded.
[[nodiscard]] SolidMesh tessellated(const Shape& shape);

/// All functions that add something return its index in the document.
class GltfBuilder {
 public:
  explicit GltfBuilder(const std::string& title);

  int add_positions(const std::vector<Vec3>& positions);
  int add_normals(const std::vector<Vec3>& normals);
  int add_indices(const std::vector<std::uint32_t>& indices);
  int add_key_times(const std::vector<double>& seconds);
  int add_track(const std::vector<Vec3>& values);  ///< translations or scales, one a key
  int add_track(const std::vector<Quat>& values);  ///< rotations, one a key

  int add_material(const std::string& name, const Vec3& colour, double opacity);
  /// One primitive of the given mode (TINYGLTF_MODE_*); accessor -1: none.
  int add_mesh(const std::string& name, const tinygltf::Primitive& primitive);
  int add_mesh(const TriMesh& mesh, int material);
  /// A node below `parent`, or of the scene's roots for parent -1.
  int add_node(tinygltf::Node node, int parent = -1);
  /// Adds a channel to the one animation; interpolation as glTF spells it.
  void animate(int node, const std::string& path, int key_times, int track, const std::string& interpolation);

  enum class Container { binary, text };  ///< .glb or .gltf
  /// The file's bytes. where, what ("run"): for the message. Throws Error(usage) for names that aren't UTF-8.
  [[nodiscard]] std::string bytes(Container container, const Where& where, const std::string& what) const;
  /// As .glb if the name ends so, else as .gltf; whole or not at all. Throws as bytes().
  void write(const std::filesystem::path& file, const std::string& what) const;

 private:
  int add_floats(const std::vector<float>& values, int type, int target);
  int add_accessor(const void* data, std::size_t bytes, int target, tinygltf::Accessor accessor);

  tinygltf::Model model_;
};

/// What pirsim says about a node: extras {"pirsim": {"type": type, ...members}}.
[[nodiscard]] tinygltf::Value pirsim_extras(const std::string& type, tinygltf::Value::Object members);

}  // namespace pirsim::io
