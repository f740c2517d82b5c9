// A room as plain data: what occludes, where the sensors hang, where people sit, enter, walk and are counted.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/input_file.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim {

/// A sensor looks along its frame's -Z with +Y up.
struct SensorSpec {
  std::string id;
  std::string model;  ///< key into SceneSpec::sensor_models
  Frame world_from_sensor;
  double gain = 1.0;  ///< of its signal, relative to what its make's rated distances say; for the analog response
  std::optional<std::string> area{};  ///< id of the area that it watches; none: the one below it
};

/// What people do at a place, as marks say in `for`. Nothing is simulated by it; who sends people there goes by it.
inline constexpr std::array<const char*, 16> place_uses{"sleep", "rest",   "tv",   "read", "work",   "meet",
                                                        "phone", "eat",    "cook", "wash", "toilet", "shower",
                                                        "dress", "chores", "play", "pet"};

/// The sitter's pelvis rests at the origin of the seat's frame and faces its -Z; +Y is up. A seat is a place to sit.
struct SeatSpec {
  std::string id;
  Frame world_from_seat;
  std::vector<std::string> uses{};  ///< of place_uses; none: for anything
};

enum class PlacePosture { lie, stand };

/// A place to lie: the origin is on the surface, under the middle of the pelvis, the head lies towards +Z and the feet
/// towards -Z. A place to stand: the origin is on the floor, and who stands there faces -Z. +Y is up.
struct PlaceSpec {
  std::string id;
  PlacePosture posture = PlacePosture::lie;
  Frame world_from_place;
  std::vector<std::string> uses{};  ///< of place_uses; none: for anything
};

/// A doorway. The origin is the middle of the threshold on the floor, -Z points into the room. People wait
/// `outside_m` behind it (+Z) and may walk on the strip of `width_m` that leads there.
struct EntranceSpec {
  std::string id;
  Frame world_from_entrance;
  double width_m = 0.9;
  double outside_m = 1.5;
};

/// A named part of the floor: people are counted in each.
struct AreaSpec {
  std::string id;
  FloorArea outline;
};

/// From which side a leaf's hinge is at the left, and to which side it opens: as whoever goes through along -Z sees it.
enum class DoorHinge { left, right };
enum class DoorOpens { inward, outward };  ///< inward: to where -Z points
/// open, shut: what people leave it as whenever nobody goes through; habit: by who goes through.
enum class DoorState { open, shut, habit };

/// A door with a leaf. The origin is the middle of the threshold on the floor, -Z leads through the opening.
struct DoorSpec {
  std::string id;
  Frame world_from_door;
  double width_m = 0.8;  ///< of the leaf, as the next two
  double height_m = 2.0;
  double thickness_m = 0.04;
  DoorHinge hinge = DoorHinge::left;
  DoorOpens opens = DoorOpens::inward;
  double open_deg = 90.0;  ///< how far the leaf turns
  double turn_s = 1.0;     ///< how long that takes
  DoorState state = DoorState::habit;
  double shut_share = 0.8;       ///< of passes after which a door by habit is shut at once
  double stands_open_s = 300.0;  ///< how long it stands open after the others
};

struct SceneSpec {
  std::string name;                  ///< file name, for messages
  std::vector<TriMesh> meshes;       ///< everything that occludes, world frame, cleaned
  std::vector<SensorSpec> sensors;   ///< in file order: the order of the output columns
  std::vector<SensorSpec> arrays{};  ///< those that give frames instead of a column
  std::vector<SeatSpec> seats;
  std::vector<PlaceSpec> places;  ///< to lie and to stand; those to sit are seats
  std::vector<EntranceSpec> entrances;
  std::vector<DoorSpec> doors{};  ///< in file order, as the columns
  FloorArea floor;
  std::vector<AreaSpec> areas{};                         ///< apart from each other; in file order, as the columns
  std::map<std::string, SensorModelSpec> sensor_models;  ///< every model that a sensor names
  std::vector<InputFile> files;                          ///< all that was read: scene, its buffers, sensors
  std::vector<Issue> warnings;                           ///< what the reader noticed and repaired or ignored
};

/// Refuses what the reader of files would refuse, each fault with its field: `scene.seats[2].id: a second seat 'S1'`.
/// compile() and surveys do so.
void check(const SceneSpec& scene, Diagnostics& diagnostics);

}  // namespace pirsim
