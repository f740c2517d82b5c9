#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/effects/kit.hpp"
#include "model/schema/actions.hpp"
#include "pirsim/geometry.hpp"

// Somebody or something warm in the room of whom the script doesn't know.

namespace pirsim::effects {

/// What one of them does, again and again until the longest trial is over.
struct BystanderPlan {
  std::string_view id;  ///< several in one room go by numbers
  PersonRole role = PersonRole::bystander;
  double stature_m = 1.75;
  double mass_kg = 75.0;
  double speed_m_s = 1.2;
  Vec2 place;  ///< where they are at the beginning
  double heading_deg = 0.0;
  std::vector<Action> again{};
};
/// Adds one to every trial.
void add_bystander(StudyInForce& study, const BystanderPlan& plan, const Where& where);

/// Several free places, far from each other, as one walks from the first through the others.
[[nodiscard]] std::vector<Vec2> round_trip(const SceneSpec& scene, double clear_m, const Vec2& from);

// Parameters and hooks of effects that have a place: `place: free` (the one farthest from all seats) or `given`.

[[nodiscard]] ChoiceInfo place_choice();
[[nodiscard]] ParameterInfo place_coordinate(std::string name);
/// Throws Error(infeasible) if it is to be a free one and there is none.
[[nodiscard]] Vec2 place_of(const EffectSpec& effect, const SceneSpec& scene, double clear_m);
void draw_place(EffectSpec& effect, const SceneSpec& scene, double clear_m, Stream& stream);
void settle_place(EffectSpec& effect, const SceneSpec& scene, double clear_m);

namespace {

/// Once across the room, and as much again to get round what stands there.
double longest_way_m(const SceneSpec& scene) { return 2.0 * glm::distance(scene.floor.lower(), scene.floor.upper()); }

/// An upper bound of how long a trial may last, seconds. It waits for nobody but its subjects.
double longest_s(const TrialInForce& trial, const SceneSpec& scene) {
  double longest = trial.duration_s.value_or(0.0);  // a day's too
  for (const PersonInForce& person : trial.people) {
    if (person.changes.role != PersonRole::subject) continue;
    const double way_s = longest_way_m(scene) / person.walking_speed_m_s;
    double sum = 0.0;
    for (const ScriptedAction& action : person.actions) {
      constexpr double any_s = 60.0;  // turning, sitting down: more than enough
      const ActionFacts facts = facts_of(action.what);
      sum += any_s + way_s + action.at_s.value_or(0.0);
      if (facts.follows != nullptr && !facts.follows->times_s.empty()) sum += facts.follows->times_s.back();
      sum += facts.lasts_s + way_s * static_cast<double>(facts.walks_to.size());
    }
    longest = std::max(longest, sum);
  }
  return longest;
}

/// What all that is done again takes at least, seconds.
double once_around_s(const BystanderPlan& plan) {
  constexpr double least_s = 1.0;  // so that their number is bounded, whatever they are
  double sum = 0.0;
  Vec2 at = plan.place;
  for (const Action& what : plan.again) sum += shortest_s(facts_of(what), plan.speed_m_s, at);
  return std::max(least_s, sum);
}

std::string new_id(const TrialInForce& trial, std::string_view id) {
  const auto others = std::ranges::count_if(trial.people, [&](const auto& p) { return p.id.starts_with(id); });
  return others == 0 ? std::string(id) : std::string(id) + " " + std::to_string(others + 1);
}

}  // namespace

void add_bystander(StudyInForce& study, const BystanderPlan& plan, const Where& where) {
  for (TrialInForce& trial : study.trials) {
    PersonInForce person;
    person.id = new_id(trial, plan.id);
    person.changes.role = plan.role;
    person.stature_m = plan.stature_m;
    person.mass_kg = plan.mass_kg;
    person.walking_speed_m_s = plan.speed_m_s;
    person.actions.push_back({action::Appear{plan.place, plan.heading_deg}, {}, {}, where});
    const double until_s = longest_s(trial, study.scene), once_s = once_around_s(plan);
    for (double s = 0.0; s < until_s; s += once_s) {
      for (const Action& what : plan.again) person.actions.push_back({what, {}, {}, where});
    }
    trial.people.push_back(std::move(person));
  }
}

std::vector<Vec2> round_trip(const SceneSpec& scene, double clear_m, const Vec2& from) {
  constexpr std::size_t most = 5;  // assumed
  constexpr double apart_m = 1.0;  // assumed: else one walks hardly at all
  std::vector<Vec2> stops{from};
  const auto nearest_m = [&](const Vec2& p) {
    double nearest = glm::distance(p, from);
    for (const Vec2& stop : stops) nearest = std::min(nearest, glm::distance(p, stop));
    return nearest;
  };
  const std::vector<Vec2> places = free_places(scene, clear_m);
  while (stops.size() < most && !places.empty()) {
    const Vec2 next = *std::ranges::max_element(places, {}, nearest_m);
    if (nearest_m(next) < apart_m) break;
    stops.push_back(next);
  }
  return stops;
}

ChoiceInfo place_choice() {
  return {"place", ChoiceKind::word, {"free", "given"}, "the free place farthest from all seats"};
}

ParameterInfo place_coordinate(std::string name) { return floor_coordinate(std::move(name), {"place", "given"}); }

Vec2 place_of(const EffectSpec& effect, const SceneSpec& scene, double clear_m) {
  if (word(effect, "place") == "given") return {effect.parameters.at("x_m"), effect.parameters.at("z_m")};
  const std::vector<Vec2> places = free_places(scene, clear_m);
  if (!places.empty()) return places.front();
  throw Error(ErrorCode::infeasible, effect.where, effect.name + ": no free place in " + scene.name);
}

void draw_place(EffectSpec& effect, const SceneSpec& scene, double clear_m, Stream& stream) {
  effect.choices["place"] = draw_free_place(effect, scene, clear_m, stream) ? "given" : "free";
}

void settle_place(EffectSpec& effect, const SceneSpec& scene, double clear_m) {
  if (word(effect, "place") == "given") settle_free_place(effect, scene, clear_m);
}

// Who is in the room, where exactly they sit and how large they are.
// Assumed: whoever the script doesn't know keeps out of the others' way and stays for all of every trial.
// Method: people are added to the trials of the study in force, or those there are moved and scaled, before it is
// compiled. Sources: no measurement; each range is assumed, with its reason.

namespace {

// second_person: somebody else is there of whom the script doesn't know.

constexpr double person_clear_m = 0.4;

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
  for (const Vec2& stop : round_trip(scene, person_clear_m, place)) {
    actions.emplace_back(action::Walk{{stop}});
    actions.emplace_back(action::Wait{effect.parameters.at("every_s")});
  }
  return actions;
}

void alter_second_person(StudyInForce& study, const EffectSpec& effect) {
  const Vec2 place = place_of(effect, study.scene, person_clear_m);
  BystanderPlan plan{.id = "second person", .place = place, .heading_deg = effect.parameters.at("heading_deg")};
  plan.again = word(effect, "moves") == "wanders" ? wanders(effect, study.scene, place) : stands(effect, place);
  add_bystander(study, plan, effect.where);
}

void draw_second_person(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  draw_place(effect, scene, person_clear_m, stream);
}

void settle_second_person(EffectSpec& effect, const SceneSpec& scene) { settle_place(effect, scene, person_clear_m); }

Effect second_person() {
  return {.info = {.name = "second_person",
                   .family = Family::motion,
                   .stage = "body",
                   .summary = "Somebody else is in the room during all trials and stands and turns, walks to and fro, "
                              "or wanders from one free place to the next.",
                   .fingerprint = "sensors are active together though the scripted person can't reach both",
                   .confused_with = {"false_triggers", "trigger_bursts", "warm_object"},
                   .parameters = {whether("present", "assumed"), place_coordinate("x_m"), place_coordinate("z_m"),
                                  detail("heading_deg", "deg", 0.0, -180.0, 180.0, -360.0, 360.0, "any"),
                                  detail("path_m", "m", 0.0, 0.0, 0.0, 0.0, 100.0,
                                         "assumed: length of the walk there and back; 0 turns on the spot; never "
                                         "drawn, since the place decides whether there is room",
                                         {"moves", "stands"}),
                                  detail("every_s", "s", 10.0, 5.0, 30.0, 0.5, 3600.0, "assumed: between two moves")},
                   .choices = {{"moves", ChoiceKind::variant, {"stands", "wanders"}, "stands"}, place_choice()},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage, Survey::walk_test}},
          .alter = alter_second_person,
          .draw = draw_second_person,
          .settle = settle_second_person};
}

