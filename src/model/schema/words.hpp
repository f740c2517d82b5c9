// The words of enumerations, as files and Python have them: each is said here alone.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "pirsim/survey.hpp"

namespace pirsim {

/// Specialised for each enumeration: its values as words.
template <typename Enum>
struct Words;

template <typename T>
concept Worded = requires {
  Words<T>::all;
};

/// Values in order, and what they are called.
template <typename Enum, std::size_t n>
using WordList = std::array<std::pair<const char*, Enum>, n>;

template <>
struct Words<Solidity> {
  static constexpr WordList<Solidity, 2> all{{{"solid", Solidity::solid}, {"screen", Solidity::screen}}};
};
template <>
struct Words<DoorHinge> {
  static constexpr WordList<DoorHinge, 2> all{{{"left", DoorHinge::left}, {"right", DoorHinge::right}}};
};
template <>
struct Words<DoorOpens> {
  static constexpr WordList<DoorOpens, 2> all{{{"inward", DoorOpens::inward}, {"outward", DoorOpens::outward}}};
};
template <>
struct Words<DoorState> {
  static constexpr WordList<DoorState, 3> all{
      {{"open", DoorState::open}, {"shut", DoorState::shut}, {"habit", DoorState::habit}}};
};
template <>
struct Words<Response> {
  static constexpr WordList<Response, 3> all{
      {{"zones", Response::zones}, {"analog", Response::analog}, {"beam", Response::beam}}};
};
template <>
struct Words<PlacementAim> {
  static constexpr WordList<PlacementAim, 3> all{
      {{"area", PlacementAim::area}, {"seats", PlacementAim::seats}, {"false_off", PlacementAim::false_off}}};
};
template <>
struct Words<ArmSwing> {
  static constexpr WordList<ArmSwing, 2> all{{{"horizontal", ArmSwing::horizontal}, {"vertical", ArmSwing::vertical}}};
};
template <>
struct Words<PulseSigns> {
  static constexpr WordList<PulseSigns, 2> all{{{"any", PulseSigns::any}, {"alternating", PulseSigns::alternating}}};
};
template <>
struct Words<RaysPerZone> {
  static constexpr WordList<RaysPerZone, 4> all{
      {{"1", RaysPerZone::one}, {"5", RaysPerZone::five}, {"9", RaysPerZone::nine}, {"16", RaysPerZone::sixteen}}};
};
template <>
struct Words<ChangePer> {
  static constexpr WordList<ChangePer, 2> all{{{"cluster", ChangePer::cluster}, {"beam", ChangePer::beam}}};
};
template <>
struct Words<Units> {
  static constexpr WordList<Units, 4> all{
      {{"typical", Units::typical}, {"low", Units::low}, {"guaranteed", Units::guaranteed}, {"drawn", Units::drawn}}};
};
template <>
struct Words<Reader> {
  static constexpr WordList<Reader, 2> all{{{"in_step", Reader::in_step}, {"free_running", Reader::free_running}}};
};
template <>
struct Words<AfterStay> {
  static constexpr WordList<AfterStay, 2> all{{{"goes_on", AfterStay::goes_on}, {"leaves", AfterStay::leaves}}};
};
template <>
struct Words<MotionStyle> {
  static constexpr WordList<MotionStyle, 2> all{
      {{"choreographed", MotionStyle::choreographed}, {"natural", MotionStyle::natural}}};
};
template <>
struct Words<Activity> {
  static constexpr auto all = [] {
    WordList<Activity, activity_names.size()> words{};
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = {activity_names[i], static_cast<Activity>(i)};
    return words;
  }();
};
template <>
struct Words<PlacePosture> {
  static constexpr WordList<PlacePosture, 2> all{{{"lie", PlacePosture::lie}, {"stand", PlacePosture::stand}}};
};
template <>
struct Words<LyingPosture> {
  static constexpr WordList<LyingPosture, 4> all{{{"back", LyingPosture::back},
                                                  {"left_side", LyingPosture::left_side},
                                                  {"right_side", LyingPosture::right_side},
                                                  {"half_lying", LyingPosture::half_lying}}};
};
template <>
struct Words<action::IfTaken> {
  static constexpr WordList<action::IfTaken, 2> all{
      {{"next_action", action::IfTaken::next_action}, {"other_seat", action::IfTaken::other_seat}}};
};
template <>
struct Words<Attendees> {
  static constexpr WordList<Attendees, 2> all{{{"guests", Attendees::guests}, {"staff", Attendees::staff}}};
};
template <>
struct Words<Role> {
  static constexpr WordList<Role, 3> all{
      {{"staff", Role::staff}, {"manager", Role::manager}, {"administrator", Role::administrator}}};
};
template <>
struct Words<Occupation> {
  static constexpr WordList<Occupation, 3> all{
      {{"works", Occupation::works}, {"at_home", Occupation::at_home}, {"works_at_home", Occupation::works_at_home}}};
};
template <>
struct Words<PetKind> {
  static constexpr WordList<PetKind, 2> all{{{"cat", PetKind::cat}, {"dog", PetKind::dog}}};
};
template <>
struct Words<Severity> {
  static constexpr WordList<Severity, 2> all{{{"warning", Severity::warning}, {"error", Severity::error}}};
};

/// What a value is called.
template <Worded Enum>
[[nodiscard]] constexpr const char* word_of(Enum value) {
  for (const auto& [word, meaning] : Words<Enum>::all) {
    if (meaning == value) return word;
  }
  return "";
}

// What the thirteen parts of a body are called in files.

/// In the order of body::Part.
inline constexpr std::array<std::string_view, 13> body_part_names{
    "pelvis",     "torso",       "head",       "left_upper_arm", "right_upper_arm", "left_forearm", "right_forearm",
    "left_thigh", "right_thigh", "left_shank", "right_shank",    "left_foot",       "right_foot"};

// What goes on in a row, in words; a script's own names of phases come beside these.

/// Of a person who isn't there.
inline constexpr std::string_view phase_outside = "outside";
/// Of a person who carries out `work`.
inline constexpr std::string_view phase_working = "working";
/// Of a person otherwise; in the order of body::Stage.
inline constexpr std::array<std::string_view, 9> phases_of_body{
    "standing", "walking", "turning", "sitting_down", "seated", "rising", "lying_down", "lying", "getting_up"};
/// Of a room by a schedule.
inline constexpr std::string_view phase_empty = "empty", phase_occupied = "occupied", phase_meeting = "meeting",
                                  phase_cleaning = "cleaning";
/// Of a home in which everybody sleeps or goes to bed. If somebody is up, the areas in which all do so follow: "asleep
/// in bedroom + nursery".
inline constexpr std::string_view phase_asleep = "asleep", asleep_in = "asleep in ", asleep_and = " + ";

/// Does everybody sleep, in a row with this phase, who is in the area? No name: in all of the home.
[[nodiscard]] inline bool sleep_all(std::string_view phase, std::string_view area) {
  if (!phase.starts_with(asleep_in)) return phase == phase_asleep;
  phase.remove_prefix(asleep_in.size());
  for (std::size_t end = 0; end < phase.size() && !area.empty(); phase.remove_prefix(end + asleep_and.size())) {
    end = std::min(phase.find(asleep_and), phase.size());
    if (phase.substr(0, end) == area) return true;
    if (end == phase.size()) break;
  }
  return false;
}

}  // namespace pirsim
