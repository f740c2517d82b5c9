// What every number of a spec may be, said once. Readers of files read numbers by these lists, and check() goes through
// the same lists for specs that a program made: neither way in accepts a number that the other refuses.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <type_traits>

#include "core/range.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

namespace accepted {

inline constexpr NumberRange hour_of_day{.min = 0.0, .max = 24.0};
inline constexpr NumberRange at_s{.min = 0.0, .max = 1e7};
inline constexpr NumberRange on_floor_m{.min = -1e4, .max = 1e4};  ///< where people go
/// assumed: far beyond any building, yet 1e-5 of it is still exact in float
inline constexpr NumberRange in_world_m{.min = -1e5, .max = 1e5};
inline constexpr NumberRange on_lens_plane_m{.min = -1e3, .max = 1e3};
inline constexpr NumberRange window_s{.above = 0.0, .max = 3600.0};
inline constexpr NumberRange probability{.min = 0.0, .max = 1.0};
inline constexpr NumberRange surface_c{.min = -50.0, .max = 200.0};  ///< degrees Celsius, of what stands in rooms
inline constexpr NumberRange skin_c{.min = -50.0, .max = 60.0};

}  // namespace accepted

/// Spec or const Spec.
template <typename T, typename Spec>
concept Same = std::same_as<std::remove_const_t<T>, Spec>;

// each_number(spec, visit): calls `visit(name, number, range)` for every number of the spec itself, not of its parts.

void each_number(Same<EntranceSpec> auto& entrance, auto&& visit) {
  // assumed: nobody passes a narrower gap or waits farther off
  visit("width_m", entrance.width_m, NumberRange{.min = 0.3, .max = 20.0});
  visit("outside_m", entrance.outside_m, NumberRange{.min = 0.3, .max = 50.0});
}

void each_number(Same<OpticsSpec> auto& optics, auto&& visit) {
  visit("blur_deg", optics.blur_deg, NumberRange{.min = 0.0, .max = 10.0});
  visit("aperture_mm2", optics.aperture_mm2, NumberRange{.above = 0.0, .max = 1000.0});
}
void each_number(Same<ElementSpec> auto& element, auto&& visit) {
  constexpr NumberRange time_constant{.above = 0.0, .max = 1000.0};
  visit("thermal_s", element.thermal_s, time_constant);
  visit("electrical_s", element.electrical_s, time_constant);
}
void each_number(Same<AmplifierSpec> auto& amplifier, auto&& visit) {
  constexpr NumberRange corner{.above = 0.0, .max = 1000.0};
  constexpr NumberRange volts{.min = 0.0, .max = 100.0};
  visit("low_hz", amplifier.low_hz, corner);
  visit("high_hz", amplifier.high_hz, corner);
  visit("order", amplifier.order, IntegerRange{.min = 1, .max = 3});
  visit("volts_per_watt", amplifier.volts_per_watt, NumberRange{.above = 0.0});
  visit("noise_v_pp", amplifier.noise_v_pp, volts);
  visit("offset_v", amplifier.offset_v, volts);
  visit("lowest_v", amplifier.lowest_v, volts);
  visit("highest_v", amplifier.highest_v, volts);
}
void each_number(Same<ComparatorSpec> auto& comparator, auto&& visit) {
  constexpr NumberRange seconds{.min = 0.0, .max = 3600.0};
  constexpr NumberRange threshold{.above = 0.0, .max = 100.0};
  visit("positive_v", comparator.positive_v, threshold);
  visit("negative_v", comparator.negative_v, threshold);
  visit("pulse_count", comparator.pulse_count, IntegerRange{.min = 1, .max = 8});
  visit("pulse_window_s", comparator.pulse_window_s, seconds);
  visit("hold_s", comparator.hold_s, seconds);
  visit("blind_s", comparator.blind_s, seconds);
}
void each_number(Same<ClusterSpec> auto& cluster, auto&& visit) {
  visit("range_m", cluster.range_m, NumberRange{.above = 0.0, .max = 1000.0});
  visit("lens_step", cluster.lens_step, IntegerRange{.min = 1, .max = 99});
}
void each_number(Same<SensorModelSpec> auto& model, auto&& visit) {
  visit("plane_m", model.plane_m, NumberRange{.min = 1e-3, .max = 1000.0});  // less leaves no digits to directions
}

