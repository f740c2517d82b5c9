// What the markup of a scene says, and its floor. Private to io.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "core/grouped_warnings.hpp"
#include "io/read/gltf_document.hpp"
#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::io::detail {

// What materials say about heat: `extras.pirsim.temperature_c`.

/// (n_materials) nothing for those that say nothing, or something faulty (the faults are added).
[[nodiscard]] std::vector<std::optional<double>> material_temperatures_c(const GltfDocument& document,
                                                                         Diagnostics& remarks);

// What a node is, if it isn't just geometry: `extras.pirsim`.

namespace mark {
enum class Occludes { yes, no };
struct Floor {
  std::optional<std::vector<Vec2>> polygon;  ///< in the node's local XZ; otherwise the outline of the node's mesh
  Occludes occludes = Occludes::yes;
};
/// Says something of the node's mesh.
struct Surface {
  std::optional<double> temperature_c;
};
struct Ignore {};
}  // namespace mark

/// Sensors, seats and entrances without their place, which is the node's.
using Markup = std::variant<SensorSpec, SeatSpec, EntranceSpec, mark::Floor, mark::Surface, mark::Ignore>;

enum class Doubts { told, not_told };
struct NodeMark {
  Markup what;
  Doubts doubts = Doubts::told;  ///< not_told: `as_meant`, the node is as it should be
};

/// JSON pointer of a node's markup.
[[nodiscard]] std::string markup_pointer(int node);

/// Nothing for a node without markup, or with a faulty one (the faults are added).
[[nodiscard]] std::optional<NodeMark> read_markup(const GltfDocument& document, int node, Diagnostics& faults,
                                                  GroupedWarnings& warnings);

/// Warns of what was meant for a mark but isn't read as one: `PIRSIM`, or its keys without it.
void warn_of_near_marks(const GltfDocument& document, int node, GroupedWarnings& warnings);

// What a scene may say, but hardly means.

/// Indices of nodes: seats, entrances and meshes as in the scene.
struct MarkedNodes {
  std::vector<int> seats, entrances, meshes;
  int floor = 0;
  std::set<int> as_meant = {};  ///< nothing about them is in doubt
};
struct Doubt {
  std::string kind;  ///< what such doubts have in common
  int node = 0;
  std::string name;  ///< of what is in doubt: "seat 'S1'"
  std::string message;
};
using DoubtSink = std::function<void(const Doubt&)>;

/// An entrance turned round, off the floor's edge or blocked; a seat off the floor, at another's place, inside a desk
/// or with its back to one; sizes of another unit than metres, beside which nothing else is in doubt.
void doubt(const SceneSpec& scene, const MarkedNodes& nodes, const DoubtSink& tell);

// The floor area of a scene, joined from all nodes that are marked as floor.

class FloorBuilder {
 public:
  explicit FloorBuilder(Diagnostics& faults) : faults_(faults) {}

  /// Outline of a flat horizontal mesh, world frame.
  void add_mesh(const TriMesh& mesh, const Where& where, const std::string& label);
  /// Corners in the world.
  void add_polygon(const std::vector<Vec3>& corners, const Where& where, const std::string& label);

  /// Adds a fault if parts overlap or differ in height.
  [[nodiscard]] FloorArea build();

 private:
  struct Part {
    FloorArea area;
    Where where;
    std::string label;
  };
  void add(Part part);
  [[nodiscard]] bool flat(const std::vector<Vec3>& points, const Where& where, const std::string& label);

  Diagnostics& faults_;
  std::vector<Part> parts_;
  std::size_t n_corners_ = 0;
};

}  // namespace pirsim::io::detail
