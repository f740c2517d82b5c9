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
            "sensor sets that are tried; by seats: places of one sensor, evenly along the lines")};
};
template <>
struct Fields<PlacementSpec> {
  using S = PlacementSpec;
  static constexpr std::tuple all{FIELD(coverage), FIELD(by, "what sets are ranked by and a search looks for"),
                                  LABEL(by_where), FIELD(sets),
                                  FIELD(search),   LABEL(models)};
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
struct Fields<WalkTestSpec> {
  using S = WalkTestSpec;
  static constexpr std::tuple all{
      LABEL(name),
      FIELD(sensing),
      FIELD(spacing_m, NumberRange{.min = 0.05, .max = 10.0}, "of the points"),
      FIELD(person),
      FIELD(major),
      FIELD(path_m, NumberRange{.min = 0.5, .max = 20.0}, "length of the straight walk; the point is its middle"),
      FIELD(minor),
      FIELD(seat_height_m, NumberRange{.min = 0.3, .max = 0.8}, "of the pelvis"),
      FIELD(desk_height_m, NumberRange{.min = 0.5, .max = 1.1}, "of the forearms"),
      FIELD(arm_amplitude_m, NumberRange{.min = 0.0, .max = 0.15}),
      FIELD(arm_period_s, NumberRange{.min = 0.5, .max = 60.0}),
      FIELD(seed, accepted::seed),
      FIELD(effects)};
};

}  // namespace pirsim
