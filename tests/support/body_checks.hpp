// What every posture has to fulfil, and how to run a person's motion to its end.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <variant>

#include "engine/body/motion.hpp"
#include "engine/body/skeleton.hpp"
#include "support/catch.hpp"
#include "support/joints.hpp"

namespace pirsim::body::test {

inline constexpr double degree = std::numbers::pi / 180.0;
inline constexpr double tick_s = 0.02;

inline const Humanoid& man() {
  static const Humanoid humanoid{PersonSpec{}};
  return humanoid;
}

inline double lowest_point(const Shape& shape, const Frame& frame) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return frame.origin.y - sphere->radius;
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return frame.origin.y - std::abs(frame.up().y) * capsule->half_length - capsule->radius;
  }
  const Vec3 half = std::get<Box>(shape).half_extents;
  const Vec3 back = frame.rotation * Vec3(0, 0, 1);
  return frame.origin.y - std::abs(frame.right().y) * half.x - std::abs(frame.up().y) * half.y -
         std::abs(back.y) * half.z;
}

/// Largest distance between a joint's place as its two parts have it.
inline double worst_gap(const Humanoid& humanoid, const Posture& posture) {
  double worst = 0.0;
  for (std::size_t i = 0; i < n_joints; ++i) {
    const JointPlaces places = joint_places(humanoid, posture, static_cast<Joint>(i));
    worst = std::max(worst, glm::distance(places.by_parent, places.by_child));
  }
  return worst;
}

/// By how much the worst joint is beyond its limits, radians; and which.
struct Excess {
  double radians = -10.0;
  std::size_t joint = 0;
  char axis = ' ';
};
inline Excess worst_excess(const Posture& posture) {
  const auto angles = joint_angles(posture);
  Excess worst;
  const auto look = [&](std::size_t joint, char axis, double value, double lower, double upper) {
    const double excess = std::max(lower - value, value - upper);
    if (excess > worst.radians) worst = {excess, joint, axis};
  };
  for (std::size_t i = 0; i < n_joints; ++i) {
    const JointLimits& range = limits(static_cast<Joint>(i));
    look(i, 'f', angles[i].flexion, range.lower.flexion, range.upper.flexion);
    look(i, 'a', angles[i].abduction, range.lower.abduction, range.upper.abduction);
    look(i, 't', angles[i].twist, range.lower.twist, range.upper.twist);
  }
  return worst;
}

/// Collects over many ticks, so that one assertion speaks for all of them.
struct Soundness {
  double worst_gap_m = 0.0;
  double lowest_m = 1.0;
  Excess excess;

  void add(const Humanoid& humanoid, const Posture& posture) {
    worst_gap_m = std::max(worst_gap_m, worst_gap(humanoid, posture));
    for (std::size_t i = 0; i < n_parts; ++i) {
      lowest_m = std::min(lowest_m, lowest_point(humanoid.solids()[i], posture[i]));
    }
    const Excess now = worst_excess(posture);
    if (now.radians > excess.radians) excess = now;
  }
  void check() const {
    CHECK(worst_gap_m < 1e-9);
    CHECK(lowest_m > -1e-9);
    INFO("joint " << excess.joint << " axis " << excess.axis << " beyond by degrees " << excess.radians / degree);
    CHECK(excess.radians <= 1e-9);
  }
};

/// Advances until `done(motion)`, calling `see(motion)` before each tick and at the end; the ticks it took.
template <class Done, class See>
int run_until(Motion& motion, Done done, See see, int most_ticks = 20000) {
  int ticks = 0;
  for (see(motion); !done(motion); see(motion)) {
    motion.advance();
    REQUIRE(++ticks < most_ticks);
  }
  return ticks;
}
inline bool stands(const Motion& motion) { return motion.stage() == Stage::standing; }
inline bool sits(const Motion& motion) { return motion.stage() == Stage::seated; }

/// A seat at the origin of the floor with its pelvis point 0.531 m up, facing -Z, at a table of 0.74 m.
inline SeatPlace desk_seat() {
  SeatPlace seat;
  seat.world_from_seat.origin = {0.0, 0.531, 0.0};
  seat.table_height_m = 0.74;
  return seat;
}

}  // namespace pirsim::body::test
