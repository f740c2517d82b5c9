// What the specs are called in Python, and what they hold: one entry a spec. python/pirsim/specs.py has the same as
// dataclasses; a test compares the two.
#pragma once

#include <array>
#include <cstddef>
#include <pirsim/effects.hpp>
#include <pirsim/pirsim.hpp>
#include <tuple>
#include <type_traits>
#include <utility>

namespace pirsim::python {

template <typename Spec, typename Value>
struct Field {
  const char* name;
  Value Spec::*member;
};

/// Specialised for each spec: `name` in Python and `all` fields.
template <typename Spec>
struct Fields;

/// Doesn't compile for a spec that has another number of fields than n.
template <std::size_t n, typename Spec>
constexpr bool has_fields() {
  [[maybe_unused]] const auto take = [](Spec& spec) {
    // clang-format off
    if constexpr (n == 1) { auto& [a] = spec; (void)a; }
    else if constexpr (n == 2) { auto& [a, b] = spec; (void)a; }
    else if constexpr (n == 3) { auto& [a, b, c] = spec; (void)a; }
    else if constexpr (n == 4) { auto& [a, b, c, d] = spec; (void)a; }
    else if constexpr (n == 5) { auto& [a, b, c, d, e] = spec; (void)a; }
    else if constexpr (n == 6) { auto& [a, b, c, d, e, f] = spec; (void)a; }
    else if constexpr (n == 7) { auto& [a, b, c, d, e, f, g] = spec; (void)a; }
    else if constexpr (n == 8) { auto& [a, b, c, d, e, f, g, h] = spec; (void)a; }
    else if constexpr (n == 9) { auto& [a, b, c, d, e, f, g, h, i] = spec; (void)a; }
    else if constexpr (n == 10) { auto& [a, b, c, d, e, f, g, h, i, j] = spec; (void)a; }
    else if constexpr (n == 11) { auto& [a, b, c, d, e, f, g, h, i, j, k] = spec; (void)a; }
    else if constexpr (n == 12) { auto& [a, b, c, d, e, f, g, h, i, j, k, l] = spec; (void)a; }
    else if constexpr (n == 14) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o] = spec; (void)a; }
    else if constexpr (n == 15) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = spec; (void)a; }
    else static_assert(n == 0 && std::is_empty_v<Spec>);
    // clang-format on
  };
  return true;
}

/// Specialised for each enumeration: its values as words, as scripts have them.
template <typename Enum>
struct Words;

template <>
struct Words<Solidity> {
  static constexpr std::array all{std::pair{"solid", Solidity::solid}, std::pair{"screen", Solidity::screen}};
};
template <>
struct Words<Response> {
  static constexpr std::array all{std::pair{"zones", Response::zones}, std::pair{"analog", Response::analog}};
};
template <>
struct Words<PulseSigns> {
  static constexpr std::array all{std::pair{"any", PulseSigns::any}, std::pair{"alternating", PulseSigns::alternating}};
};
template <>
struct Words<ChangePer> {
  static constexpr std::array all{std::pair{"cluster", ChangePer::cluster}, std::pair{"beam", ChangePer::beam}};
};
template <>
struct Words<Reader> {
  static constexpr std::array all{std::pair{"in_step", Reader::in_step},
                                  std::pair{"free_running", Reader::free_running}};
};
template <>
struct Words<MotionStyle> {
  static constexpr std::array all{std::pair{"choreographed", MotionStyle::choreographed},
                                  std::pair{"natural", MotionStyle::natural}};
};
template <>
struct Words<Activity> {
  static constexpr std::array all{std::pair{"typing", Activity::typing}, std::pair{"reading", Activity::reading},
                                  std::pair{"meeting", Activity::meeting}, std::pair{"phone", Activity::phone},
                                  std::pair{"whiteboard", Activity::whiteboard}};
};
template <>
struct Words<action::IfTaken> {
  static constexpr std::array all{std::pair{"next_action", action::IfTaken::next_action},
                                  std::pair{"other_seat", action::IfTaken::other_seat}};
};
template <>
struct Words<Role> {
  static constexpr std::array all{std::pair{"staff", Role::staff}, std::pair{"manager", Role::manager},
                                  std::pair{"administrator", Role::administrator}};
};
template <>
struct Words<Severity> {
  static constexpr std::array all{std::pair{"warning", Severity::warning}, std::pair{"error", Severity::error}};
};
template <>
struct Words<IncidentKind> {
  static constexpr std::array all{
      std::pair{"passed_through", IncidentKind::passed_through}, std::pair{"seat_changed", IncidentKind::seat_changed},
      std::pair{"seat_missed", IncidentKind::seat_missed}, std::pair{"waited_outside", IncidentKind::waited_outside}};
};
template <>
struct Words<effects::Reach> {
  static constexpr std::array all{std::pair{"geometry", effects::Reach::geometry},
                                  std::pair{"triggers", effects::Reach::triggers},
                                  std::pair{"rows", effects::Reach::rows}};
};

