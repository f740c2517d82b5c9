#include "schema/study_in_force.hpp"

#include <utility>

namespace pirsim {

StudyInForce as_given(SceneSpec scene, const ScriptSpec& script) {
  StudyInForce study{std::move(scene), {script.sensing, 0.0, {}, {}}, script.seed, {}};
  for (const TrialSpec& trial : script.trials) {
    TrialInForce& own = study.trials.emplace_back(TrialInForce{trial.id, {}});
    for (const PersonSpec& person : trial.people) own.people.push_back({person, {}});
  }
  return study;
}

}  // namespace pirsim
