#include "sim/alike.hpp"

#include <algorithm>
#include <tuple>

#include "schema/fields.hpp"

namespace pirsim::sim {
namespace {

// Structured bindings name every field, so that a new one doesn't compile until it stands here.
auto fields(const FidgetSpec& fidgeting) {
  const auto& [rate_per_s, tilt_deg, turn_deg, timing] = fidgeting;
  return std::tie(rate_per_s, tilt_deg, turn_deg, timing);
}
auto fields(const SwingSpec& swing) {
  const auto& [amplitude_deg, period_s, share] = swing;
  return std::tie(amplitude_deg, period_s, share);
}
auto fields(const UnevenArmsSpec& arms) {
  const auto& [spread, pause_share] = arms;
  return std::tie(spread, pause_share);
}

/// The body isn't compared here: it is compared as the person's own.
bool same_part(const std::optional<ScheduledPerson>& a, const std::optional<ScheduledPerson>& b) {
  const auto fields_of = [](const ScheduledPerson& scheduled) {
    const auto& [part, role, seat, person, room] = scheduled;
    return std::tie(part, role, seat, room);
  };
  return a && b ? fields_of(*a) == fields_of(*b) : a.has_value() == b.has_value();
}

/// What effects change of a person.
auto fields(const PersonChanges& changes) {
  const auto& [seat_shift_m, fidgeting, trunk_sway, chair_swing, uneven_arms, role] = changes;
  return std::tuple_cat(std::tie(seat_shift_m, role), fields(fidgeting), fields(trunk_sway), fields(chair_swing),
                        fields(uneven_arms));
}

bool same_person(const PersonInForce& a, const PersonInForce& b) {
  return same<PersonSpec>(a, b) && fields(a.changes) == fields(b.changes) && same_part(a.part, b.part);
}

std::vector<const TriMesh*> solids(const SceneSpec& scene) {
  std::vector<const TriMesh*> meshes;
  for (const TriMesh& mesh : scene.meshes) {
    if (mesh.solidity == Solidity::solid) meshes.push_back(&mesh);
  }
  return meshes;
}

/// Clearances are kept as the script is written.
bool same_size(const PersonSpec& a, const PersonSpec& b) {
  return a.stature_m == b.stature_m && a.mass_kg == b.mass_kg;
}

/// What people move by of it: of the rest only sensors know.
auto clock(const SensingInForce& sensing) { return std::tie(sensing.tick_rate_hz, sensing.ticks_per_window); }

/// Places to stand follow from the ground, which is compared by itself.
bool same_counts(const std::optional<OccupancyInForce>& a, const std::optional<OccupancyInForce>& b) {
  const auto fields_of = [](const OccupancyInForce& occupancy) {
    const auto& [counts, changes_within_s, seats, entrances, where, standing] = occupancy;
    return std::tie(changes_within_s, seats, entrances);
  };
  return a && b ? same(a->counts, b->counts) && fields_of(*a) == fields_of(*b) : a.has_value() == b.has_value();
}

bool same_trial(const TrialModel& planned, const TrialInForce& trial, double ambient_c) {
  const auto& [id, people, duration_s, schedule, run_clock, begins_s, occupancy] = trial;
  return planned.id == id && planned.duration_s == duration_s && same(planned.schedule, schedule) &&
         planned.clock == run_clock && planned.begins_s == begins_s && same_counts(planned.occupancy, occupancy) &&
         std::ranges::equal(planned.people, people, [&](const PersonModel& a, const PersonInForce& b) {
           return same_person(a.spec, b) && a.radiance == radiance_of(b.warmth, ambient_c);
         });
}

}  // namespace

bool same_meshes(const SceneSpec& a, const SceneSpec& b) {
  return std::ranges::equal(a.meshes, b.meshes, same<TriMesh>);
}

bool same_ground(const SceneSpec& a, const SceneSpec& b) {
  return a.floor == b.floor && std::ranges::equal(a.entrances, b.entrances, same<EntranceSpec>) &&
         std::ranges::equal(a.doors, b.doors, same<DoorSpec>) &&
         std::ranges::equal(solids(a), solids(b), [](const TriMesh* x, const TriMesh* y) { return same(*x, *y); });
}

bool same_people(const CompiledStudy& like, const CompiledStudy& study, const std::vector<TrialInForce>& trials) {
  const auto same_sizes = [](const TrialSpec& a, const TrialSpec& b) {
    return std::ranges::equal(a.people, b.people, same_size);
  };
  const SensingInForce &a = like.sensing(), &b = study.sensing();
  return like.seed() == study.seed() && clock(a) == clock(b) && same_ground(like.scene(), study.scene()) &&
         std::ranges::equal(like.scene().seats, study.scene().seats, same<SeatSpec>) &&
         std::ranges::equal(like.scene().places, study.scene().places, same<PlaceSpec>) &&
         std::ranges::equal(like.script_given().trials, study.script_given().trials, same_sizes) &&
         std::ranges::equal(like.trials(), trials, [&](const TrialModel& planned, const TrialInForce& trial) {
           return same_trial(planned, trial, b.ambient_c);
         });
}

}  // namespace pirsim::sim