template <>
struct Fields<Where> {
  static constexpr const char* name = "Where";
  static constexpr std::tuple all{Field{"file", &Where::file}, Field{"line", &Where::line},
                                  Field{"column", &Where::column}};
};

template <>
struct Fields<InputFile> {
  static constexpr const char* name = "InputFile";
  static constexpr std::tuple all{Field{"path", &InputFile::path}, Field{"sha256", &InputFile::sha256}};
};

// Scenes.

template <>
struct Fields<SensorSpec> {
  static constexpr const char* name = "Sensor";
  static constexpr std::tuple all{Field{"id", &SensorSpec::id}, Field{"model", &SensorSpec::model},
                                  Field{"world_from_sensor", &SensorSpec::world_from_sensor}};
};
template <>
struct Fields<SeatSpec> {
  static constexpr const char* name = "Seat";
  static constexpr std::tuple all{Field{"id", &SeatSpec::id}, Field{"world_from_seat", &SeatSpec::world_from_seat}};
};
template <>
struct Fields<EntranceSpec> {
  static constexpr const char* name = "Entrance";
  static constexpr std::tuple all{
      Field{"id", &EntranceSpec::id}, Field{"world_from_entrance", &EntranceSpec::world_from_entrance},
      Field{"width_m", &EntranceSpec::width_m}, Field{"outside_m", &EntranceSpec::outside_m}};
};
template <>
struct Fields<SceneSpec> {
  static constexpr const char* name = "Scene";
  static constexpr std::tuple all{Field{"name", &SceneSpec::name},
                                  Field{"meshes", &SceneSpec::meshes},
                                  Field{"sensors", &SceneSpec::sensors},
                                  Field{"seats", &SceneSpec::seats},
                                  Field{"entrances", &SceneSpec::entrances},
                                  Field{"floor", &SceneSpec::floor},
                                  Field{"sensor_models", &SceneSpec::sensor_models},
                                  Field{"files", &SceneSpec::files},
                                  Field{"warnings", &SceneSpec::warnings}};
};

// Sensors.

