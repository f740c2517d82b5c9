#include "engine/study/study_in_force.hpp"

#include <cmath>
#include <utility>

#include "engine/study/people.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/response.hpp"
#include "pirsim/survey.hpp"

namespace pirsim {

namespace {

void add_occupancy(const OccupancySpec& occupancy, const ScriptSpec& script, const StudyInForce& study,
                   TrialInForce& trial) {
  for (const ScheduledPerson& occupant : people_of(occupancy, study.scene, script.seed))
    trial.people.push_back({occupant.person, {}, occupant});
  OccupancyRuns runs = runs_of(occupancy, script.begin);
  const double tick_s = 1.0 / script.sensing.tick_rate_hz;
  for (PersonSpec& person : scripted_people(occupancy, study.scene, runs.begins_s.front(), tick_s, script.seed))
    trial.people.push_back({std::move(person), {}, {}});
  trial.clock = runs.clock;
  trial.begins_s = std::move(runs.begins_s);
  if (!trial.duration_s) trial.duration_s = runs.duration_s;
  if (!occupancy.counts) return;
  trial.occupancy = OccupancyInForce{*occupancy.counts, occupancy.changes_within_s, seats_of(occupancy, study.scene),
                                     entrances_of(occupancy, study.scene), occupancy.where};
}

PersonInForce in_force(const PetSpec& pet) {
  PersonInForce animal;
  animal.id = pet.id;
  animal.changes.role = PersonRole::object;
  animal.pet = pet;
  return animal;
}

}  // namespace

StudyInForce as_given(SceneSpec scene, const ScriptSpec& script) {
  StudyInForce study{std::move(scene), {script.sensing}, script.seed, {}};
  for (std::uint32_t i = 0; i < study.scene.sensors.size(); ++i)
    study.scene.sensors[i].gain *= unit_sensitivity(study.scene, script.sensing.units, script.seed, i);
  for (const TrialSpec& trial : script.trials) {
    TrialInForce& own = study.trials.emplace_back(
        TrialInForce{trial.id, {}, trial.duration_s, trial.schedule, clock_of(script, trial)});
    for (const PersonSpec& person : trial.people) own.people.push_back({person, {}, {}});
    if (trial.occupancy) add_occupancy(*trial.occupancy, script, study, own);
    if (trial.schedule) {
      for (const ScheduledPerson& scheduled : people_of(*trial.schedule, study.scene, script.seed))
        own.people.push_back({scheduled.person, {}, scheduled});
      own.duration_s = std::round(3600.0 * (trial.schedule->to_h - trial.schedule->from_h));  // times are whole minutes
    }
    for (const PetSpec& pet : trial.pets) own.people.push_back(in_force(pet));
  }
  return study;
}

Frame mounted(const Vec3& position, double yaw_deg, double tilt_deg) {
  return {rotation_from_heading(radians(yaw_deg)) * glm::angleAxis(radians(-tilt_deg), Vec3(1, 0, 0)), position};
}

}  // namespace pirsim
