#include "reconcile/data/longer_study.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "effects/kit.hpp"
#include "pirsim/model.hpp"
#include "pirsim/study.hpp"

namespace pirsim::reconcile {
namespace {

/// Up to four places as far from each other as can be, one after the other.
std::vector<Vec2> places_to_walk(const SceneSpec& scene) {
  constexpr double clear_m = 0.4;  // half a person's width and some
  constexpr std::size_t most_places = 4;
  const std::vector<Vec2> free = effects::free_places(scene, clear_m);
  std::vector<Vec2> chosen;
  if (!free.empty()) chosen.push_back(free.front());
  while (!chosen.empty() && chosen.size() < most_places) {
    const auto from_chosen = [&](const Vec2& p) {
      double nearest = glm::distance(p, chosen.front());
      for (const Vec2& c : chosen) nearest = std::min(nearest, glm::distance(p, c));
      return nearest;
    };
    const Vec2 next = *std::ranges::max_element(free, {}, from_chosen);
    if (from_chosen(next) < clear_m) break;
    chosen.push_back(next);
  }
  return chosen;
}

ScriptedAction labelled(Action what, const ScriptSpec& script) {
  return {std::move(what), {}, script.summary.phases.empty() ? std::string() : script.summary.phases.front(), {}};
}

/// The first person of the script.
TrialSpec alone(const ScriptSpec& script, std::string id) {
  const auto peopled = std::ranges::find_if(script.trials, [](const TrialSpec& t) { return !t.people.empty(); });
  if (peopled == script.trials.end()) throw Error(ErrorCode::infeasible, "nobody is in any trial");
  PersonSpec person = peopled->people.front();
  person.actions.clear();
  return {std::move(id), {std::move(person)}};
}

TrialSpec slow_walk(const SceneSpec& scene, const ScriptSpec& script) {
  TrialSpec trial = alone(script, "slow walk");
  const std::vector<Vec2> places = places_to_walk(scene);
  if (scene.entrances.empty() || places.empty()) {
    throw Error(ErrorCode::infeasible, "no entrance, or no free place to walk to");
  }
  PersonSpec& walker = trial.people.front();
  walker.walking_speed_m_s = slow_walk_m_s;
  const std::string& door = scene.entrances.front().id;
  walker.actions = {labelled(action::Enter{door}, script), labelled(action::Walk{places}, script),
                    labelled(action::Leave{door}, script)};
  return trial;
}

TrialSpec empty_room(const ScriptSpec& script) {
  TrialSpec trial = alone(script, "empty room");
  trial.people.front().actions = {labelled(action::Wait{60.0 * empty_room_min}, script)};
  return trial;
}

std::string unused_id(const ScriptSpec& script, std::string id, const std::string& more) {
  while (std::ranges::find(script.trials, id, &TrialSpec::id) != script.trials.end()) id += more;
  return id;
}

/// Adds a trial if a person can carry it out in the room as it is drawn.
template <typename Make>
void add(LongerStudy& study, const SceneSpec& scene, std::vector<std::size_t>& index, LeftOut::Trial which, Make make) {
  try {
    TrialSpec trial = make();
    trial.id = unused_id(study.script, std::move(trial.id), " again");
    ScriptSpec only = study.script;
    only.trials = {trial};
    only.replicates = 1;
    static_cast<void>(run_once(compile(scene, std::move(only)), 0));
    index = {study.script.trials.size()};
    study.script.trials.push_back(std::move(trial));
  } catch (const Error& error) {
    study.left_out.push_back({which, error.what()});
  }
}

}  // namespace

LongerStudy longer_study(const SceneSpec& scene, const ScriptSpec& script) {
  LongerStudy study{script, script.trials.size(), {}, {}, {}};
  for (const TrialSpec& trial : script.trials) {
    TrialSpec again = trial;
    again.id = unused_id(study.script, trial.id + " again", " again");
    study.script.trials.push_back(std::move(again));
  }
  add(study, scene, study.walk, LeftOut::Trial::slow_walk, [&] { return slow_walk(scene, script); });
  add(study, scene, study.empty, LeftOut::Trial::empty_room, [&] { return empty_room(script); });
  return study;
}

}  // namespace pirsim::reconcile
