// A crowd with a random script, and somebody who watches it: who came when, who sat down when, how near trunks came.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "engine/sim/run_state.hpp"
#include "pirsim/random.hpp"
#include "support/shipped.hpp"

namespace pirsim::test {

// The distance between two trunks, reckoned from poses alone.

struct Trunk {
  std::array<Vec3, 3> axes;  ///< of the torso's box, unit
  Vec3 middle{0.0}, half{0.0};
  Vec3 left_hip{0.0}, right_hip{0.0};  ///< ends of the pelvis's axis
  double pelvis_radius_m = 0.0;
};

inline Trunk trunk_of(const body::Humanoid& humanoid, const body::Posture& posture) {
  constexpr auto torso = static_cast<std::size_t>(body::Part::torso), pelvis = std::size_t{0};
  const Frame& upper = posture[torso];
  const auto& capsule = std::get<Capsule>(humanoid.primitives()[pelvis]);
  const Vec3 to_end = capsule.half_length * posture[pelvis].up();
  return {{upper.right(), upper.up(), -upper.forward()},
          upper.origin,
          std::get<Box>(humanoid.primitives()[torso]).half_extents,
          posture[pelvis].origin - to_end,
          posture[pelvis].origin + to_end,
          capsule.radius};
}

/// The largest gap along any of the fifteen axes that can part two boxes: their distance at most where it is positive,
/// how deep they overlap where it is negative.
inline double box_gap(const Trunk& a, const Trunk& b) {
  const Vec3 offset = b.middle - a.middle;
  double gap = -std::numeric_limits<double>::infinity();
  const auto try_axis = [&](const Vec3& axis) {
    const double length = glm::length(axis);
    if (length < 1e-9) return;
    double reach = 0.0;
    for (int i = 0; i < 3; ++i) {
      reach += a.half[i] * std::abs(glm::dot(a.axes[static_cast<std::size_t>(i)], axis));
      reach += b.half[i] * std::abs(glm::dot(b.axes[static_cast<std::size_t>(i)], axis));
    }
    gap = std::max(gap, (std::abs(glm::dot(offset, axis)) - reach) / length);
  };
  for (const Vec3& axis : a.axes) try_axis(axis);
  for (const Vec3& axis : b.axes) try_axis(axis);
  for (const Vec3& one : a.axes) {
    for (const Vec3& other : b.axes) try_axis(glm::cross(one, other));
  }
  return gap;
}

inline double box_to_point(const Trunk& box, const Vec3& point) {
  const Vec3 offset = point - box.middle;
  Vec3 beyond;
  for (int i = 0; i < 3; ++i) {
    beyond[i] = std::abs(glm::dot(offset, box.axes[static_cast<std::size_t>(i)])) - box.half[i];
  }
  const double inside = std::min(0.0, std::max({beyond.x, beyond.y, beyond.z}));
  return glm::length(glm::max(beyond, Vec3(0.0))) + inside;
}

/// Points along the pelvis's axis, 2.5 cm apart in the largest person: 1 mm of its shape is left out between them.
template <typename See>
void along_pelvis(const Trunk& trunk, const See& see) {
  constexpr int n_points = 9;
  for (int i = 0; i < n_points; ++i) {
    see(trunk.left_hip + (trunk.right_hip - trunk.left_hip) * (i / (n_points - 1.0)));
  }
}

/// Negative where any of torso and pelvis of the one overlaps any of the other.
inline double trunk_gap(const Trunk& a, const Trunk& b) {
  double gap = box_gap(a, b);
  along_pelvis(a, [&](const Vec3& p) { gap = std::min(gap, box_to_point(b, p) - a.pelvis_radius_m); });
  along_pelvis(b, [&](const Vec3& p) { gap = std::min(gap, box_to_point(a, p) - b.pelvis_radius_m); });
  along_pelvis(a, [&](const Vec3& p) {
    along_pelvis(
        b, [&](const Vec3& q) { gap = std::min(gap, glm::distance(p, q) - a.pelvis_radius_m - b.pelvis_radius_m); });
  });
  return gap;
}

// What happened in a run.

struct Stay {
  double due_s = 0.0;     ///< when they reach the door from outside
  double came_s = -1.0;   ///< when they stand in it; -1: never
  double sat_s = -1.0;    ///< settled on the seat
  double called_s = 0.0;  ///< when the script sends them away
  double left_s = -1.0;
};

struct CrowdRecord {
  std::vector<Stay> stays;  ///< (n_people)
  std::vector<sim::Incident> incidents;
  double least_gap_m = 1e9;  ///< between two trunks of which neither passes through the other
  double least_gap_at_s = 0.0;
  std::array<std::uint32_t, 2> least_gap_of{};
  std::array<body::Stage, 2> least_gap_in{};
  double end_s = 0.0;
  [[nodiscard]] std::size_t count(IncidentKind kind) const {
    return static_cast<std::size_t>(std::ranges::count(incidents, kind, &sim::Incident::kind));
  }
};

/// Trunks are looked at every so many ticks; see(state) is called at each tick.
template <typename See>
CrowdRecord watch_crowd(const Model& model, std::uint32_t run, int look_every, const See& see) {
  const sim::CompiledStudy& study = model.compiled();
  sim::RunState state(study, run);
  const auto& actors = state.crowd.actors();
  CrowdRecord record;
  record.stays.resize(actors.size());
  std::vector<std::uint8_t> was_here(actors.size(), 0);
  std::vector<Trunk> trunks(actors.size());
  while (!state.finished) {
    sim::move_tick(study, state);
    const double now = static_cast<double>(state.tick) * study.tick_s();
    see(state);
    for (std::size_t i = 0; i < actors.size(); ++i) {
      const sim::Actor& actor = actors[i];
      Stay& stay = record.stays[i];
      record.incidents.insert(record.incidents.end(), actor.incidents().begin(), actor.incidents().end());
      if (actor.present() && stay.came_s < 0.0) stay.came_s = now;
      if (actor.present() && stay.sat_s < 0.0 && actor.motion().stage() == body::Stage::seated &&
          actor.motion().settled())
        stay.sat_s = now;
      if (!actor.present() && was_here[i] != 0) stay.left_s = now;
      was_here[i] = actor.present() ? 1 : 0;
    }
    if (state.tick % look_every != 0) continue;
    std::vector<std::uint8_t> posed(actors.size(), 0);
    const auto trunk = [&](std::size_t i) -> const Trunk& {
      if (posed[i] == 0) trunks[i] = trunk_of(actors[i].person().humanoid, actors[i].motion().posture());
      posed[i] = 1;
      return trunks[i];
    };
    const auto sits = [&](std::size_t i) { return actors[i].motion().stage() == body::Stage::seated; };
    const auto passes = [&](std::size_t i) {
      return actors[i].presence().solidity == sim::Presence::Solidity::passing_through;
    };
    for (std::uint32_t i = 0; i < actors.size(); ++i) {
      for (std::uint32_t j = 0; j < i; ++j) {
        if (!actors[i].present() || !actors[j].present()) continue;
        constexpr double near_m = 1.0;
        if (glm::distance(actors[i].motion().position(), actors[j].motion().position()) > near_m) continue;
        if (sits(i) && sits(j) && state.tick % 50 != 0) continue;  // hardly moves
        if (passes(i) || passes(j)) continue;
        const double gap = trunk_gap(trunk(i), trunk(j));
        if (gap >= record.least_gap_m) continue;
        record.least_gap_m = gap;
        record.least_gap_at_s = now;
        record.least_gap_of = {j, i};
        record.least_gap_in = {actors[j].motion().stage(), actors[i].motion().stage()};
      }
    }
  }
  record.end_s = static_cast<double>(state.tick) * study.tick_s();
  return record;
}

// Who comes, when, and what for.

struct CrowdPlan {
  enum class Case {
    mingled,    ///< arrivals within 300 s, departures at any time between a minute later and 600 s
    in_turn,    ///< 15 s apart, ten minutes of work each
    one_enters  ///< the others, none to four of them, sit already
  };
  Case kind = Case::mingled;
  std::uint32_t n_people = 10;
  std::vector<std::string> seats;  ///< empty: all of the scene
  enum class Statures { one, mixed } statures = Statures::mixed;
};

/// Seats at random, each person another one.
inline std::vector<PersonSpec> random_people(const SceneSpec& scene, const CrowdPlan& plan, std::uint64_t seed,
                                             std::uint32_t trial) {
  Stream stream({seed, trial, 0, Purpose::test});
  std::vector<std::string> seats = plan.seats;
  if (seats.empty()) {
    for (const SeatSpec& seat : scene.seats) seats.push_back(seat.id);
  }
  for (std::size_t i = seats.size(); i > 1; --i) std::swap(seats[i - 1], seats[stream.index(std::uint32_t(i))]);
  const bool one_enters = plan.kind == CrowdPlan::Case::one_enters;
  const std::uint32_t n_people = one_enters ? 1 + stream.index(5) : plan.n_people;
  std::vector<PersonSpec> people;
  for (std::uint32_t i = 0; i < n_people; ++i) {
    double due_s = 0.0, called_s = 0.0;
    const double arrival = stream.uniform(), departure = stream.uniform();
    if (plan.kind == CrowdPlan::Case::mingled) {
      due_s = 300.0 * arrival;
      called_s = due_s + 60.0 + (540.0 - due_s) * departure;
    } else if (plan.kind == CrowdPlan::Case::in_turn) {
      due_s = 15.0 * i;
    } else {
      due_s = i + 1 == n_people ? 200.0 : 40.0 * i;
      called_s = 400.0 + 40.0 * i;
    }
    const std::string& door = scene.entrances[stream.index(std::uint32_t(scene.entrances.size()))].id;
    // Nine statures, so that their floors can be shared.
    const double stature_m = 1.55 + 0.05 * stream.index(9);
    PersonSpec spec = person("p" + std::to_string(i + 1),
                             {act(action::Wait{due_s}), act(action::Enter{door}), act(action::Sit{seats[i]})});
    if (plan.kind == CrowdPlan::Case::in_turn) {
      spec.actions.push_back(act(action::Work{600.0}));
      spec.actions.push_back(act(action::Leave{door}));
    } else {
      spec.actions.push_back(act(action::Work{1200.0}));
      spec.actions.push_back(act_at(called_s, action::Leave{door}));
    }
    if (plan.statures == CrowdPlan::Statures::mixed) {
      spec.stature_m = stature_m;
      spec.mass_kg = 23.0 * stature_m * stature_m;  // a body mass index of 23
    }
    people.push_back(std::move(spec));
  }
  return people;
}

inline ScriptSpec random_crowds(const SceneSpec& scene, const CrowdPlan& plan, std::uint64_t seed,
                                std::uint32_t first_trial, std::uint32_t n_trials) {
  ScriptSpec script;
  script.name = "crowd";
  for (std::uint32_t trial = first_trial; trial < first_trial + n_trials; ++trial) {
    script.trials.push_back({std::to_string(trial), random_people(scene, plan, seed, trial)});
  }
  return script;
}

}  // namespace pirsim::test
