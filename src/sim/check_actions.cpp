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
    if (const std::string* place = facts.takes()) check_place(action, facts, *place);
    if (facts.needs == Needs::seat && pose_ != Pose::seated)
      fault(action, std::string(facts.name) + "s without having sat down");
    if (facts.needs == Needs::rest && pose_ == Pose::upright)
      fault(action, std::string(facts.name) + "s without having sat down");
    if (facts.course == Course::goes || facts.course == Course::passes) present_ = false;
    const bool comes_in_on_foot = facts.course == Course::comes && facts.place == nullptr;
    if (!comes_in_on_foot && facts.pose != Pose::kept) pose_ = pose_after(facts);
  }

 private:
  [[nodiscard]] const PlaceSpec* place_of(const std::string& id) const {
    const auto place = std::ranges::find(scene_.places, id, &PlaceSpec::id);
    return place == scene_.places.end() ? nullptr : &*place;
  }
  [[nodiscard]] bool is_seat(const std::string& id) const {
    return std::ranges::find(scene_.seats, id, &SeatSpec::id) != scene_.seats.end();
  }
  [[nodiscard]] Pose pose_after(const ActionFacts& facts) const {
    if (facts.pose != Pose::of_place) return facts.pose;
    const PlaceSpec* place = place_of(*facts.place);
    if (place == nullptr) return Pose::seated;
    return place->posture == PlacePosture::lie ? Pose::lying : Pose::upright;
  }
  /// Is there such a place, and is it one for this action?
  void check_place(const ScriptedAction& action, const ActionFacts& facts, const std::string& id) {
    const PlaceSpec* place = place_of(id);
    const bool seat = is_seat(id);
    if (place == nullptr && !seat) {
      if (facts.seat != nullptr) return check_name(scene_.seats, id, "seat", scene_, action.where, diagnostics_);
      std::vector<std::string> known;
      for (const PlaceSpec& other : scene_.places) known.push_back(other.id);
      for (const SeatSpec& other : scene_.seats) known.push_back(other.id);
      return diagnostics_.error(action.where, "place '" + id + "' is not in " + scene_.name + near_or_all(id, known));
    }
    const char* verb = seat ? "sit" : place->posture == PlacePosture::lie ? "lie" : "stand";
    if (facts.pose != Pose::of_place && facts.name != verb) {
      diagnostics_.error(action.where, "'" + id + "' is a place to " + verb + ": `" + verb + ": " + id + "`");
    }
  }
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
  Pose pose_ = Pose::upright;
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
