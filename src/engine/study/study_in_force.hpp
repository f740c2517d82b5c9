// A study as its effects left it: what runs are made from, where the specs are what a user gave.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/study/people.hpp"
#include "model/schema/check_script.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// Rays go on mirrored where they hit a mesh; what they see there counts for their zone.
struct ReflectionSpec {
  std::string mesh;
  double coefficient = 0.0;  ///< share of the power that is mirrored, 0-1
  double scatter_deg = 0.0;  ///< a rough surface turns each ray by a normal angle of this spread about either axis
};

/// The pyroelectric pair: zones count with their sign, what their sum does is filtered and compared with a threshold.
struct DualPolaritySpec {
  double threshold = 1.0;     ///< in steps of one zone
  double high_pass_hz = 0.3;  ///< corner frequencies, one pole each
  double low_pass_hz = 7.0;
};

/// What counts as motion where a zone's sensitivity falls off smoothly.
enum class EdgeRule {
  drawn_edge,    ///< a change across the edge, which is drawn anew for every window
  covered_area,  ///< a change of the covered share of the zone beyond a threshold
  swept_area     ///< by chance, in proportion to the share of the zone that is swept
};
struct SoftEdgesSpec {
  double sigma_deg = 0.0;  ///< of the zone's edge, a normal distribution; 0: hard
  EdgeRule rule = EdgeRule::drawn_edge;
  double threshold = 0.5;  ///< of covered_area: share of the zone
};

/// A part of a lens through which nothing is seen, from its rim inwards.
struct BlindFieldSpec {
  std::vector<std::uint32_t> sensors;
  double share = 0.0;     ///< of the lens's rays
  double side_deg = 0.0;  ///< in the lens's plane, from its right to its upper side
};

struct SensingInForce : SensingSpec {
  SoftEdgesSpec soft_edges{};
  std::vector<BlindFieldSpec> blind_fields{};
  std::vector<ReflectionSpec> reflections{};
  std::optional<DualPolaritySpec> dual_polarity{};
};

enum class FidgetTiming {
  independent,   ///< a Poisson process
  still_periods  ///< with still periods of all lengths in between, as of people of natural style
};
/// Small moves of somebody seated, of which no script says when.
struct FidgetSpec {
  double rate_per_s = 0.0;  ///< of moves
  double tilt_deg = 0.0;    ///< the trunk moves to within so much of its scripted tilt
  double turn_deg = 0.0;    ///< the head turns to within so much of straight ahead
  FidgetTiming timing = FidgetTiming::independent;
};

/// To and fro at a steady rhythm, in bouts, by somebody seated.
struct SwingSpec {
  double amplitude_deg = 0.0;
  double period_s = 3.0;
  double share = 1.0;  ///< of the time
};

/// Arms at desk work that don't keep time.
struct UnevenArmsSpec {
  double spread = 0.0;       ///< standard deviation of the logarithm of each swing's amplitude and period
  double pause_share = 0.0;  ///< of the swings; the arms rest on the table meanwhile
};

enum class PersonRole {
  subject,    ///< a run lasts until they have carried out all actions
  bystander,  ///< the run doesn't wait for them
  object      ///< a bystander that is no person: nobody counts it
};

/// What no script can say about a person, only an effect.
struct PersonChanges {
  double seat_shift_m = 0.0;  ///< sits so far forward of where seats are drawn
  FidgetSpec fidgeting;
  SwingSpec trunk_sway, chair_swing;
  UnevenArmsSpec uneven_arms;
  PersonRole role = PersonRole::subject;
};

struct PersonInForce : PersonSpec {
  PersonChanges changes;
  std::optional<ScheduledPerson> part{};  ///< in the trial's schedule; its actions are drawn for each run
  std::optional<PetSpec> pet{};           ///< is this animal, an object that moves by itself
};

/// An occupancy of counts, with what its runs and its room make of it.
struct OccupancyInForce {
  CountsSpec counts;
  std::optional<double> changes_within_s;
  std::vector<std::string> seats;      ///< that may be taken
  std::vector<std::string> entrances;  ///< that people use
  Where where;
  std::vector<Vec2> standing{};  ///< where those stand who find no seat; once people are planned
};

/// people: those of the script, then whom effects added.
template <typename Person>
struct TrialOf {
  std::string id;
  std::vector<Person> people;
  std::optional<double> duration_s{};
  std::optional<ScheduleSpec> schedule{};
  std::optional<RunClock> clock{};  ///< of the first replicate
  /// When each of the days of an occupancy begins, in the seconds of its data, which replicates take in turn; of an
  /// occupancy without days one moment; empty: the trial has none.
  std::vector<double> begins_s{};
  std::optional<OccupancyInForce> occupancy{};  ///< of one that is drawn for each run

  /// People come and go by data or draws, not by a story of which somebody is the first.
  [[nodiscard]] bool is_populated() const noexcept { return schedule || !begins_s.empty(); }
};
using TrialInForce = TrialOf<PersonInForce>;

struct StudyInForce {
  SceneSpec scene;
  SensingInForce sensing;
  std::uint64_t seed = 1;
  std::vector<TrialInForce> trials;
};

/// Before any effect.
[[nodiscard]] StudyInForce as_given(SceneSpec scene, const ScriptSpec& script);

}  // namespace pirsim
