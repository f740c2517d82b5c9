#include "sim/check_actions.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "core/near_names.hpp"
#include "pirsim/error.hpp"

namespace pirsim::sim {
namespace {

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
    where_ = &action;
    std::visit(*this, action.what);
  }
  void operator()(const action::Wait&) {}
  void operator()(const action::Appear& appear) {
    arrive();
    if (!scene_.floor.contains(appear.point)) fault(*where_, "appears outside the floor area");
  }
  void operator()(const action::Enter& enter) {
    arrive();
    check_name(scene_.entrances, enter.entrance, "entrance", scene_, where_->where, diagnostics_);
  }
  void operator()(const action::Walk&) {
    need_presence();
    seated_ = false;
  }
  void operator()(const action::Turn&) {
    need_presence();
    seated_ = false;
  }
  void operator()(const action::Rise&) {
    need_presence();
    if (present_ && !seated_) fault(*where_, "rises without having sat down");
    seated_ = false;
  }
  void operator()(const action::Sit& sit) {
    need_presence();
    check_name(scene_.seats, sit.seat, "seat", scene_, where_->where, diagnostics_);
    seated_ = true;
  }
  void operator()(const action::Work&) {
    need_presence();
    if (present_ && !seated_) fault(*where_, "works without having sat down");
  }
  void operator()(const action::Leave& leave) {
    need_presence();
    check_name(scene_.entrances, leave.entrance, "entrance", scene_, where_->where, diagnostics_);
    present_ = seated_ = false;
  }

 private:
  void fault(const ScriptedAction& action, const std::string& what) {
    diagnostics_.error(action.where, "'" + person_.id + "' " + what);
  }
  void arrive() {
    if (present_) fault(*where_, "is in the room already");
    present_ = true;
  }
  void need_presence() {
    if (!present_) fault(*where_, "is not in the room yet: let them `enter` or `appear` first");
    present_ = true;  // one message is enough
  }

  const SceneSpec& scene_;
  const PersonSpec& person_;
  const std::optional<RunClock>& clock_;
  Diagnostics& diagnostics_;
  const ScriptedAction* where_ = nullptr;
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
