#include "sim/plan_people.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "core/text.hpp"
#include "pirsim/error.hpp"
#include "schema/action_facts.hpp"

namespace pirsim::sim {
namespace {

using Course = ActionFacts::Course;
using Needs = ActionFacts::Needs;
using Pose = ActionFacts::Pose;

template <typename Spec>
void check_name(const std::vector<Spec>& known, const std::string& id, const std::string& kind, const SceneSpec& scene,
                const Where& where, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const Spec& spec : known) names.push_back(spec.id);
  if (std::ranges::find(names, id) != names.end()) return;
  diagnostics.error(where, kind + " '" + id + "' is not in " + scene.name + near_or_all(id, names));
}

/// Follows one person from action to action.
class Check {
 public:
  Check(const SceneSpec& scene, const PersonSpec& person, const std::optional<RunClock>& clock,
        Diagnostics& diagnostics)
      : scene_(scene), person_(person), clock_(clock), diagnostics_(diagnostics) {}

  void operator()(const ScriptedAction& action) {
    if (action.at_s) {
      if (*action.at_s < last_at_s_) {
        fault(action, "starts at " + moment_text(clock_, *action.at_s) +
                          ", before an action that is written above it and starts at " +
                          moment_text(clock_, last_at_s_) + ": time runs backwards");
      }
      last_at_s_ = *action.at_s;
    }
    const ActionFacts facts = facts_of(action.what);
    if (facts.course == Course::comes || facts.course == Course::passes) arrive(action);
    if (facts.needs != Needs::nothing) need_presence(action);
    if (facts.appears_at != nullptr && !scene_.floor.contains(*facts.appears_at)) {
      fault(action, "appears outside the floor area");
    }
    if (facts.entrance != nullptr) {
      check_name(scene_.entrances, *facts.entrance, "entrance", scene_, action.where, diagnostics_);
    }
    if (facts.seat != nullptr) check_name(scene_.seats, *facts.seat, "seat", scene_, action.where, diagnostics_);
    if (facts.needs == Needs::seat && !seated_) fault(action, std::string(facts.name) + "s without having sat down");
    if (facts.course == Course::goes || facts.course == Course::passes) present_ = false;
    if (facts.course != Course::comes && facts.pose != Pose::kept) seated_ = facts.pose == Pose::seated;
  }

 private:
  void fault(const ScriptedAction& action, const std::string& what) {
    diagnostics_.error(action.where, "'" + person_.id + "' " + what);
  }
  void arrive(const ScriptedAction& action) {
    if (present_) fault(action, "is in the room already");
    present_ = true;
  }
  void need_presence(const ScriptedAction& action) {
    if (!present_) fault(action, "is not in the room yet: let them `enter` or `appear` first");
    present_ = true;  // one message is enough
  }

  const SceneSpec& scene_;
  const PersonSpec& person_;
  const std::optional<RunClock>& clock_;
  Diagnostics& diagnostics_;
  double last_at_s_ = 0.0;
  bool present_ = false;
  bool seated_ = false;
};

}  // namespace

void check_actions(const SceneSpec& scene, const std::vector<TrialInForce>& trials) {
  Diagnostics diagnostics;
  std::set<std::string> told;  // trials repeat the same actions: say each thing once
  for (const TrialInForce& trial : trials) {
    for (const PersonInForce& person : trial.people) {
      Diagnostics found;
      Check check(scene, person, trial.clock, found);
      for (const ScriptedAction& action : person.actions) check(action);
      for (const Issue& issue : found.issues()) {
        if (told.insert(to_string(issue)).second) diagnostics.error(issue.where, issue.message);
      }
    }
  }
  diagnostics.throw_if_errors();
}

}  // namespace pirsim::sim
