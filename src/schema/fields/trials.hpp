// Fields of trials, of how they are sensed, and of what is known of them (schema/fields.hpp).
#pragma once

#include <tuple>

#include "pirsim/script.hpp"
#include "schema/field.hpp"
#include "schema/fields/accepted.hpp"
#include "schema/words.hpp"

namespace pirsim {

template <>
struct Fields<TrialSpec> {
  using S = TrialSpec;
  static constexpr const char* name = "Trial";
  static constexpr const char* about = "One choreography; a study runs every trial once per replicate.";
  static constexpr std::tuple all{FIELD(id, "as the output names it"),
                                  FIELD(people, "the first one's actions name the rows' phase"),
                                  FIELD(duration_s, NumberRange{.min = 1.0, .max = 1e7},
                                        "of a run; none: until everybody has carried out all actions"),
                                  FIELD(schedule), FIELD(occupancy)};
};
template <>
struct Fields<SensingSpec> {
  using S = SensingSpec;
  static constexpr const char* name = "Sensing";
  static constexpr const char* about = "How sensors are read.";
  static constexpr std::tuple all{
      FIELD(tick_rate_hz, IntegerRange{.min = 1, .max = 10000}),
      FIELD(ticks_per_window, "a row and its bits cover this many ticks"),
      FIELD(rays_per_zone),
      FIELD(change_per, "whose change of activity is motion"),
      FIELD(reader, "when in a window each sensor is asked"),
      FIELD(response, "of all sensors; none: each its own"),
      FIELD(units,
            "how sensitive analog sensors are: `typical` of their make, as the maker's `guaranteed` least, or "
            "each `drawn`"),
      FIELD(ambient_c, accepted::skin_c, "of surfaces and of the air, where the scene says nothing else"),
      FIELD(analog_rays_per_zone, IntegerRange{.min = 1, .max = 10000}, "in the physical response")};
};
template <>
struct Fields<SummarySpec> {
  using S = SummarySpec;
  static constexpr const char* name = "Summary";
  static constexpr const char* about =
      "Which rows the command line's --summary adds up, and what they are compared with.";
  static constexpr std::tuple all{
      FIELD(phases, "rows in these phases count"),
      FIELD(reference_file, "CSV with measured sums, or empty; beside the script, or a shipped one"), LABEL(where)};
};
template <>
struct Fields<EffectSpec> {
  using S = EffectSpec;
  static constexpr const char* name = "Effect";
  static constexpr const char* about =
      "Something that the plain model leaves out; `pirsim.effects()` lists all. What isn't given is the typical value.";
  static constexpr std::tuple all{FIELD(name), FIELD(parameters, "by name with unit: {\"sigma_deg\": 1.0}"),
                                  FIELD(choices, "{\"sensor\": \"PIR3\"}"), LABEL(where)};
};
template <>
struct Fields<ScriptSpec> {
  using S = ScriptSpec;
  static constexpr const char* name = "Script";
  static constexpr const char* about = "A study: people and their actions, the trials, how sensors are read.";
  static constexpr std::tuple all{
      LABEL(name),
      FIELD(trials),
      FIELD(seed, accepted::seed),
      FIELD(replicates, IntegerRange{.min = 1, .max = 10000000}),
      FIELD(sensing),
      FIELD(effects),
      FIELD(summary),
      FIELD(begin,
            "local date and time at which every run begins, \"2026-03-02T07:00\"; empty: no clock, or the schedule's"),
      LABEL(directory, "of the script file, for relative references"),
      LABEL(files, "all that was read"),
      LABEL(warnings)};
};

template <>
struct Fields<NuisanceSpec> {
  using S = NuisanceSpec;
  static constexpr std::tuple all{
      FIELD(seat_position_m, NumberRange{.min = 0.0, .max = 0.2}, "of each horizontal coordinate of a seat"),
      FIELD(sensor_yaw_deg, NumberRange{.min = 0.0, .max = 10.0}, "of each sensor"),
      FIELD(sensor_tilt_deg, NumberRange{.min = 0.0, .max = 10.0}, "of each sensor"),
      FIELD(body_size, NumberRange{.min = 0.0, .max = 0.2}, "of stature, relative; mass follows with its cube"),
      FIELD(arm_amplitude, NumberRange{.min = 0.0, .max = 0.5}, "of desk work, relative"),
      FIELD(uneven_arms, NumberRange{.min = 0.0, .max = 1.0}, "upper end of the spread of `uneven_arms`"),
      FIELD(trunk_sway_deg, NumberRange{.min = 0.0, .max = 12.0}, "upper end of the amplitude of `trunk_sway`"),
      FIELD(sensor_gain, NumberRange{.min = 0.0, .max = 0.9}, "of each analog sensor's signal, relative"),
      FIELD(ambient_c, NumberRange{.min = 0.0, .max = 15.0}, "of the room's temperature, where any sensor is analog"),
      FIELD(time_s, NumberRange{.min = 0.0, .max = 600.0}, "of each coming and going that an occupancy's counts tell"),
      FIELD(own_seats, NumberRange{.min = 0.0, .max = 1.0},
            "upper end of the share of an occupancy's spare seats that nobody takes")};
};

}  // namespace pirsim
