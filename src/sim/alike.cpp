#include "sim/alike.hpp"

#include <algorithm>
#include <tuple>

namespace pirsim::sim {
namespace {

// Structured bindings name every field, so that a new one doesn't compile until it stands here.
auto fields(const TriMesh& mesh) {
  const auto& [name, positions, triangles, solidity, temperature_c] = mesh;
  return std::tie(name, positions, triangles, solidity, temperature_c);
}
auto fields(const EntranceSpec& entrance) {
  const auto& [id, world_from_entrance, width_m, outside_m] = entrance;
  return std::tie(id, world_from_entrance, width_m, outside_m);
}
auto fields(const SeatSpec& seat) {
  const auto& [id, world_from_seat] = seat;
  return std::tie(id, world_from_seat);
}
auto fields(const action::Wait& wait) {
  const auto& [duration_s, activity] = wait;
  return std::tie(duration_s, activity);
}
auto fields(const action::Appear& appear) {
  const auto& [point, heading_deg] = appear;
  return std::tie(point, heading_deg);
}
auto fields(const action::Enter& enter) {
  const auto& [entrance] = enter;
  return std::tie(entrance);
}
auto fields(const action::Walk& walk) {
  const auto& [points, activity] = walk;
  return std::tie(points, activity);
}
auto fields(const action::Sit& sit) {
  const auto& [seat, wait_s, if_taken] = sit;
  return std::tie(seat, wait_s, if_taken);
}
auto fields(const action::Work& work) {
  const auto& [duration_s, arm_amplitude_m, arm_period_s, tilt_choices_deg, tilt_every_s, activity] = work;
  return std::tie(duration_s, arm_amplitude_m, arm_period_s, tilt_choices_deg, tilt_every_s, activity);
}
auto fields(const action::Rise&) { return std::tuple<>(); }
auto fields(const action::Leave& leave) {
  const auto& [entrance] = leave;
  return std::tie(entrance);
}
auto fields(const action::Turn& turn) {
  const auto& [heading_deg] = turn;
  return std::tie(heading_deg);
}

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

template <typename Spec>
bool same(const Spec& a, const Spec& b) {
  return fields(a) == fields(b);
}

/// But for where it stands in the script.
bool same_action(const ScriptedAction& a, const ScriptedAction& b) {
  const auto is_same = [&](const auto& what) {
    const auto* other = std::get_if<std::decay_t<decltype(what)>>(&b.what);
    return other != nullptr && same(what, *other);
  };
  const auto others = [](const ScriptedAction& action) {
    const auto& [what, at_s, phase, where] = action;
    return std::tie(at_s, phase);
  };
  return others(a) == others(b) && std::visit(is_same, a.what);
}

/// But for the body, which is compared as the person's own.
bool same_part(const std::optional<ScheduledPerson>& a, const std::optional<ScheduledPerson>& b) {
  const auto fields_of = [](const ScheduledPerson& scheduled) {
    const auto& [part, role, seat, person] = scheduled;
    return std::tie(part, role, seat);
  };
  return a && b ? fields_of(*a) == fields_of(*b) : a.has_value() == b.has_value();
}

bool same_person(const PersonInForce& a, const PersonInForce& b) {
  const auto parts = [](const PersonInForce& person) {
    const auto& [id, stature_m, mass_kg, speed, scatter, file, meshes, warmth, style, actions] =
        static_cast<const PersonSpec&>(person);
    const auto& [position_sd_m, heading_sd_deg] = scatter;
    const auto& [seat_shift_m, fidgeting, trunk_sway, chair_swing, uneven_arms, role] = person.changes;
    const auto& [skin_c, clothing_clo, bare, parts_c] = warmth;
    return std::tuple_cat(std::tie(id, stature_m, mass_kg, speed, position_sd_m, heading_sd_deg, seat_shift_m, role,
                                   style, file, meshes, skin_c, clothing_clo, bare, parts_c),
                          fields(fidgeting), fields(trunk_sway), fields(chair_swing), fields(uneven_arms));
  };
  return parts(a) == parts(b) && same_part(a.part, b.part) && std::ranges::equal(a.actions, b.actions, same_action);
}

std::vector<const TriMesh*> solids(const SceneSpec& scene) {
  std::vector<const TriMesh*> meshes;
  for (const TriMesh& mesh : scene.meshes) {
    if (mesh.solidity == Solidity::solid) meshes.push_back(&mesh);
  }
  return meshes;
}

bool same_floor(const FloorArea& a, const FloorArea& b) {
  return a.loops() == b.loops() && a.height_m() == b.height_m();
}

/// Clearances are kept as the script is written.
bool same_size(const PersonSpec& a, const PersonSpec& b) {
  return a.stature_m == b.stature_m && a.mass_kg == b.mass_kg;
}

/// What people move by of it: of the rest only sensors know.
auto clock(const SensingInForce& sensing) {
  const auto& [tick_rate_hz, ticks_per_window, rays_per_zone, change_per, reader, response, ambient_c,
               analog_rays_per_zone] = static_cast<const SensingSpec&>(sensing);
  return std::tie(tick_rate_hz, ticks_per_window);
}

bool same_trial(const TrialModel& planned, const TrialInForce& trial, double ambient_c) {
  const auto& [id, people, duration_s, schedule, run_clock] = trial;
  return planned.id == id && planned.duration_s == duration_s && planned.schedule == schedule &&
         planned.clock == run_clock &&
         std::ranges::equal(planned.people, people, [&](const PersonModel& a, const PersonInForce& b) {
           return same_person(a.spec, b) && a.radiance == radiance_of(b.warmth, ambient_c);
         });
}

}  // namespace

bool same_meshes(const SceneSpec& a, const SceneSpec& b) {
  return std::ranges::equal(a.meshes, b.meshes, same<TriMesh>);
}

bool same_ground(const SceneSpec& a, const SceneSpec& b) {
  return same_floor(a.floor, b.floor) && std::ranges::equal(a.entrances, b.entrances, same<EntranceSpec>) &&
         std::ranges::equal(solids(a), solids(b), [](const TriMesh* x, const TriMesh* y) { return same(*x, *y); });
}

bool same_people(const CompiledStudy& like, const CompiledStudy& study, const std::vector<TrialInForce>& trials) {
  const auto same_sizes = [](const TrialSpec& a, const TrialSpec& b) {
    return std::ranges::equal(a.people, b.people, same_size);
  };
  const SensingInForce &a = like.sensing(), &b = study.sensing();
  return like.seed() == study.seed() && clock(a) == clock(b) && same_ground(like.scene(), study.scene()) &&
         std::ranges::equal(like.scene().seats, study.scene().seats, same<SeatSpec>) &&
         std::ranges::equal(like.script_given().trials, study.script_given().trials, same_sizes) &&
         std::ranges::equal(like.trials(), trials, [&](const TrialModel& planned, const TrialInForce& trial) {
           return same_trial(planned, trial, b.ambient_c);
         });
}

}  // namespace pirsim::sim