template <>
struct Fields<OpticsSpec> {
  static constexpr const char* name = "Optics";
  static constexpr std::tuple all{Field{"blur_deg", &OpticsSpec::blur_deg},
                                  Field{"aperture_mm2", &OpticsSpec::aperture_mm2}};
};
template <>
struct Fields<ElementSpec> {
  static constexpr const char* name = "Element";
  static constexpr std::tuple all{Field{"thermal_s", &ElementSpec::thermal_s},
                                  Field{"electrical_s", &ElementSpec::electrical_s}};
};
template <>
struct Fields<AmplifierSpec> {
  static constexpr const char* name = "Amplifier";
  static constexpr std::tuple all{
      Field{"low_hz", &AmplifierSpec::low_hz},         Field{"high_hz", &AmplifierSpec::high_hz},
      Field{"order", &AmplifierSpec::order},           Field{"volts_per_watt", &AmplifierSpec::volts_per_watt},
      Field{"noise_v_pp", &AmplifierSpec::noise_v_pp}, Field{"offset_v", &AmplifierSpec::offset_v},
      Field{"lowest_v", &AmplifierSpec::lowest_v},     Field{"highest_v", &AmplifierSpec::highest_v}};
};
template <>
struct Fields<ComparatorSpec> {
  static constexpr const char* name = "Comparator";
  static constexpr std::tuple all{
      Field{"positive_v", &ComparatorSpec::positive_v},   Field{"negative_v", &ComparatorSpec::negative_v},
      Field{"pulse_count", &ComparatorSpec::pulse_count}, Field{"pulse_window_s", &ComparatorSpec::pulse_window_s},
      Field{"pulse_signs", &ComparatorSpec::pulse_signs}, Field{"hold_s", &ComparatorSpec::hold_s},
      Field{"blind_s", &ComparatorSpec::blind_s}};
};
template <>
struct Fields<DetectorSpec> {
  static constexpr const char* name = "Detector";
  static constexpr std::tuple all{Field{"element", &DetectorSpec::element},
                                  Field{"amplifier", &DetectorSpec::amplifier},
                                  Field{"comparator", &DetectorSpec::comparator}};
};
template <>
struct Fields<ZoneSpec> {
  static constexpr const char* name = "Zone";
  static constexpr std::tuple all{Field{"corners", &ZoneSpec::corners}, Field{"polarity", &ZoneSpec::polarity}};
};
template <>
struct Fields<ClusterSpec> {
  static constexpr const char* name = "Cluster";
  static constexpr std::tuple all{Field{"centre", &ClusterSpec::centre}, Field{"range_m", &ClusterSpec::range_m},
                                  Field{"lens_step", &ClusterSpec::lens_step}, Field{"zones", &ClusterSpec::zones}};
};
template <>
struct Fields<SensorModelSpec> {
  static constexpr const char* name = "SensorModel";
  static constexpr std::tuple all{Field{"id", &SensorModelSpec::id},
                                  Field{"description", &SensorModelSpec::description},
                                  Field{"plane_m", &SensorModelSpec::plane_m},
                                  Field{"clusters", &SensorModelSpec::clusters},
                                  Field{"response", &SensorModelSpec::response},
                                  Field{"optics", &SensorModelSpec::optics},
                                  Field{"detector", &SensorModelSpec::detector}};
};

// Scripts.