void each_number(Same<action::Wait> auto& wait, auto&& visit) {
  visit("duration_s", wait.duration_s, NumberRange{.min = 0.0, .max = 1e6});
}
void each_number(Same<action::Appear> auto& appear, auto&& visit) {
  visit("heading_deg", appear.heading_deg, NumberRange{});
}
void each_number(Same<action::Enter> auto&, auto&&) {}
void each_number(Same<action::Walk> auto&, auto&&) {}
void each_number(Same<action::Sit> auto& sit, auto&& visit) {
  visit("wait_s", sit.wait_s, NumberRange{.min = 0.0, .max = 1e6});
}
void each_number(Same<action::Work> auto& work, auto&& visit) {
  constexpr NumberRange positive{.above = 0.0, .max = 1e6};
  visit("duration_s", work.duration_s, positive);
  visit("arm_amplitude_m", work.arm_amplitude_m, NumberRange{.min = 0.0, .max = 0.15});
  visit("arm_period_s", work.arm_period_s, NumberRange{.min = 0.2, .max = 1e6});
  visit("tilt_choices_deg", work.tilt_choices_deg, NumberRange{.min = -30.0, .max = 45.0});
  visit("tilt_every_s", work.tilt_every_s, positive);
}
void each_number(Same<action::Rise> auto&, auto&&) {}
void each_number(Same<action::Leave> auto&, auto&&) {}
void each_number(Same<action::Turn> auto& turn, auto&& visit) {
  visit("heading_deg", turn.heading_deg, NumberRange{.min = -360.0, .max = 360.0});
}

void each_number(Same<SeatScatterSpec> auto& scatter, auto&& visit) {
  visit("position_sd_m", scatter.position_sd_m, NumberRange{.min = 0.0, .max = 0.2});
  visit("heading_sd_deg", scatter.heading_sd_deg, NumberRange{.min = 0.0, .max = 30.0});
}
void each_number(Same<WarmthSpec> auto& warmth, auto&& visit) {
  visit("skin_c", warmth.skin_c, accepted::skin_c);
  visit("clothing_clo", warmth.clothing_clo, NumberRange{.min = 0.0, .max = 10.0});
}
void each_number(Same<PersonSpec> auto& person, auto&& visit) {
  visit("stature_m", person.stature_m, NumberRange{.min = 0.8, .max = 2.3});
  visit("mass_kg", person.mass_kg, NumberRange{.min = 10.0, .max = 250.0});
  visit("walking_speed_m_s", person.walking_speed_m_s, NumberRange{.min = 0.1, .max = 3.0});
}

void each_number(Same<ClockSpec> auto& clock, auto&& visit) {
  visit("sd_min", clock.sd_min, NumberRange{.min = 0.0, .max = 240.0});
}
void each_number(Same<StaffSpec> auto& staff, auto&& visit) {
  const auto own = static_cast<long long>(staff.seats.size());
  visit("count", staff.count, IntegerRange{.min = std::max(1LL, own), .max = 200});
}
void each_number(Same<HeldMeetingSpec> auto& held, auto&& visit) {
  visit("duration_min", held.duration_min, NumberRange{.min = 1.0, .max = 1440.0});
  visit("people", held.people, IntegerRange{.min = 1, .max = 200});
}
void each_number(Same<MeetingsSpec> auto& meetings, auto&& visit) {
  visit("fewest_a_day", meetings.fewest_a_day, IntegerRange{.min = 0, .max = 100});
  visit("most_a_day", meetings.most_a_day, IntegerRange{.min = meetings.fewest_a_day, .max = 100});
  visit("fewest_people", meetings.fewest_people, IntegerRange{.min = 1, .max = 200});
  visit("most_people", meetings.most_people, IntegerRange{.min = meetings.fewest_people, .max = 200});
  visit("durations_min", meetings.durations_min, NumberRange{.min = 1.0, .max = 1440.0});
  visit("probabilities", meetings.probabilities, accepted::probability);
  visit("lateness_min", meetings.lateness_min, NumberRange{.min = 0.0, .max = 60.0});
}
void each_number(Same<ProfileSpec> auto& profile, auto&& visit) {
  visit("presence", profile.presence, accepted::probability);
  visit("mobility", profile.mobility, NumberRange{.min = 0.0, .max = 10.0});
  visit("step_min", profile.step_min, NumberRange{.min = 1.0, .max = 120.0});
}
void each_number(Same<ScheduleSpec> auto& schedule, auto&& visit) {
  visit("lunch_min", schedule.lunch_min, NumberRange{.min = 0.0, .max = 240.0});
  visit("lunch_sd_min", schedule.lunch_sd_min, NumberRange{.min = 0.0, .max = 120.0});
}

void each_number(Same<TrialSpec> auto& trial, auto&& visit) {
  visit("duration_s", trial.duration_s, NumberRange{.min = 1.0, .max = 1e7});
}
void each_number(Same<SensingSpec> auto& sensing, auto&& visit) {
  visit("tick_rate_hz", sensing.tick_rate_hz, IntegerRange{.min = 1, .max = 10000});
  visit("ambient_c", sensing.ambient_c, accepted::skin_c);
  visit("analog_rays_per_zone", sensing.analog_rays_per_zone, IntegerRange{.min = 1, .max = 10000});
}
void each_number(Same<ScriptSpec> auto& script, auto&& visit) {
  visit("seed", script.seed, IntegerRange{.min = 0, .max = std::numeric_limits<long long>::max()});
  visit("replicates", script.replicates, IntegerRange{.min = 1, .max = 10000000});
}

}  // namespace pirsim
