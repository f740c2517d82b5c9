// Somebody else is there of whom the script doesn't know.
#include <algorithm>
#include <glm/geometric.hpp>
#include <string>

#include "effects/kit.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::effects {
namespace {

constexpr double clear_m = 0.4;

bool is_given(const EffectSpec& effect) {
  const auto how = effect.choices.find("place");
  return how != effect.choices.end() && how->second == "given";
}

Vec2 place_of(const EffectSpec& effect, const SceneSpec& scene) {
  if (is_given(effect)) return {effect.parameters.at("x_m"), effect.parameters.at("z_m")};
  const std::vector<Vec2> places = free_places(scene, clear_m);
  if (!places.empty()) return places.front();
  throw Error(ErrorCode::infeasible, effect.where, "second_person: no free place in " + scene.name);
}

/// An upper bound of how long a trial may last, seconds.
double longest_s(const TrialInForce& trial, const SceneSpec& scene) {
  double longest = 0.0;
  for (const PersonInForce& person : trial.people) {
    // Once across the room, and as much again to get round what stands there.
    const double way_s = 2.0 * glm::distance(scene.floor.lower(), scene.floor.upper()) / person.walking_speed_m_s;
    double sum = 0.0;
    for (const ScriptedAction& action : person.actions) {
      constexpr double any_s = 60.0;  // turning, sitting down: more than enough
      sum += any_s + way_s + action.at_s.value_or(0.0);
      if (const auto* wait = std::get_if<action::Wait>(&action.what)) sum += wait->duration_s;
      if (const auto* work = std::get_if<action::Work>(&action.what)) sum += work->duration_s;
      if (const auto* walk = std::get_if<action::Walk>(&action.what))
        sum += way_s * static_cast<double>(walk->points.size());
    }
    longest = std::max(longest, sum);
  }
  return longest;
}

/// Several in one room go by numbers.
std::string new_id(const TrialInForce& trial) {
  const std::string id = "second person";
  const auto others = std::ranges::count_if(trial.people, [&](const auto& p) { return p.id.starts_with(id); });
  return others == 0 ? id : id + " " + std::to_string(others + 1);
}

PersonInForce bystander(const std::string& id, const Vec2& place, const EffectSpec& effect, double until_s) {
  const double every_s = effect.parameters.at("every_s"), heading_deg = effect.parameters.at("heading_deg");
  const double path_m = effect.parameters.at("path_m");
  PersonInForce person;
  person.id = id;
  person.changes.role = PersonRole::bystander;
  person.stature_m = 1.75;  // assumed
  const auto act = [&](Action what) { person.actions.push_back({std::move(what), {}, {}, effect.where}); };
  act(action::Appear{place, heading_deg});
  constexpr double turn_deg = 120.0;  // assumed: turns to each of three sides
  for (int i = 1; i * every_s < until_s; ++i) {
    act(action::Wait{every_s});
    if (path_m > 0.0) {
      act(action::Walk{{i % 2 == 1 ? place + path_m * direction_of(radians(heading_deg)) : place}});
    } else {
      act(action::Turn{std::remainder(heading_deg + i * turn_deg, 360.0)});
    }
  }
  return person;
}

void alter(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const Vec2 place = place_of(effect, scene);
  for (TrialInForce& trial : study.trials)
    trial.people.push_back(bystander(new_id(trial), place, effect, longest_s(trial, scene)));
}

void draw(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const std::vector<Vec2> places = free_places(scene, clear_m);
  effect.choices["place"] = places.empty() ? "free" : "given";
  if (places.empty()) return;
  const Vec2 place = places[stream.index(static_cast<std::uint32_t>(places.size()))];
  effect.parameters["x_m"] = place.x;
  effect.parameters["z_m"] = place.y;
}

void settle(EffectSpec& effect, const SceneSpec& scene) {
  if (!is_given(effect)) return;
  const Vec2 place = nearest_free(scene, clear_m, place_of(effect, scene));
  effect.parameters["x_m"] = place.x;
  effect.parameters["z_m"] = place.y;
}

ParameterInfo detail(std::string name, std::string unit, double typical, double low, double high, double least,
                     double most, std::string source, Condition only_if = {}) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .role = Role::detail,
          .off = typical,
          .typical = typical,
          .low = low,
          .high = high,
          .least = least,
          .most = most,
          .source = std::move(source),
          .only_if = std::move(only_if)};
}

}  // namespace

const Effect& second_person() {
  static const Effect effect{
      .info =
          {.name = "second_person",
           .family = Family::motion,
           .stage = "body",
           .summary = "Somebody else is in the room for all of every trial: stands and turns, or walks to and fro.",
           .fingerprint = "sensors are active together that the scripted person can't reach at once",
           .confused_with = {"false_triggers", "trigger_bursts"},
           .parameters = {whether("present", "assumed"),
                          detail("x_m", "m", 0.0, -50.0, 50.0, -1e4, 1e4, "assumed: a free place", {"place", "given"}),
                          detail("z_m", "m", 0.0, -50.0, 50.0, -1e4, 1e4, "assumed: a free place", {"place", "given"}),
                          detail("heading_deg", "deg", 0.0, -180.0, 180.0, -360.0, 360.0, "any"),
                          detail("path_m", "m", 0.0, 0.0, 0.0, 0.0, 100.0,
                                 "assumed: how far to walk that way and back; 0: turns on the spot. Not drawn: "
                                 "whether there is room to walk depends on the place"),
                          detail("every_s", "s", 10.0, 5.0, 30.0, 0.5, 3600.0, "assumed: between two moves")},
           .choices = {{"place", ChoiceKind::word, {"free", "given"}, "the free place farthest from all seats"}},
           .reach = Reach::geometry},
      .alter = alter,
      .draw = draw,
      .settle = settle};
  return effect;
}

}  // namespace pirsim::effects
