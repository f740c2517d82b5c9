// A study as its effects left it: what runs are made from, where the specs are what a user gave.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "schema/schedule_people.hpp"

namespace pirsim {

/// Rays go on mirrored where they hit a mesh; what they see there counts for their zone.
struct ReflectionSpec {
  std::string mesh;
  double coefficient = 0.0;  ///< share of the power that is mirrored, 0-1
};

/// The pyroelectric pair: zones count with their sign, what their sum does is filtered and compared with a threshold.
struct DualPolaritySpec {
  double threshold = 1.0;     ///< in steps of one zone
  double high_pass_hz = 0.3;  ///< corner frequencies, one pole each
  double low_pass_hz = 7.0;
};

struct SensingInForce : SensingSpec {
  double edge_sigma_deg = 0.0;  ///< how soft the edges of zones are; 0: hard
  std::vector<ReflectionSpec> reflections;
  std::optional<DualPolaritySpec> dual_polarity;
};

/// Small moves of somebody seated, of which no script says when.
struct FidgetSpec {
  double rate_per_s = 0.0;  ///< of moves, a Poisson process
  double tilt_deg = 0.0;    ///< the trunk moves to within so much of its scripted tilt
  double turn_deg = 0.0;    ///< the head turns to within so much of straight ahead
};

/// Whether a run lasts until the person has carried out all actions.
enum class PersonRole { subject, bystander };

/// What no script can say about a person, only an effect.
struct PersonChanges {
  double seat_shift_m = 0.0;  ///< sits so far forward of where seats are drawn
  FidgetSpec fidgeting;
  PersonRole role = PersonRole::subject;
};

struct PersonInForce : PersonSpec {
  PersonChanges changes;
  std::optional<ScheduledPerson> part{};  ///< in the trial's schedule; its actions are drawn for each run
};

struct TrialInForce {
  std::string id;
  std::vector<PersonInForce> people;  ///< those of the script, then whom effects added
  std::optional<double> duration_s{};
  std::optional<ScheduleSpec> schedule{};
};

struct StudyInForce {
  SceneSpec scene;
  SensingInForce sensing;
  std::uint64_t seed = 1;
  std::vector<TrialInForce> trials;
};

/// Before any effect.
[[nodiscard]] StudyInForce as_given(SceneSpec scene, const ScriptSpec& script);

}  // namespace pirsim
