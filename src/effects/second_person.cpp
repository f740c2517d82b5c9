// Somebody else is there of whom the script doesn't know.
#include <cmath>
#include <string>

#include "effects/bystander.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::effects {
namespace {

constexpr double clear_m = 0.4;

std::vector<Action> stands(const EffectSpec& effect, const Vec2& place) {
  const double every_s = effect.parameters.at("every_s"), heading_deg = effect.parameters.at("heading_deg");
  const double path_m = effect.parameters.at("path_m");
  std::vector<Action> actions;
  if (path_m > 0.0) {
    for (const Vec2& end : {place + path_m * direction_of(radians(heading_deg)), place}) {
      actions.emplace_back(action::Wait{every_s});
      actions.emplace_back(action::Walk{{end}});
    }
    return actions;
  }
  for (const double turn_deg : {120.0, 240.0, 0.0}) {  // assumed: turns to each of three sides
    actions.emplace_back(action::Wait{every_s});
    actions.emplace_back(action::Turn{std::remainder(heading_deg + turn_deg, 360.0)});
  }
  return actions;
}

std::vector<Action> wanders(const EffectSpec& effect, const SceneSpec& scene, const Vec2& place) {
  std::vector<Action> actions;
  for (const Vec2& stop : round_trip(scene, clear_m, place)) {
    actions.emplace_back(action::Walk{{stop}});
    actions.emplace_back(action::Wait{effect.parameters.at("every_s")});
  }
  return actions;
}

void alter(StudyInForce& study, const EffectSpec& effect) {
  const Vec2 place = place_of(effect, study.scene, clear_m);
  BystanderPlan plan{.id = "second person", .place = place, .heading_deg = effect.parameters.at("heading_deg")};
  plan.again = word(effect, "moves") == "wanders" ? wanders(effect, study.scene, place) : stands(effect, place);
  add_bystander(study, plan, effect.where);
}

void draw(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  draw_place(effect, scene, clear_m, stream);
}

void settle(EffectSpec& effect, const SceneSpec& scene) { settle_place(effect, scene, clear_m); }

}  // namespace

const Effect& second_person() {
  static const Effect effect{
      .info = {.name = "second_person",
               .family = Family::motion,
               .stage = "body",
               .summary = "Somebody else is in the room for all of every trial: stands and turns, walks to and fro, or "
                          "wanders from one free place to the next.",
               .fingerprint = "sensors are active together that the scripted person can't reach at once",
               .confused_with = {"false_triggers", "trigger_bursts", "warm_object"},
               .parameters = {whether("present", "assumed"), place_coordinate("x_m"), place_coordinate("z_m"),
                              detail("heading_deg", "deg", 0.0, -180.0, 180.0, -360.0, 360.0, "any"),
                              detail("path_m", "m", 0.0, 0.0, 0.0, 0.0, 100.0,
                                     "assumed: how far to walk that way and back; 0: turns on the spot. Not drawn: "
                                     "whether there is room to walk depends on the place",
                                     {"moves", "stands"}),
                              detail("every_s", "s", 10.0, 5.0, 30.0, 0.5, 3600.0, "assumed: between two moves")},
               .choices = {{"moves", ChoiceKind::variant, {"stands", "wanders"}, "stands"}, place_choice()},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter,
      .draw = draw,
      .settle = settle};
  return effect;
}

}  // namespace pirsim::effects
