#include "schema/study_in_force.hpp"

#include <cmath>
#include <utility>

#include "pirsim/geometry.hpp"
#include "pirsim/survey.hpp"

namespace pirsim {

StudyInForce as_given(SceneSpec scene, const ScriptSpec& script) {
  StudyInForce study{std::move(scene), {script.sensing}, script.seed, {}};
  for (const TrialSpec& trial : script.trials) {
    TrialInForce& own = study.trials.emplace_back(
        TrialInForce{trial.id, {}, trial.duration_s, trial.schedule, clock_of(script, trial)});
    for (const PersonSpec& person : trial.people) own.people.push_back({person, {}, {}});
    if (!trial.schedule) continue;
    for (const ScheduledPerson& scheduled : people_of(*trial.schedule, study.scene, script.seed)) {
      own.people.push_back({scheduled.person, {}, scheduled});
    }
    own.duration_s = std::round(3600.0 * (trial.schedule->to_h - trial.schedule->from_h));  // times are whole minutes
  }
  return study;
}

Frame mounted(const Vec3& position, double yaw_deg, double tilt_deg) {
  return {rotation_from_heading(radians(yaw_deg)) * glm::angleAxis(radians(-tilt_deg), Vec3(1, 0, 0)), position};
}

}  // namespace pirsim
