// What coverage studies, walk tests and comparisons of placements are asked for, as plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// Called after each row of the floor's squares or points, from one thread at a time; what it throws ends the work.
using RowDone = std::function<void(std::size_t n_done, std::size_t n_rows)>;

// A coverage study as plain data: which moving target stands where for how long, and how sensors are read.

/// A steady turn about an axis of the frame that the turn before it made; the first one is in the world.
struct TurnSpec {
  Vec3 axis{0.0, 1.0, 0.0};
  double deg_per_s = 100.0;
};

/// Upright crosses of two round bars at right angles, turning on the spot. Ref: [Stefansson2021] section 3.2.
struct XShapesSpec {
  std::vector<double> heights_m{1.0, 0.25};  ///< of the crosses' middles over the floor
  double bar_length_m = 0.40;                ///< from tip to tip, caps included
  double bar_width_m = 0.07;                 ///< diameter
  double temperature_c = 33.5;               ///< for the analog response (`assumed`: as skin; 24 to 36.9 tried)
  std::vector<TurnSpec> turns{{{0.0, 1.0, 0.0}, 100.0}, {{0.0, 0.0, 1.0}, 100.0}};
};

struct CoverageSpec {
  std::string name;
  SensingSpec sensing;
  double spacing_m = 0.03;           ///< of the squares
  double duration_s = 60.0;          ///< in every square; a whole number of windows
  std::vector<std::string> without;  ///< things taken out of the room: meshes of this name, or of this first word
  std::vector<Where> without_where;  ///< (n of `without`) for messages
  XShapesSpec target;
  std::uint64_t seed = 1;           ///< of what effects draw; every square draws by itself
  std::vector<EffectSpec> effects;  ///< as in a script
};

// Sets of sensors to compare, and where a better set may be looked for, as plain data.

struct SensorSetSpec {
  std::string id;
  std::vector<SensorSpec> sensors;  ///< none: those of the scene
  std::vector<Where> where{};       ///< (n_sensors) of their positions, for messages; or none
};

/// A straight line on a wall or the ceiling on which sensors may hang, all facing alike.
struct MountingLineSpec {
  Vec3 from{0.0}, to{0.0};
  double yaw_deg = 0.0;    ///< 0 facing -Z, positive turning left
  double tilt_deg = 20.0;  ///< downwards
};

struct PlacementSearchSpec {
  int n_sensors = 1;
  std::string model;
  std::vector<MountingLineSpec> lines;
  int evaluations = 200;  ///< sensor sets that are tried; by seats: places of one sensor
};

/// What sets are ranked by, and what a search looks for.
enum class PlacementAim {
  area,       ///< floor where the target is noticed
  seats,      ///< seats where somebody at work is noticed; among equals, surely noticed ones, then area
  false_off,  ///< how seldom light goes off on somebody; among equals, least time in the dark, then least empty light
};

/// Whose light `false_off` is about: each area of the scene has one, switched by the sensors that watch it.
struct PlacementLightSpec {
  ScriptSpec people;        ///< whose days are simulated
  double delay_min = 10.0;  ///< from the last motion until it goes off
  double wave_s = 10.0;     ///< who is in the dark has brought it back so long after (`assumed`; 0 to 60 tried)
};

struct PlacementSpec {
  CoverageSpec coverage;  ///< by which sets are judged
  PlacementAim by = PlacementAim::area;
  Where by_where{};                         ///< for messages
  std::optional<PlacementLightSpec> light;  ///< by `false_off` there is one
  std::vector<SensorSetSpec> sets;
  std::optional<PlacementSearchSpec> search;
  std::map<std::string, Where> models;  ///< of sensors: where each is named first, for messages
};

/// World frame of a sensor that looks along a heading, tilted down.
[[nodiscard]] Frame mounted(const Vec3& position, double yaw_deg, double tilt_deg);

// A virtual walk test as plain data: which movements are tried at every point, and what is required of the sensors.

/// In `within_s` seconds of a movement, motion has to be reported in at least `probability` of the tries.
struct WalkRequirement {
  double within_s = 2.0;
  double probability = 0.9;
  int directions = 8;  ///< tries: evenly round the circle
};

/// In which plane an arm swings.
enum class ArmSwing { horizontal, vertical };

/// A box that turns about its end, there and back, and then rests: horizontally half of its swing to either side of
/// where it points, vertically upwards from there.
struct SwingingArmSpec {
  double length_m = 0.381;   ///< 15 in
  double width_m = 0.0762;   ///< 3 in, both ways across
  double height_m = 0.9144;  ///< 36 in, of its axis over the floor
  double swing_deg = 90.0;
  double deg_per_s = 90.0;
  double temperature_c = 33.5;  ///< for the analog response (`assumed`: as skin; 28 to 36.9 tried)
  std::vector<ArmSwing> swings{ArmSwing::horizontal, ArmSwing::vertical};  ///< each in every direction
};

struct WalkTestSpec {
  std::string name;
  SensingSpec sensing;
  double spacing_m = 0.5;
  PersonSpec person;
  /// A person crosses the point, starting to walk half of `path_m` before it.
  WalkRequirement major;
  double path_m = 2.0;
  /// If given, motion counts until the person has stood at the end of the path for so long, whatever `major.within_s`.
  std::optional<double> stop_s{};
  /// A person who sits over the point moves both forearms to and fro; or, if there is one, an arm over it swings.
  WalkRequirement minor{10.0, 0.9, 8};
  std::optional<SwingingArmSpec> arm{};
  double seat_height_m = 0.531;  ///< of the pelvis
  double desk_height_m = 0.74;   ///< on which the forearms move; the desk itself hides nothing
  double arm_amplitude_m = 0.1;
  double arm_period_s = 3.0;
  std::uint64_t seed = 1;           ///< of what effects draw; every try draws by itself
  std::vector<EffectSpec> effects;  ///< as in a script
};

}  // namespace pirsim
