#include "effects/bystander.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "pirsim/geometry.hpp"
#include "schema/action_facts.hpp"

namespace pirsim::effects {
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

}  // namespace pirsim::effects
