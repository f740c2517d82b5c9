// Parametric flats: ranges of rooms, residents, furniture and sensors in, ordinary scenes out.
#pragma once

#include <cstdint>
#include <optional>
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

}  // namespace pirsim::dataset
