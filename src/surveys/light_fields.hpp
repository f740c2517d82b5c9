// Fields of rules for light (schema/field.hpp).
#pragma once

#include <tuple>

#include "model/schema/fields.hpp"
#include "pirsim/control.hpp"

namespace pirsim {

template <>
struct Words<control::Timer> {
  static constexpr WordList<control::Timer, 2> all{
      {{"restarts", control::Timer::restarts}, {"runs_out", control::Timer::runs_out}}};
};

namespace accepted {

inline constexpr NumberRange delay_min{.min = 0.0, .max = 1440.0};

}  // namespace accepted

template <>
struct Fields<control::TogetherSpec> {
  using S = control::TogetherSpec;
  static constexpr const char* name = "together";
  static constexpr std::tuple all{FIELD(sensors, accepted::people_of_counts, "so many of them"),
                                  FIELD(within_s, accepted::held_s, "so long after each other")};
};
template <>
struct Fields<control::ManualSpec> {
  using S = control::ManualSpec;
  static constexpr const char* name = "manual";
  static constexpr std::tuple all{FIELD(switch_s, accepted::held_s, "until who is in the dark has switched it on"),
                                  FIELD(grace_s, accepted::held_s, "so long after it went off, motion brings it back")};
};
template <>
struct Fields<control::NightSpec> {
  using S = control::NightSpec;
  static constexpr const char* name = "night";
  static constexpr std::tuple all{FIELD(from_h, accepted::hour_of_day, "by the rows' clock"),
                                  FIELD(to_h, accepted::hour_of_day, "over midnight if it is the earlier one"),
                                  FIELD(delay_min, accepted::delay_min, "the delay from `from` to `to`")};
};
template <>
struct Fields<control::LightSpec> {
  using S = control::LightSpec;
  static constexpr const char* name = "light";
  static constexpr std::tuple all{
      FIELD(id, "as outputs name it; default the area, or light_1, ..."),
      FIELD(area, "whose people it is for: the rows' column people_living_room; default all people"),
      FIELD(sensors, "that switch it; default with `--scene` those that watch its area, else all of the rows"),
      FIELD(together, "how many of them have to report motion; default any one of them"),
      field("delay_min", &S::delays_min, accepted::delay_min, "one or several; the first is told of most"),
      FIELD(manual, "people switch it on; default motion does"),
      FIELD(wave_s, accepted::held_s, "who is in the dark has brought it back so long after; default nobody does"),
      FIELD(timer, "every motion starts the delay anew, or only one at its end or later does"),
      FIELD(least_on_min, accepted::delay_min, "it is never lit for less"),
      FIELD(door, "a door's contact, below; default none"),
      FIELD(settle_s, accepted::held_s, "after the door was shut, motion may still be of who went out"),
      FIELD(night, "another delay then; default none"),
      FIELD(from_h, accepted::hour_of_day, "begin and end of the hours in which it is dark without light"),
      FIELD(to_h, accepted::hour_of_day, "over midnight if it is the earlier one; other hours aren't counted"),
      FIELD(power_w, NumberRange{.min = 0.0, .max = 1e6}, "for the energy; 0: energy isn't told"),
      FIELD(at_most_a_week, NumberRange{.min = 1e-3, .max = 1e4},
            "so often it may go off on somebody: which delay is told to be long enough"),
      LABEL(where)};
};

}  // namespace pirsim
