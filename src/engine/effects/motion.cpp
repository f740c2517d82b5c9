#include <algorithm>
#include <string>
#include <vector>

#include "engine/effects/kit.hpp"

// How people move while they sit and work.
// Assumed: they reach and leave their seats as the script says; what differs is what they do there.
// Method: actions and swings of the people in force are set before the study is compiled; src/body moves them.
// Sources: no measurement; each range is assumed, with its reason.

namespace pirsim::effects {
namespace {

// arm_motion: arms don't keep to the script.

void alter_arm_motion(StudyInForce& study, const EffectSpec& effect) {
  for_each_work(study, [&](action::Work& work) {
    work.arm_amplitude_m *= effect.parameters.at("amplitude_scale");
    work.arm_period_s *= effect.parameters.at("period_scale");
  });
}

Effect arm_motion() {
  return {.info = {.name = "arm_motion",
                   .family = Family::motion,
                   .stage = "body",
                   .summary = "Arms move by another distance or period than the script says.",
                   .fingerprint = "the arms' line in the spectrum moves or changes its height",
                   .confused_with = {"trunk_tilt", "body_size", "fidgeting"},
                   .parameters = {factor("amplitude_scale", 0.3, 1.8, 0.6, "assumed"),
                                  factor("period_scale", 0.83, 1.17, 1.0,
                                         "assumed: 2.5-3.5 s for the 3 s of Study A, kept by a person with a clock")},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage}},
          .alter = alter_arm_motion};
}

// trunk_tilt: the trunk doesn't keep to the script.

void alter_trunk_tilt(StudyInForce& study, const EffectSpec& effect) {
  for_each_work(study, [&](action::Work& work) {
    for (double& tilt : work.tilt_choices_deg) tilt *= effect.parameters.at("amplitude_scale");
    work.tilt_every_s *= effect.parameters.at("period_scale");
  });
}

Effect trunk_tilt() {
  return {.info = {.name = "trunk_tilt",
                   .family = Family::motion,
                   .stage = "body",
                   .summary = "Trunks tilt by another angle or period than the script says.",
                   .fingerprint = "the peak at every change of posture grows, shrinks or moves",
                   .confused_with = {"arm_motion", "clock_lag", "fidgeting"},
                   .parameters = {factor("amplitude_scale", 0.3, 1.8, 0.6, "assumed"),
                                  factor("period_scale", 0.7, 1.4, 1.0, "assumed")},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage, Survey::walk_test}},
          .alter = alter_trunk_tilt};
}

// natural_motion: people don't keep to the choreography: they move as people do.

/// What one does at a desk.
std::vector<std::string> activities() { return {activity_names.begin(), activity_names.begin() + 4}; }

void alter_natural_motion(StudyInForce& study, const EffectSpec& effect) {
  const auto which = std::ranges::find(activity_names, word(effect, "activity")) - activity_names.begin();
  for_each_person(study, [](PersonInForce& person) { person.style = MotionStyle::natural; });
  for_each_work(study, [&](action::Work& work) { work.activity = static_cast<Activity>(which); });
}

Effect natural_motion() {
  return {.info = {.name = "natural_motion",
                   .family = Family::motion,
                   .stage = "body",
                   .summary = "Everybody moves in the natural style instead of the paper's: still, then moving, at all "
                              "scales of time.",
                   .fingerprint = "the arms' line in the spectrum is gone; activity comes in bouts of all lengths",
                   .confused_with = {"fidgeting", "uneven_arms", "soft_zone_edges"},
                   .parameters = {whether("present", "assumed")},
                   .choices = {{"activity", ChoiceKind::variant, activities(), "typing"}},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage, Survey::walk_test}},
          .alter = alter_natural_motion};
}

// uneven_arms: nobody swings their arms like a clock.

void alter_uneven_arms(StudyInForce& study, const EffectSpec& effect) {
  const UnevenArmsSpec arms{effect.parameters.at("spread"), effect.parameters.at("pause_share")};
  for_each_person(study, [&](PersonInForce& person) { person.changes.uneven_arms = arms; });
}