template <>
struct Fields<action::Wait> {
  static constexpr const char* name = "Wait";
  static constexpr std::tuple all{Field{"duration_s", &action::Wait::duration_s},
                                  Field{"activity", &action::Wait::activity}};
};
template <>
struct Fields<action::Appear> {
  static constexpr const char* name = "Appear";
  static constexpr std::tuple all{Field{"point", &action::Appear::point},
                                  Field{"heading_deg", &action::Appear::heading_deg}};
};
template <>
struct Fields<action::Enter> {
  static constexpr const char* name = "Enter";
  static constexpr std::tuple all{Field{"entrance", &action::Enter::entrance}};
};
template <>
struct Fields<action::Walk> {
  static constexpr const char* name = "Walk";
  static constexpr std::tuple all{Field{"points", &action::Walk::points}, Field{"activity", &action::Walk::activity}};
};
template <>
struct Fields<action::Sit> {
  static constexpr const char* name = "Sit";
  static constexpr std::tuple all{Field{"seat", &action::Sit::seat}, Field{"wait_s", &action::Sit::wait_s},
                                  Field{"if_taken", &action::Sit::if_taken}};
};
template <>
struct Fields<action::Work> {
  static constexpr const char* name = "Work";
  static constexpr std::tuple all{
      Field{"duration_s", &action::Work::duration_s},     Field{"arm_amplitude_m", &action::Work::arm_amplitude_m},
      Field{"arm_period_s", &action::Work::arm_period_s}, Field{"tilt_choices_deg", &action::Work::tilt_choices_deg},
      Field{"tilt_every_s", &action::Work::tilt_every_s}, Field{"activity", &action::Work::activity}};
};
template <>
struct Fields<action::Rise> {
  static constexpr const char* name = "Rise";
  static constexpr std::tuple<> all{};
};
template <>
struct Fields<action::Leave> {
  static constexpr const char* name = "Leave";
  static constexpr std::tuple all{Field{"entrance", &action::Leave::entrance}};
};
template <>
struct Fields<action::Turn> {
  static constexpr const char* name = "Turn";
  static constexpr std::tuple all{Field{"heading_deg", &action::Turn::heading_deg}};
};
template <>
struct Fields<SeatScatterSpec> {
  static constexpr const char* name = "SeatScatter";
  static constexpr std::tuple all{Field{"position_sd_m", &SeatScatterSpec::position_sd_m},
                                  Field{"heading_sd_deg", &SeatScatterSpec::heading_sd_deg}};
};
template <>
struct Fields<WarmthSpec> {
  static constexpr const char* name = "Warmth";
  static constexpr std::tuple all{Field{"skin_c", &WarmthSpec::skin_c},
                                  Field{"clothing_clo", &WarmthSpec::clothing_clo}, Field{"bare", &WarmthSpec::bare},
                                  Field{"parts_c", &WarmthSpec::parts_c}};
};
template <>
struct Fields<PersonSpec> {
  static constexpr const char* name = "Person";
  static constexpr std::tuple all{Field{"id", &PersonSpec::id},
                                  Field{"actions", &PersonSpec::actions},
                                  Field{"stature_m", &PersonSpec::stature_m},
                                  Field{"mass_kg", &PersonSpec::mass_kg},
                                  Field{"walking_speed_m_s", &PersonSpec::walking_speed_m_s},
                                  Field{"seat_scatter", &PersonSpec::seat_scatter},
                                  Field{"style", &PersonSpec::style},
                                  Field{"warmth", &PersonSpec::warmth},
                                  Field{"body_mesh_file", &PersonSpec::body_mesh_file},
                                  Field{"body_meshes", &PersonSpec::body_meshes}};
};
template <>
struct Fields<ClockSpec> {
  static constexpr const char* name = "Clock";
  static constexpr std::tuple all{Field{"mean_h", &ClockSpec::mean_h}, Field{"sd_min", &ClockSpec::sd_min}};
};
template <>
struct Fields<StaffSpec> {
  static constexpr const char* name = "Staff";
  static constexpr std::tuple all{Field{"role", &StaffSpec::role}, Field{"count", &StaffSpec::count},
                                  Field{"seats", &StaffSpec::seats}, Field{"where", &StaffSpec::where}};
};
template <>
struct Fields<HeldMeetingSpec> {
  static constexpr const char* name = "HeldMeeting";
  static constexpr std::tuple all{Field{"at_h", &HeldMeetingSpec::at_h},
                                  Field{"duration_min", &HeldMeetingSpec::duration_min},
                                  Field{"people", &HeldMeetingSpec::people}, Field{"where", &HeldMeetingSpec::where}};
};
template <>
struct Fields<MeetingsSpec> {
  static constexpr const char* name = "Meetings";
  static constexpr std::tuple all{Field{"fewest_a_day", &MeetingsSpec::fewest_a_day},
                                  Field{"most_a_day", &MeetingsSpec::most_a_day},
                                  Field{"fewest_people", &MeetingsSpec::fewest_people},
                                  Field{"most_people", &MeetingsSpec::most_people},
                                  Field{"durations_min", &MeetingsSpec::durations_min},
                                  Field{"probabilities", &MeetingsSpec::probabilities},
                                  Field{"from_h", &MeetingsSpec::from_h},
                                  Field{"to_h", &MeetingsSpec::to_h},
                                  Field{"lateness_min", &MeetingsSpec::lateness_min},
                                  Field{"held", &MeetingsSpec::held},
                                  Field{"seats", &MeetingsSpec::seats},
                                  Field{"where", &MeetingsSpec::where}};
};
template <>
struct Fields<ProfileSpec> {
  static constexpr const char* name = "Profile";
  static constexpr std::tuple all{Field{"presence", &ProfileSpec::presence}, Field{"mobility", &ProfileSpec::mobility},
                                  Field{"step_min", &ProfileSpec::step_min}};
};
template <>
struct Fields<ScheduleSpec> {
  static constexpr const char* name = "Schedule";
  static constexpr std::tuple all{Field{"first_day", &ScheduleSpec::first_day},
                                  Field{"from_h", &ScheduleSpec::from_h},
                                  Field{"to_h", &ScheduleSpec::to_h},
                                  Field{"staff", &ScheduleSpec::staff},
                                  Field{"meetings", &ScheduleSpec::meetings},
                                  Field{"profile", &ScheduleSpec::profile},
                                  Field{"arrival", &ScheduleSpec::arrival},
                                  Field{"departure", &ScheduleSpec::departure},
                                  Field{"lunch", &ScheduleSpec::lunch},
                                  Field{"lunch_min", &ScheduleSpec::lunch_min},
                                  Field{"lunch_sd_min", &ScheduleSpec::lunch_sd_min},
                                  Field{"cleaning_h", &ScheduleSpec::cleaning_h},
                                  Field{"entrances", &ScheduleSpec::entrances},
                                  Field{"style", &ScheduleSpec::style},
                                  Field{"where", &ScheduleSpec::where}};
};
template <>
struct Fields<TrialSpec> {
  static constexpr const char* name = "Trial";
  static constexpr std::tuple all{Field{"id", &TrialSpec::id}, Field{"people", &TrialSpec::people},
                                  Field{"duration_s", &TrialSpec::duration_s}, Field{"schedule", &TrialSpec::schedule}};
};
template <>
struct Fields<SensingSpec> {
  static constexpr const char* name = "Sensing";
  static constexpr std::tuple all{Field{"tick_rate_hz", &SensingSpec::tick_rate_hz},
                                  Field{"ticks_per_window", &SensingSpec::ticks_per_window},
                                  Field{"rays_per_zone", &SensingSpec::rays_per_zone},
                                  Field{"change_per", &SensingSpec::change_per},
                                  Field{"reader", &SensingSpec::reader},
                                  Field{"response", &SensingSpec::response},
                                  Field{"ambient_c", &SensingSpec::ambient_c},
                                  Field{"analog_rays_per_zone", &SensingSpec::analog_rays_per_zone}};
};
template <>
struct Fields<SummarySpec> {
  static constexpr const char* name = "Summary";
  static constexpr std::tuple all{Field{"phases", &SummarySpec::phases},
                                  Field{"reference_file", &SummarySpec::reference_file}};
};
template <>
struct Fields<EffectSpec> {
  static constexpr const char* name = "Effect";
  static constexpr std::tuple all{Field{"name", &EffectSpec::name}, Field{"parameters", &EffectSpec::parameters},
                                  Field{"choices", &EffectSpec::choices}, Field{"where", &EffectSpec::where}};
};
template <>
struct Fields<ScriptSpec> {
  static constexpr const char* name = "Script";
  static constexpr std::tuple all{
      Field{"name", &ScriptSpec::name},           Field{"trials", &ScriptSpec::trials},
      Field{"seed", &ScriptSpec::seed},           Field{"replicates", &ScriptSpec::replicates},
      Field{"sensing", &ScriptSpec::sensing},     Field{"effects", &ScriptSpec::effects},
      Field{"summary", &ScriptSpec::summary},     Field{"begin", &ScriptSpec::begin},
      Field{"directory", &ScriptSpec::directory}, Field{"files", &ScriptSpec::files},
      Field{"warnings", &ScriptSpec::warnings}};
};

}  // namespace pirsim::python
