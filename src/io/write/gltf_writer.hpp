// A run as an animated glTF that any viewer plays and other programs can compute with (docs/formats/view.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pirsim/geometry.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::io {

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

}  // namespace pirsim::io