// warm_object: something warm moves that is no person and no pet (sim/pet.hpp): a robot, a fan.

constexpr double object_clear_m = 0.3;

/// A body like a person's, as large as said: its solids are as wide for their height.
BystanderPlan object_plan(const EffectSpec& effect, const Vec2& place) {
  constexpr double density = 75.0 / (1.75 * 1.75 * 1.75);  // of a person
  constexpr double stouter = 2.0;                          // assumed (1-3): four legs or a casing
  const double height_m = effect.parameters.at("height_m");
  return {.id = "warm object",
          .role = PersonRole::object,
          .stature_m = height_m,
          .mass_kg = stouter * density * height_m * height_m * height_m,
          .speed_m_s = effect.parameters.at("speed_m_s"),
          .place = place,
          .again = {}};
}

void alter_warm_object(StudyInForce& study, const EffectSpec& effect) {
  const Vec2 place = place_of(effect, study.scene, object_clear_m);
  BystanderPlan plan = object_plan(effect, place);
  if (word(effect, "moves") == "sweeps") {
    const double heading = radians(effect.parameters.at("heading_deg")), sweep_m = effect.parameters.at("sweep_m");
    plan.again.emplace_back(action::Walk{{place + sweep_m * direction_of(heading)}});
    plan.again.emplace_back(action::Walk{{place}});
  } else {
    const double every_s = effect.parameters.at("every_s");
    for (const Vec2& stop : round_trip(study.scene, object_clear_m, place)) {
      plan.again.emplace_back(action::Walk{{stop}});
      plan.again.emplace_back(action::Wait{every_s});
    }
  }
  add_bystander(study, plan, effect.where);
}

