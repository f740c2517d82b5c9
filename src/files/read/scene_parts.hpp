// What the markup of a scene says, and its floor. Private to io.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "files/read/gltf_document.hpp"
#include "model/core/error.hpp"
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
/// What is flat: by its polygon in the node's local XZ, otherwise by the outline of the node's mesh.
struct Outlined {
  std::optional<std::vector<Vec2>> polygon;
  Occludes occludes;
};
struct Floor : Outlined {};
struct Area : Outlined {
  std::string id;
};
/// Says something of the node's mesh.
struct Surface {
  std::optional<double> temperature_c;
};
struct Ignore {};
}  // namespace mark

/// Sensors, seats, places, entrances and doors without their place, which is the node's.
using Markup = std::variant<SensorSpec, SeatSpec, PlaceSpec, EntranceSpec, DoorSpec, mark::Floor, mark::Area,
                            mark::Surface, mark::Ignore>;
/// The outline that a mark gives, or null.
[[nodiscard]] const mark::Outlined* outlined(const Markup* markup);

/// Where a mark stands, for messages.
struct MarkPlace {
  std::string label;                                   ///< of what bears it: "node 'PIR1'"
  std::function<Where(const std::string&)> where;      ///< of a part of the mark by its JSON pointer: "/id"
  std::function<Where(const std::string&)> where_key;  ///< of the key that names the part
};

/// A mark as a file gives it, at a node or for one.
struct GivenMark {
  enum class Bearer { plain, with_mesh };
  nlohmann::json value;
  MarkPlace place;
  Bearer bearer = Bearer::plain;
  std::vector<std::string> other_keys = {};  ///< that aren't the mark's, and are read elsewhere
};

enum class Doubts { told, not_told };
struct NodeMark {
  Markup what;
  MarkPlace place;
  Doubts doubts = Doubts::told;  ///< not_told: `as_meant`, the node is as it should be
};

/// The words that `type` may be.
[[nodiscard]] std::vector<std::string> mark_types();
/// Nothing for a faulty mark (the faults are added).
[[nodiscard]] std::optional<NodeMark> read_mark(const GivenMark& given, Diagnostics& faults, GroupedWarnings& warnings);

/// Nothing for a node without markup, or with a faulty one (the faults are added).
[[nodiscard]] std::optional<NodeMark> read_markup(const GltfDocument& document, int node, Diagnostics& faults,
                                                  GroupedWarnings& warnings);

/// Warns of what was meant for a mark but isn't read as one: `PIRSIM`, or its keys without it.
void warn_of_near_marks(const GltfDocument& document, int node, GroupedWarnings& warnings);

// What a scene may say, but hardly means.

/// Numbers of what bears the marks: nodes by their index, then what a marks file places. Seats, places, entrances
/// and meshes as in the scene.
struct MarkedNodes {
  std::vector<int> sensors, seats, places, entrances, doors, meshes, areas;
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

/// An area that sticks out of the floor, an entrance turned round, off the floor's edge or blocked; a seat off the
/// floor, at another's place, inside a desk or with its back to one; sizes of another unit than metres, beside which
/// nothing else is in doubt.
void doubt(const SceneSpec& scene, const MarkedNodes& nodes, const DoubtSink& tell);

// Outlines on the floor: of its own parts, and of areas.

class OutlineReader {
 public:
  /// what: "floor" or "area", for messages.
  OutlineReader(std::string what, Diagnostics& faults) : what_(std::move(what)), faults_(faults) {}

  /// Of a flat horizontal mesh, world frame. None: the fault is added, as below.
  [[nodiscard]] std::optional<FloorArea> of_mesh(const TriMesh& mesh, const Where& where, const std::string& label);
  /// corners: in the world.
  [[nodiscard]] std::optional<FloorArea> of_polygon(const std::vector<Vec3>& corners, const Where& where,
                                                    const std::string& label);

 private:
  [[nodiscard]] bool flat(const std::vector<Vec3>& points, const Where& where, const std::string& label);
  [[nodiscard]] std::optional<FloorArea> checked(FloorArea area, const Where& where, const std::string& label);

  std::string what_;
  Diagnostics& faults_;
  std::size_t n_corners_ = 0;
};

/// The floor area of a scene, joined from all nodes that are marked as floor.
class FloorBuilder {
 public:
  explicit FloorBuilder(Diagnostics& faults) : faults_(faults) {}
  void add(FloorArea part, const Where& where, const std::string& label);
  /// Adds a fault if parts overlap or differ in height.
  [[nodiscard]] FloorArea build();

 private:
  struct Part {
    FloorArea area;
    Where where;
    std::string label;
  };
  Diagnostics& faults_;
  std::vector<Part> parts_;
};

}  // namespace pirsim::io::detail
