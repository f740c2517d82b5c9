// Parametric flats: ranges of rooms, residents, furniture and sensors in, ordinary scenes out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "pirsim/room.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::dataset {

enum class FlatLayout {
  corridor,  ///< along the middle, the front door at its end, rooms on both sides
  hall,      ///< behind the front door, between the rooms at the back; the living room takes the whole front
  open       ///< the front door leads into the living room, the rooms at the back open into it
};
enum class SensorsAt {
  rooms,    ///< one in every area
  doorways  ///< one above every doorway and the front door
};

/// What a flat may be like. All defaults are `assumed`: flats of our own choice, not a survey.
struct FlatSpec {
  CountRange rooms{1, 4};        ///< a living room, then bedrooms and perhaps a study; of one room the bed stands in it
  CountRange residents{1, 2};    ///< each has a place to lie
  std::optional<Range> size_m2;  ///< of the floor, inner walls included; none: usual_size_m2()
  Range stretch{1.0, 1.6};       ///< width (along x) over depth
  Range height_m{2.4, 2.7};      ///< of the ceiling
  std::vector<FlatLayout> layouts{FlatLayout::corridor, FlatLayout::hall, FlatLayout::open};  ///< one is drawn
  double own_kitchen = 0.6;  ///< probability that the kitchen isn't a part of the living room
  double double_beds = 0.6;  ///< probability that two residents share a bed, and that one alone has a wide one
  double study = 0.4;        ///< probability that a room that no bed needs is a study
  std::vector<SensorsAt> sensors_at{SensorsAt::rooms};  ///< one is drawn
  std::vector<Mount> mounts{Mount::corner};             ///< of sensors in rooms, corner or ceiling; one is drawn
  std::vector<std::string> models;  ///< each sensor is one of them; empty: the usual one for where it hangs
  Where models_where;               ///< for messages
  Range sensor_height_m{2.1, 2.3};  ///< of those in corners
  Range sensor_tilt_deg{10.0, 30.0};
  Where where;  ///< for messages
};

/// m2, of a flat of so many rooms: `assumed`, 28 to 42 of one and 17 to 23 more of each other.
[[nodiscard]] Range usual_size_m2(int rooms) noexcept;

enum class FlatRoomKind { living_room, kitchen, bedroom, study, bath, corridor };

struct FlatRoom {
  FlatRoomKind kind = FlatRoomKind::living_room;
  std::string id;  ///< of its area: "bedroom_2"
  Rectangle area;  ///< up to the middle of inner walls: the rooms share the floor out
};

struct DrawnFlat {
  int number = 1;
  int tries = 1;  ///< sub-streams that it took to find one that passed all checks
  int residents = 1;
  double width_m = 0.0, depth_m = 0.0, height_m = 0.0;
  std::vector<FlatRoom> rooms;
  SceneSpec scene;
};

/// Flat `number` (from 1) of these ranges: the same for the same seed and number, whatever else is drawn. Every seat
/// and place can be reached by the largest body that a schedule draws, and every sensor sees somebody; a flat that
/// fails is drawn again from the next sub-stream. Throws as draw_room() does.
[[nodiscard]] DrawnFlat draw_flat(const FlatSpec& spec, std::uint64_t seed, int number,
                                  const io::SceneOptions& options = {});

// A flat that somebody has, as it is drawn on squared paper: x to the right, y up the page, z = -y.

enum class PlanSide { bottom, right, top, left };  ///< of a room, on the page
enum class PlanCorner { bottom_left, bottom_right, top_left, top_right };
enum class PlanLeaf { none, open, shut, habit };
enum class PieceKind {
  bed,
  sofa,
  table,
  kitchen,  ///< a counter with stove and sink, and a fridge at its end
  counter,
  stove,
  sink,
  fridge,
  shower,
  toilet,
  washbasin,
  wardrobe,
  desk,
  shelf,
  television
};

/// What has no place is put where it fits.
struct PlanPieceSpec {
  PieceKind kind = PieceKind::bed;
  std::optional<PlanSide> wall;    ///< to which its back is
  std::optional<double> x_m, y_m;  ///< of the middle of its back; of a table's middle
  std::optional<double> width_m;   ///< along its back
  std::optional<int> places;       ///< of a bed, a sofa, a table
  Where where;                     ///< for messages
};

/// In a corner, on a wall, or else on the ceiling.
struct PlanSensorSpec {
  std::string id;
  std::string model;  ///< empty: the usual one for where it hangs
  std::optional<PlanCorner> corner;
  std::optional<PlanSide> wall;
  std::optional<double> x_m, y_m;  ///< none: the middle of the wall or of the ceiling
  double height_m = 2.2;
  double tilt_deg = 20.0;
  double turned_deg = 0.0;
  Where where;  ///< for messages
};

struct PlanRoomSpec {
  std::string id;
  FlatRoomKind kind = FlatRoomKind::living_room;
  Range x_m, y_m;    ///< up to the middle of inner walls, and to the face of outer ones
  std::string area;  ///< rooms of one have no wall between them; empty: its id
  std::optional<std::vector<PlanPieceSpec>> furniture;  ///< none: what is usual in such a room
  std::optional<std::vector<PlanSensorSpec>> sensors;   ///< none: one in a corner
  Where where;                                          ///< for messages
};

struct PlanDoorSpec {
  std::string id;
  std::string from, into;  ///< ids of rooms; from: empty: outside
  std::optional<PlanSide> wall;
  std::optional<double> x_m, y_m;
  double width_m = 0.9;
  std::optional<PlanLeaf> leaf;
  std::optional<DoorHinge> hinge;
  Where where;  ///< for messages
};

struct HomePlanSpec {
  std::string name;
  double height_m = 2.5;
  std::vector<PlanRoomSpec> rooms;
  std::vector<PlanDoorSpec> doors;
  Where where;  ///< for messages
};

/// Throws Error: io (no file), input (content), usage (an override).
[[nodiscard]] HomePlanSpec read_home_plan(const std::filesystem::path& file,
                                          std::span<const std::string> overrides = {});
/// What the plan leaves open is drawn as in draw_flat(). Throws Error(input) for what can't be: rooms that overlap, a
/// door without a wall, furniture that isn't in its room; Error(infeasible) where the largest body doesn't get to.
[[nodiscard]] DrawnFlat draw_flat(const HomePlanSpec& plan, std::uint64_t seed, int number,
                                  const io::SceneOptions& options = {});

}  // namespace pirsim::dataset
