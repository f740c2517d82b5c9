// Parametric rooms: ranges of sizes, furniture and sensors in, ordinary scenes out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::dataset {

/// Uniform from `least` to `most`; a single value where they are equal.
struct Range {
  double least = 0.0, most = 0.0;
  bool operator==(const Range&) const = default;
};
/// Whole numbers from `least` to `most`, each as likely.
struct CountRange {
  int least = 0, most = 0;
  bool operator==(const CountRange&) const = default;
};

enum class RoomKind { office, meeting };
enum class DeskOrder {
  islands,  ///< back to back, two to six together
  rows,     ///< side by side, all facing one way
  walls     ///< each before a wall, its user facing it
};
enum class Mount {
  ceiling,  ///< looks straight down, turned any way
  corner,   ///< looks along the bisector of two walls
  wall      ///< looks straight away from the wall
};

/// Sensors of one kind.
struct SensorGroupSpec {
  Mount mount = Mount::ceiling;
  std::vector<std::string> models;  ///< each sensor is one of them; empty: EKMC1601111 on ceilings, else EKMC1604111
  CountRange count{1, 1};
  Range height_m{2.1, 2.4};    ///< above the floor; of no meaning on ceilings
  Range tilt_deg{10.0, 30.0};  ///< of its axis below the horizon; of no meaning on ceilings
  Where where;                 ///< for messages
};

/// What a room may be like. All defaults are `assumed`: small offices of our own choice, not a survey.
struct RoomSpec {
  RoomKind kind = RoomKind::office;
  Range width_m{4.5, 7.5};      ///< along x
  Range depth_m{4.0, 6.0};      ///< along -z
  Range height_m{2.5, 3.0};     ///< of the ceiling
  double l_shaped = 0.0;        ///< probability that a far corner is missing
  Range cut_share{0.25, 0.45};  ///< of width and of depth, that this corner takes
  CountRange doors{1, 1};       ///< in the walls, but not in those of a missing corner
  Range door_width_m{0.9, 0.9};
  CountRange seats{2, 4};  ///< a desk each, or round one table in a meeting room
  std::vector<DeskOrder> orders{DeskOrder::islands, DeskOrder::rows, DeskOrder::walls};  ///< one is drawn
  Range desk_width_m{1.4, 1.6};
  double desk_screens = 0.5;    ///< probability that islands have screens between facing desks
  CountRange cupboards{0, 2};   ///< before walls, 0.8 to 2 m high
  CountRange partitions{0, 1};  ///< free-standing screens, 1.4 to 1.8 m high
  std::vector<SensorGroupSpec> sensors{{}, {.mount = Mount::corner, .models = {}, .count = {1, 1}, .where = {}}};
  Where where;  ///< for messages
};

/// Seen from above, sides along the axes.
struct Rectangle {
  Vec2 lower{0.0}, upper{0.0};  ///< (x, z)
  [[nodiscard]] double area_m2() const noexcept { return (upper.x - lower.x) * (upper.y - lower.y); }
  bool operator==(const Rectangle&) const = default;
};

enum class Fixture { structure, desk, table, screen, cupboard, partition };

/// A piece of the room that occludes.
struct Furnishing {
  Fixture kind = Fixture::structure;
  TriMesh mesh;
  Rectangle footprint;  ///< of everything between 0.1 and 2 m above the floor
};

struct DrawnRoom {
  int number = 1;
  int tries = 1;  ///< sub-streams that it took to find one that passed all checks
  double width_m = 0.0, depth_m = 0.0, height_m = 0.0;
  std::vector<Vec2> outline;  ///< (x, z), counter-clockwise seen from above
  std::vector<Furnishing> furnishings;
  SceneSpec scene;
};

inline constexpr int most_tries = 300;

/// Room `number` (from 1) of these ranges: the same for the same seed and number, whatever else is drawn. Every seat
/// can be reached by the largest body that a schedule draws, and every sensor sees somebody; a room that fails is drawn
/// again from the next sub-stream, a meeting room after most_tries of them with a narrow table as often again. Throws
/// Error(infeasible) after all, saying what failed how often, and Error(input) for a sensor model that isn't known.
[[nodiscard]] DrawnRoom draw_room(const RoomSpec& spec, std::uint64_t seed, int number,
                                  const io::SceneOptions& options = {});

}  // namespace pirsim::dataset
