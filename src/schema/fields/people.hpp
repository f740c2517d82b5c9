// Fields of people in scripts, and of what they do (schema/fields.hpp).
#pragma once

#include <array>
#include <tuple>

#include "pirsim/script.hpp"
#include "schema/field.hpp"
#include "schema/fields/accepted.hpp"
#include "schema/words.hpp"

namespace pirsim {

template <>
struct Fields<action::Wait> {
  using S = action::Wait;
  static constexpr const char* name = "Wait";
  static constexpr const char* about = "Goes on standing, sitting or lying.";
  static constexpr std::tuple all{
      FIELD(duration_s, accepted::waited_s),
      FIELD(activity,
            std::array{Activity::meeting, Activity::phone, Activity::whiteboard, Activity::reading, Activity::sleeping,
                       Activity::watching_tv, Activity::cooking, Activity::washing, Activity::eating},
            "of natural style")};
};
template <>
struct Fields<action::Appear> {
  using S = action::Appear;
  static constexpr const char* name = "Appear";
  static constexpr const char* about =
      "Is there from now on, without having entered: stands at the point, or is at the place as its posture says.";
  static constexpr std::tuple all{FIELD(point), FIELD(heading_deg, NumberRange{}, "0 facing -Z, positive turning left"),
                                  FIELD(place, "or seat, instead of a point"), FIELD(posture, "at a place to lie")};
};
template <>
struct Fields<action::Enter> {
  using S = action::Enter;
  static constexpr const char* name = "Enter";
  static constexpr const char* about = "Appears outside the entrance and walks in.";
  static constexpr std::tuple all{FIELD(entrance)};
};
template <>
struct Fields<action::Walk> {
  using S = action::Walk;
  static constexpr const char* name = "Walk";
  static constexpr const char* about = "Walks to each of the floor points in turn.";
  static constexpr std::tuple all{FIELD(points), FIELD(activity, std::array{Activity::phone}, "of natural style")};
};
template <>
struct Fields<action::Sit> {
  using S = action::Sit;
  static constexpr const char* name = "Sit";
  static constexpr const char* about =
      "Walks to the seat, turns and sits down; waits for it for a while if somebody else has it.";
  static constexpr std::tuple all{
      FIELD(seat),
      FIELD(wait_s, accepted::waited_s, "for a taken seat; no longer if all others have carried out their scripts"),
      FIELD(if_taken, "what somebody does whose seat stays taken")};
};
template <>
struct Fields<action::Lie> {
  using S = action::Lie;
  static constexpr const char* name = "Lie";
  static constexpr const char* about = "Walks to a place to lie, sits down on its edge and swings the legs in.";
  static constexpr std::tuple all{FIELD(place), FIELD(posture), FIELD(wait_s, accepted::waited_s, "for a taken place")};
};
template <>
struct Fields<action::Stand> {
  using S = action::Stand;
  static constexpr const char* name = "Stand";
  static constexpr const char* about = "Walks to a place to stand at, and faces as it does.";
  static constexpr std::tuple all{FIELD(place), FIELD(wait_s, accepted::waited_s, "for a taken place")};
};
template <>
struct Fields<action::Work> {
  using S = action::Work;
  static constexpr const char* name = "Work";
  static constexpr const char* about =
      "Desk work while seated: both forearms slide on the table, the spine changes its tilt.";
  static constexpr std::tuple all{
      FIELD(duration_s, accepted::worked_s),
      FIELD(arm_amplitude_m, NumberRange{.min = 0.0, .max = 0.15}),
      FIELD(arm_period_s, NumberRange{.min = 0.2, .max = 1e6}),
      FIELD(tilt_choices_deg, NumberRange{.min = -30.0, .max = 45.0}, "positive forward"),
      FIELD(tilt_every_s, accepted::worked_s),
      FIELD(activity, std::array{Activity::typing, Activity::reading, Activity::meeting, Activity::phone},
            "of natural style, which has no use for the swing and the tilts; none: typing")};
};
template <>
struct Fields<action::Rise> {
  using S = action::Rise;
  static constexpr const char* name = "Rise";
  static constexpr const char* about = "Rises from where one sits or lies, and stays standing beside it.";
  static constexpr std::tuple<> all{};
};
template <>
struct Fields<action::Leave> {
  using S = action::Leave;
  static constexpr const char* name = "Leave";
  static constexpr const char* about = "Walks out through the entrance and disappears.";
  static constexpr std::tuple all{FIELD(entrance)};
};
template <>
struct Fields<action::Turn> {
  using S = action::Turn;
  static constexpr const char* name = "Turn";
  static constexpr const char* about = "Stands on the spot and turns.";
  static constexpr std::tuple all{FIELD(heading_deg, accepted::turned_deg, "0 facing -Z, positive turning left")};
};
template <>
struct Fields<action::Follow> {
  using S = action::Follow;
  static constexpr const char* name = "Follow";
  static constexpr const char* about =
      "Is at these points at these times, and straight between them: appears at the first, vanishes after the last.";
  static constexpr std::tuple all{FIELD(times_s, "of the run, ascending"), FIELD(points),
                                  FIELD(headings_deg, "at each of them, or none: facing where they go")};
};
template <>
struct Fields<ScriptedAction> {
  using S = ScriptedAction;
  static constexpr const char* name = "ScriptedAction";
  static constexpr const char* about = "An action and when it begins.";
  static constexpr std::tuple all{
      FIELD(what),
      FIELD(at_s, accepted::at_s, "starts then: interrupts what goes on, or waits if that is already done"),
      FIELD(phase, "label of rows while this action runs; empty: what the body is doing"), LABEL(where)};
};
template <>
struct Fields<SeatScatterSpec> {
  using S = SeatScatterSpec;
  static constexpr const char* name = "SeatScatter";
  static constexpr const char* about = "How far from the seat's place people sit down, drawn once a run and person.";
  static constexpr std::tuple all{
      FIELD(position_sd_m, NumberRange{.min = 0.0, .max = 0.2}, "of each horizontal coordinate"),
      FIELD(heading_sd_deg, NumberRange{.min = 0.0, .max = 30.0})};
};
template <>
struct Fields<WarmthSpec> {
  using S = WarmthSpec;
  static constexpr const char* name = "Warmth";
  static constexpr const char* about = "How warm a person's surface is, for the physical response.";
  static constexpr std::tuple all{
      FIELD(skin_c, accepted::skin_c, "none: as the air's temperature has it"),
      FIELD(skin_above_k, NumberRange{.min = -10.0, .max = 10.0}, "by how much it is then warmer than others'"),
      FIELD(clothing_clo, NumberRange{.min = 0.0, .max = 10.0}, "insulation of the whole outfit"),
      FIELD(bare, "parts that show skin; hands always do"),
      FIELD(hair_share, NumberRange{.min = 0.0, .max = 1.0}, "of a bare head's surface that hair covers"),
      FIELD(parts_c, "surface temperatures that are known, by part")};
};
template <>
struct Fields<PersonSpec> {
  using S = PersonSpec;
  static constexpr const char* name = "Person";
  static constexpr const char* about = "A person and what they do, one action after the other.";
  static constexpr std::tuple all{
      FIELD(id),
      FIELD(actions),
      FIELD(stature_m, NumberRange{.min = 0.8, .max = 2.3}, "lengths of the body follow from it"),
      FIELD(mass_kg, NumberRange{.min = 10.0, .max = 250.0}),
      FIELD(walking_speed_m_s, NumberRange{.min = 0.1, .max = 3.0}),
      FIELD(seat_scatter),
      FIELD(style),
      FIELD(warmth),
      FIELD(body_mesh_file, "glTF, relative to `Script.directory`; its meshes are read by `read_script()`"),
      FIELD(body_meshes)};
};

}  // namespace pirsim