void draw_warm_object(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  draw_place(effect, scene, object_clear_m, stream);
}

void settle_warm_object(EffectSpec& effect, const SceneSpec& scene) { settle_place(effect, scene, object_clear_m); }

Effect warm_object() {
  return {
      .info =
          {.name = "warm_object",
           .family = Family::environment,
           .stage = "placement",
           .summary = "Something warm roams from one free place to the next, as a robot does, or sweeps in place, as a "
                      "fan or a curtain over a radiator does.",
           .fingerprint = "motion that follows a place and not the person",
           .confused_with = {"trigger_bursts", "second_person", "false_triggers"},
           .parameters =
               {whether("present", "assumed"), place_coordinate("x_m"), place_coordinate("z_m"),
                detail("height_m", "m", 0.3, 0.2, 1.2, 0.1, 3.0, "assumed: a robot's to a stand fan's"),
                detail("speed_m_s", "m/s", 0.3, 0.1, 0.6, 0.02, 2.0, "assumed: a robot's 0.3, a cat's walk 0.6"),
                detail("every_s", "s", 10.0, 1.0, 60.0, 0.0, 3600.0, "assumed: rest at each place", {"moves", "roams"}),
                detail("sweep_m", "m", 0.3, 0.15, 0.6, 0.05, 5.0, "assumed: length of the sweep", {"moves", "sweeps"}),
                detail("heading_deg", "deg", 0.0, -180.0, 180.0, -360.0, 360.0, "any", {"moves", "sweeps"})},
           .choices = {{"moves", ChoiceKind::variant, {"roams", "sweeps"}, "roams"}, place_choice()},
           .reach = Reach::geometry,
           .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter_warm_object,
      .draw = draw_warm_object,
      .settle = settle_warm_object};
}

// seat_shift: people sit nearer to the table than the plan says, or further back.

void alter_seat_shift(StudyInForce& study, const EffectSpec& effect) {
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) person.changes.seat_shift_m += effect.parameters.at("forward_m");
  }
}

Effect seat_shift() {
  return {
      .info = {.name = "seat_shift",
               .family = Family::person,
               .stage = "placement",
               .summary = "Everybody sits further forward or back than the seats are drawn.",
               .fingerprint = "rows of seats on opposite sides of the sensors change in opposite directions",
               .confused_with = {"sensor_tilt", "sensor_height", "body_size"},
               .parameters = {offset("forward_m", "m", 0.25, 0.1, 1.0, "assumed: how far a chair is drawn to a table")},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter_seat_shift};
}

// seat_scatter: nobody sits on the point that is drawn.

double added(double sd, double more) { return std::sqrt(sd * sd + more * more); }

void alter_seat_scatter(StudyInForce& study, const EffectSpec& effect) {
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) {
      SeatScatterSpec& scatter = person.seat_scatter;
      scatter.position_sd_m = added(scatter.position_sd_m, effect.parameters.at("position_sd_m"));
      scatter.heading_sd_deg = added(scatter.heading_sd_deg, effect.parameters.at("heading_sd_deg"));
    }
  }
}

Effect seat_scatter() {
  return {.info = {.name = "seat_scatter",
                   .family = Family::person,
                   .stage = "placement",
                   .summary = "Positions and headings of sitters differ from run to run.",
                   .fingerprint = "residuals of both signs without a change of the mean; replicates differ more",
                   .confused_with = {"seat_shift", "soft_zone_edges"},
                   .parameters = {told_as("scatter of positions",
                                          logarithmic(strength("position_sd_m", "m", 0.06, 0.02, 0.2, 0.5,
                                                               "assumed: of each horizontal coordinate"))),
                                  told_as("scatter of headings",
                                          strength("heading_sd_deg", "deg", 0.0, 0.0, 10.0, 45.0, "assumed"))},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage, Survey::walk_test}},
          .alter = alter_seat_scatter};
}

// body_size: people are taller or smaller than the script says.

void alter_body_size(StudyInForce& study, const EffectSpec& effect) {
  const double scale = effect.parameters.at("scale");
  for_each_person(study, [&](PersonInForce& person) {
    person.stature_m *= scale;
    person.mass_kg *= scale * scale * scale;
  });
}

Effect body_size() {
  return {.info = {.name = "body_size",
                   .family = Family::person,
                   .stage = "body",
                   .summary = "Everybody's lengths are scaled, their mass by the cube; mesh bodies keep their meshes.",
                   .fingerprint = "weak, everywhere",
                   .confused_with = {"thermal_contrast", "range_scale", "arm_motion", "seat_shift"},
                   .parameters = {factor("scale", 0.8, 1.2, 0.93, "assumed: 1.5-2.2 m for the 1.86 m of Study A")},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage}},
          .alter = alter_body_size};
}

}  // namespace

std::vector<Effect> people_effects() {
  return {second_person(), warm_object(), seat_shift(), seat_scatter(), body_size()};
}

}  // namespace pirsim::effects
