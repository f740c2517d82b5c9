// Somebody at work in each seat: which sensors notice it, and which see the sitter and yet report nothing.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/body/motion.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/study/study_in_force.hpp"
#include "pirsim/look.hpp"
#include "pirsim/model.hpp"

namespace pirsim::studies {

/// Who sits there, and what they are at.
struct Worker {
  PersonInForce person;
  action::Work work;
};
/// Somebody of natural style who types.
[[nodiscard]] Worker usual_worker();
/// The first person of the trials who works at a desk, as thirteen primitive solids (meshes would take minutes); the
/// usual worker if nobody does.
[[nodiscard]] Worker worker_of(std::span<const sim::TrialModel> trials);

/// In whose sight the seats are.
struct WatchedRoom {
  const SceneSpec& scene;
  const SensingInForce& sensing;
  const sim::SensorArray& array;
  TracerKind tracer = fastest_tracer;
  std::uint64_t seed = 1;  ///< of sitters and sensors' noise: one for all, so that surveys agree on what is deaf
};
[[nodiscard]] WatchedRoom room_of(const sim::CompiledStudy& study);

/// Some: of more than thirty seats, thirty are tried, spread evenly over their list, and fewer with more than twenty
/// sensors.
enum class SeatsTried { some, all };

/// Lets the worker sit in every seat, alone, and asks the sensors' own detectors at every tick. Seats that the worker
/// can't sit on are left out. What effects do to triggers is left out. threads 0: all cores; changes nothing in the
/// result.
[[nodiscard]] WorkReport watch_sitters(const WatchedRoom& room, const Worker& worker, unsigned threads = 0,
                                       SeatsTried tried = SeatsTried::some);

/// Seated and settled, hands on the thighs. Throws Error(infeasible) if the seat's height can't be sat on.
[[nodiscard]] body::Motion seated(const body::Humanoid& humanoid, const body::SeatPlace& place, double tick_s);

// What each sensor can see of a standing and a seated person: the report of `pirsim check`.

/// Stands a person (the script's first, or the default one) on every place of a grid and on every seat.
[[nodiscard]] SightReport look_around(const Model& model);

/// What sensors notice of a pet that is alone for a day, all doors open.
struct PetSight {
  std::string pet;
  std::size_t passes = 0;         ///< of a metre or more, from one pause to the next
  std::vector<std::size_t> seen;  ///< (n_sensors) of them, in which the sensor reports motion
};
/// Of the pets of the script's first trial.
[[nodiscard]] std::vector<PetSight> watch_pets(const Model& model);

/// "it hangs outside of the room, 70.0 m from the floor's edge", or empty: on a wall is as good as inside.
[[nodiscard]] std::string hangs_outside(const FloorArea& floor, const Vec3& place);

/// Of sensors that see nothing, a warning for each reason; none where it follows from the scene's unit.
[[nodiscard]] std::vector<Issue> warnings(const SightReport& report, const SceneSpec& scene);

}  // namespace pirsim::studies