Effect uneven_arms() {
  return {
      .info =
          {.name = "uneven_arms",
           .family = Family::motion,
           .stage = "body",
           .summary =
               "Each swing of the arms at desk work has an amplitude and a period of its own, and some are left out.",
           .fingerprint = "the arms' line in the spectrum is broad; gaps where arms rest",
           .confused_with = {"arm_motion", "missed_triggers", "natural_motion"},
           .parameters = {told_as("spread of the swings", strength("spread", "", 0.2, 0.05, 0.4, 1.0,
                                                                   "assumed: of the logarithm, about a mean of 1")),
                          strength("pause_share", "", 0.2, 0.0, 0.6, 1.0, "assumed: of the swings")},
           .reach = Reach::geometry,
           .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter_uneven_arms};
}

// trunk_sway: a seated person sways a little from side to side.

void alter_trunk_sway(StudyInForce& study, const EffectSpec& effect) {
  const SwingSpec sway{effect.parameters.at("amplitude_deg"), effect.parameters.at("period_s"), 1.0};
  for_each_person(study, [&](PersonInForce& person) { person.changes.trunk_sway = sway; });
}

Effect trunk_sway() {
  return {
      .info = {.name = "trunk_sway",
               .family = Family::motion,
               .stage = "body",
               .summary = "A seated person always sways from side to side: breathing, balancing, music.",
               .fingerprint = "activity at a steady rhythm, where a zone's edge lies on trunk or head",
               .confused_with = {"fidgeting", "soft_zone_edges", "arm_motion"},
               .parameters = {logarithmic(strength("amplitude_deg", "deg", 1.0, 0.3, 3.0, 12.0,
                                                   "assumed: to either side; quiet sitting to rocking")),
                              detail("period_s", "s", 4.0, 2.0, 6.0, 0.2, 60.0, "assumed: of breathing, or slower")},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter_trunk_sway};
}

// chair_swing: who sits swings on the chair.

void alter_chair_swing(StudyInForce& study, const EffectSpec& effect) {
  const SwingSpec swing{effect.parameters.at("amplitude_deg"), effect.parameters.at("period_s"),
                        effect.parameters.at("share")};
  for_each_person(study, [&](PersonInForce& person) { person.changes.chair_swing = swing; });
}

Effect chair_swing() {
  return {.info = {.name = "chair_swing",
                   .family = Family::motion,
                   .stage = "body",
                   .summary = "A seated person turns to and fro on the swivel chair, in bouts.",
                   .fingerprint = "bouts in which every sensor that sees the sitter is active",
                   .confused_with = {"fidgeting", "natural_motion", "soft_zone_edges"},
                   .parameters = {logarithmic(strength("amplitude_deg", "deg", 10.0, 3.0, 25.0, 60.0,
                                                       "assumed: to either side")),
                                  detail("period_s", "s", 3.0, 1.5, 6.0, 0.4, 60.0, "assumed"),
                                  told_as("share of the time", detail("share", "", 0.5, 0.1, 1.0, 0.0, 1.0,
                                                                      "assumed: of the time, in bouts of 20 s"))},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage, Survey::walk_test}},
          .alter = alter_chair_swing};
}

// fidgeting: people move though the script says nothing of it.

void alter_fidgeting(StudyInForce& study, const EffectSpec& effect) {
  const FidgetSpec fidgeting{
      effect.parameters.at("rate_per_s"), effect.parameters.at("tilt_deg"), effect.parameters.at("turn_deg"),
      word(effect, "timing") == "still_periods" ? FidgetTiming::still_periods : FidgetTiming::independent};
  for_each_person(study, [&](PersonInForce& person) { person.changes.fidgeting = fidgeting; });
}

Effect fidgeting() {
  return {.info = {.name = "fidgeting",
                   .family = Family::motion,
                   .stage = "body",
                   .summary = "A seated person leans a little or turns the head, at independent moments or with still "
                              "periods of all lengths in between.",
                   .fingerprint = "activity without the arms' phase, where a sensor sees head or trunk",
                   .confused_with = {"false_triggers", "soft_zone_edges", "pulse_stretching"},
                   .parameters = {logarithmic(strength("rate_per_s", "1/s", 0.1, 0.01, 0.5, 5.0,
                                                       "assumed: of moves, on average")),
                                  detail("tilt_deg", "deg", 4.0, 1.0, 10.0, 0.0, 15.0,
                                         "assumed: the trunk stays this close to its scripted tilt"),
                                  detail("turn_deg", "deg", 40.0, 10.0, 70.0, 0.0, 80.0,
                                         "assumed: the head stays this close to straight ahead")},
                   .choices = {{"timing", ChoiceKind::variant, {"independent", "still_periods"}, "independent"}},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage, Survey::walk_test}},
          .alter = alter_fidgeting};
}

}  // namespace

std::vector<Effect> motion_effects() {
  return {arm_motion(), trunk_tilt(), natural_motion(), uneven_arms(), trunk_sway(), chair_swing(), fidgeting()};
}

}  // namespace pirsim::effects
