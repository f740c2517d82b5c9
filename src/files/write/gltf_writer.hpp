// Arrays, meshes and nodes of a glTF document that is written, solids as triangles among them. Private to io.
#pragma once

#include <tiny_gltf.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"
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

// A run as an animated glTF that any viewer plays and other programs can compute with (docs/formats/view.md).

/// A moving solid, one node named "<person>/<part>".
struct ExportedPart {
  std::string person;
  std::string part;
  Shape shape;
  std::vector<Frame> world_from_part;  ///< (n_keys)
};

struct ExportedPerson {
  std::string id;
  std::vector<ExportedPart> parts;
  std::vector<std::uint8_t> present;  ///< (n_keys) 0 from this key to the next: not in the scene, drawn at scale 0
  std::size_t number = 0;             ///< among all people of the run: gives the colour, as in pictures
};

/// What a sensor looks along, as lines.
struct ExportedBeams {
  std::string sensor;
  std::vector<std::pair<Vec3, Vec3>> segments;  ///< world metres
};

/// Of a door, one node named as it.
struct ExportedLeaf {
  std::string door;
  Shape shape;
  std::vector<Frame> world_from_leaf;  ///< (n_keys)
};

struct ExportedRun {
  std::string title;
  std::vector<TriMesh> meshes;
  std::vector<ExportedPerson> people;
  std::vector<ExportedLeaf> leaves{};
  std::vector<ExportedBeams> beams;
  std::vector<double> key_times_s;  ///< (n_keys) ascending from 0 or later; at least one if there are people
};

/// A binary .glb, or by any other extension a .gltf with its buffer embedded. Positions and poses are stored in
/// single precision. Error(usage) for keys, poses and presences that don't match or aren't finite, Error(io) if the
/// file can't be written.
void write_gltf(const std::filesystem::path& file, const ExportedRun& run);
/// The bytes of the .glb; throws Error(usage) as write_gltf() does.
[[nodiscard]] std::string to_glb(const ExportedRun& run);

/// Linear-light red, green, blue of person i, the first again after the last. None is a beam's blue or red, a door's
/// green or a seat's purple.
[[nodiscard]] inline const Vec3& person_colour(std::size_t i) {
  static const std::array<Vec3, 8> colours{Vec3(0.85, 0.58, 0.04), Vec3(0.82, 0.27, 0.50), Vec3(0.02, 0.40, 0.37),
                                           Vec3(0.70, 0.70, 0.68), Vec3(0.22, 0.25, 0.03), Vec3(0.52, 0.45, 0.78),
                                           Vec3(0.06, 0.06, 0.07), Vec3(0.26, 0.03, 0.09)};
  return colours[i % colours.size()];
}

// A scene as the text of a glTF file.

/// What write_scene() writes into a .gltf. where: for messages. Throws Error(usage) as write_scene() does.
[[nodiscard]] std::string scene_text(const SceneSpec& scene, const Where& where);

}  // namespace pirsim::io
