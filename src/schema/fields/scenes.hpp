// Fields of scenes (schema/fields.hpp).
#pragma once

#include <tuple>

#include "pirsim/scene.hpp"
#include "schema/field.hpp"
#include "schema/fields/accepted.hpp"
#include "schema/words.hpp"

namespace pirsim {

template <>
struct Fields<TriMesh> {
  using S = TriMesh;
  static constexpr const char* name = "Mesh";
  static constexpr const char* about = "Triangles that hide what is behind them.";
  static constexpr std::tuple all{FIELD(name), FIELD(positions), FIELD(triangles), FIELD(solidity),
                                  FIELD(temperature_c, accepted::surface_c)};
};
template <>
struct Fields<SensorSpec> {
  using S = SensorSpec;
  static constexpr const char* name = "Sensor";
  static constexpr const char* about = "A sensor looks along its frame's -Z.";
  static constexpr std::tuple all{FIELD(id), FIELD(model, "key into `Scene.sensor_models`"), FIELD(world_from_sensor),
                                  FIELD(gain, NumberRange{.above = 0.0, .max = 100.0},
                                        "of its signal, relative to what its make's rated distances say; for the "
                                        "analog response"),
                                  FIELD(area, "id of the area that it watches; none: the one below it")};
};
template <>
struct Fields<SeatSpec> {
  using S = SeatSpec;
  static constexpr const char* name = "Seat";
  static constexpr const char* about = "The sitter's pelvis rests at the origin and faces -Z.";
  static constexpr std::tuple all{FIELD(id), FIELD(world_from_seat),
                                  FIELD(uses, "`for` of a mark; none: for anything")};
};
template <>
struct Fields<PlaceSpec> {
  using S = PlaceSpec;
  static constexpr const char* name = "Place";
  static constexpr const char* about =
      "A place to lie (the pelvis on the origin, the head towards +Z) or to stand (facing -Z). One to sit is a `Seat`.";
  static constexpr std::tuple all{FIELD(id), FIELD(posture), FIELD(world_from_place),
                                  FIELD(uses, "`for` of a mark; none: for anything")};
};
template <>
struct Fields<EntranceSpec> {
  using S = EntranceSpec;
  static constexpr const char* name = "Entrance";
  static constexpr const char* about = "A doorway: the origin is the middle of the threshold, -Z points into the room.";
  static constexpr std::tuple all{
      FIELD(id), FIELD(world_from_entrance),
      // assumed: nobody passes a narrower gap or waits farther off
      FIELD(width_m, NumberRange{.min = 0.3, .max = 20.0}, "of the opening"),
      FIELD(outside_m, NumberRange{.min = 0.3, .max = 50.0}, "how far behind it people wait")};
};
template <>
struct Fields<AreaSpec> {
  using S = AreaSpec;
  static constexpr const char* name = "Area";
  static constexpr const char* about = "A named part of the floor: people are counted in each.";
  static constexpr std::tuple all{FIELD(id), FIELD(outline)};
};
template <>
struct Fields<DoorSpec> {
  using S = DoorSpec;
  static constexpr const char* name = "Door";
  static constexpr const char* about =
      "A door with a leaf: the origin is the middle of the threshold, -Z leads through the opening.";
  // Defaults are assumed: leaves of flats are 0.6 to 0.9 m wide and 2 m high (ranges tried: turn_s 0.5-2, shut_share
  // 0.2-1, stands_open_s 30-1800).
  static constexpr std::tuple all{
      FIELD(id),
      FIELD(world_from_door),
      FIELD(width_m, NumberRange{.min = 0.4, .max = 5.0}, "of the leaf"),
      FIELD(height_m, NumberRange{.min = 0.5, .max = 10.0}, "of the leaf"),
      FIELD(thickness_m, NumberRange{.min = 0.005, .max = 0.3}, "of the leaf"),
      FIELD(hinge, "at which side whoever goes through along -Z sees it: `left` or `right`"),
      FIELD(opens, "to which side: `inward`, where -Z points, or `outward`"),
      FIELD(open_deg, NumberRange{.min = 5.0, .max = 180.0}, "how far the leaf turns"),
      FIELD(turn_s, NumberRange{.min = 0.1, .max = 60.0}, "how long that takes"),
      FIELD(state, "as people leave it: `open`, `shut`, or by `habit`"),
      FIELD(shut_share, accepted::probability, "by habit: share of passes after which it is shut at once"),
      FIELD(stands_open_s, NumberRange{.min = 0.0, .max = 86400.0},
            "by habit: how long it stands open after the others")};
};
template <>
struct Fields<SceneSpec> {
  using S = SceneSpec;
  static constexpr const char* name = "Scene";
  static constexpr const char* about = "A room: what hides, where the sensors hang, where people sit, enter and walk.";
  static constexpr std::tuple all{LABEL(name),
                                  FIELD(meshes),
                                  FIELD(sensors, "in the order of the output's columns"),
                                  FIELD(seats),
                                  FIELD(places, "to lie and to stand"),
                                  FIELD(entrances),
                                  FIELD(doors),
                                  FIELD(floor),
                                  FIELD(areas, "apart from each other, in the order of the output's columns"),
                                  FIELD(sensor_models, "every model that a sensor names"),
                                  LABEL(files, "all that was read"),
                                  LABEL(warnings)};
};

}  // namespace pirsim
