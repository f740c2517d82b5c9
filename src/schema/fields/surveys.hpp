// Fields of coverage studies, walk tests and placements (schema/fields.hpp).
#pragma once

#include <tuple>

#include "pirsim/survey.hpp"
#include "schema/field.hpp"
#include "schema/fields/accepted.hpp"
#include "schema/words.hpp"

namespace pirsim {

template <>
struct Fields<TurnSpec> {
  using S = TurnSpec;
  static constexpr std::tuple all{FIELD(axis), FIELD(deg_per_s, NumberRange{.min = -3600.0, .max = 3600.0})};
};
template <>
struct Fields<XShapesSpec> {
  using S = XShapesSpec;
  static constexpr std::tuple all{
      FIELD(heights_m, NumberRange{.min = 0.0, .max = 10.0}, "of the crosses' centres over the floor"),
      FIELD(bar_length_m, NumberRange{.above = 0.0, .max = 5.0}, "from tip to tip, caps included"),
      FIELD(bar_width_m, NumberRange{.above = 0.0, .max = 1.0}, "diameter"),
      FIELD(temperature_c, accepted::surface_c, "of the crosses, for the physical response, which has no noise here"),
      FIELD(turns)};
};
template <>
struct Fields<CoverageSpec> {
  using S = CoverageSpec;
  static constexpr std::tuple all{
      LABEL(name),
      FIELD(sensing),
      FIELD(spacing_m, NumberRange{.min = 0.005, .max = 10.0}, "side of a square"),
      FIELD(duration_s, NumberRange{.above = 0.0, .max = 3600.0}, "in every square; a whole number of windows"),
      FIELD(without, "what is taken out of the room: meshes of this name, or of this first word"),
      LABEL(without_where),
      FIELD(target),
      FIELD(seed, accepted::seed),
      FIELD(effects)};
};
template <>
struct Fields<MountingLineSpec> {
  using S = MountingLineSpec;
  static constexpr std::tuple all{FIELD(from), FIELD(to),
                                  FIELD(yaw_deg, accepted::turned_deg, "0 facing -Z, positive turning left"),
                                  FIELD(tilt_deg, accepted::tilted_deg, "downwards")};
};
template <>
struct Fields<PlacementSearchSpec> {
  using S = PlacementSearchSpec;
  static constexpr std::tuple all{
      FIELD(n_sensors, IntegerRange{.min = 1, .max = 20}), FIELD(model), FIELD(lines),
      FIELD(evaluations, IntegerRange{.min = 1, .max = 100000},
            "sensor sets that are tried; by seats and false_off: places of one sensor, evenly along the lines")};
};
template <>
struct Fields<PlacementLightSpec> {
  using S = PlacementLightSpec;
  static constexpr std::tuple all{
      FIELD(people),
      FIELD(delay_min, NumberRange{.min = 0.0, .max = 1440.0}, "from the last motion until the light goes off"),
      FIELD(wave_s, NumberRange{.min = 0.0, .max = 3600.0},
            "who is in the dark has brought the light back so long after (assumed; 0 to 60 tried)")};
};
template <>
struct Fields<PlacementSpec> {
  using S = PlacementSpec;
  static constexpr std::tuple all{FIELD(coverage), FIELD(by, "what sets are ranked by and a search looks for"),
                                  LABEL(by_where), FIELD(light),
                                  FIELD(sets),     FIELD(search),
                                  LABEL(models)};
};
template <>
struct Fields<WalkRequirement> {
  using S = WalkRequirement;
  static constexpr std::tuple all{
      FIELD(within_s, NumberRange{.above = 0.0, .max = 600.0}, "from the start of the movement"),
      FIELD(probability, NumberRange{.above = 0.0, .max = 1.0}, "required share of noticed tries"),
      FIELD(directions, IntegerRange{.min = 1, .max = 360}, "number of directions tried, evenly spaced")};
};
template <>
struct Fields<SwingingArmSpec> {
  using S = SwingingArmSpec;
  static constexpr std::tuple all{
      FIELD(length_m, NumberRange{.above = 0.0, .max = 2.0}, "from its axis to its tip"),
      FIELD(width_m, NumberRange{.above = 0.0, .max = 1.0}, "both ways across"),
      FIELD(height_m, NumberRange{.min = 0.2, .max = 3.0}, "of its axis over the floor"),
      FIELD(swing_deg, NumberRange{.above = 0.0, .max = 360.0}, "there, and the same back"),
      FIELD(deg_per_s, NumberRange{.above = 0.0, .max = 3600.0}),
      FIELD(temperature_c, accepted::surface_c, "of its surface, for the analog response (assumed: as skin)"),
      FIELD(swings, "horizontal, vertical: each in every direction")};
};
template <>
struct Fields<WalkTestSpec> {
  using S = WalkTestSpec;
  static constexpr std::tuple all{
      LABEL(name),
      FIELD(sensing),
      FIELD(spacing_m, NumberRange{.min = 0.05, .max = 10.0}, "of the points"),
      FIELD(person),
      FIELD(major),
      FIELD(path_m, NumberRange{.min = 0.5, .max = 20.0}, "length of the straight walk; the point is its middle"),
      FIELD(stop_s, NumberRange{.min = 0.0, .max = 60.0},
            "in place of within_s: motion counts until the walker has stood so long at the end of the path"),
      FIELD(minor),
      FIELD(arm),
      FIELD(seat_height_m, NumberRange{.min = 0.3, .max = 0.8}, "of the pelvis"),
      FIELD(desk_height_m, NumberRange{.min = 0.5, .max = 1.1}, "of the forearms"),
      FIELD(arm_amplitude_m, NumberRange{.min = 0.0, .max = 0.15}),
      FIELD(arm_period_s, NumberRange{.min = 0.5, .max = 60.0}),
      FIELD(seed, accepted::seed),
      FIELD(effects)};
};

}  // namespace pirsim
