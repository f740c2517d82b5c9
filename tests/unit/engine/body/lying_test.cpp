// Lying down from the edge of a bed, lying on the back, on a side and half-lying, turning over, getting up.
#include <vector>

#include "engine/body/seating.hpp"
#include "pirsim/error.hpp"
#include "support/body_checks.hpp"

using namespace pirsim;
using namespace pirsim::body;
using namespace pirsim::body::test;

namespace {

/// A mattress whose top is 0.5 m up and whose edge is `to_edge_m` to the side of the pelvis.
struct Bed {
  double to_edge_m;
  double side;     ///< +1: the edge is at +X, -1: at -X
  double heading;  ///< of the place

  [[nodiscard]] LyingPlace place(const Humanoid& person) const {
    const double facing = heading - side * 0.5 * pi;
    const double out_m = std::max(0.0, to_edge_m + 0.12 - reach_m(person));
    const Vec2 out = out_m * direction_of(facing);
    LyingPlace place;
    place.world_from_place = {rotation_from_heading(heading), {0.0, top_m, 0.0}};
    place.edge.world_from_seat = {rotation_from_heading(facing), {out.x, top_m + edge_height_m(person), out.y}};
    return place;
  }
  static constexpr double top_m = 0.5;
  static double reach_m(const Humanoid& person) {
    SeatPlace edge;
    edge.world_from_seat.origin.y = top_m + edge_height_m(person);
    return fall_back_m(person, edge);
  }
  [[nodiscard]] Motion before(const Humanoid& person) const {
    const SeatPlace edge = place(person).edge;
    const double facing = heading_of(edge.world_from_seat);
    const Vec2 stand = floor_point(edge.world_from_seat.origin) + reach_m(person) * direction_of(facing);
    return Motion(person, stand, facing, 0.0, tick_s);
  }
  /// How deep the point is below the top and inside of the edge, metres; negative outside.
  [[nodiscard]] double depth_m(const Vec3& p) const {
    const Vec3 local = rotation_from_heading(-heading) * p;
    return std::min(top_m - p.y, to_edge_m - side * local.x);
  }
};

/// Points all over a solid, in the world.
std::vector<Vec3> surface_of(const Shape& shape, const Frame& frame) {
  std::vector<Vec3> points;
  const auto ball = [&](const Vec3& middle, double radius) {
    for (double a = 0.0; a < 2.0 * pi; a += pi / 6.0) {
      for (double b = -0.5 * pi; b <= 0.5 * pi; b += pi / 6.0)
        points.push_back(middle + radius * Vec3(std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b)));
    }
  };
  if (const auto* sphere = std::get_if<Sphere>(&shape)) ball(frame.origin, sphere->radius);
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    for (double share = -1.0; share <= 1.0; share += 0.2)
      ball(frame * Vec3(0, share * capsule->half_length, 0), capsule->radius);
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    for (double x : {-1.0, 0.0, 1.0})
      for (double y : {-1.0, 0.0, 1.0})
        for (double z : {-1.0, 0.0, 1.0}) points.push_back(frame * (Vec3(x, y, z) * Vec3(box->half_extents)));
  }
  return points;
}

/// What is watched over many ticks.
struct Watch {
  const Humanoid& person;
  const Bed& bed;
  double deepest_m = -1.0, worst_gap_m = 0.0, fastest_m_s = 0.0;
  Excess excess{};
  std::size_t deepest_part = 0;
  double deepest_progress = 0.0;
  std::optional<Posture> last{};

  void operator()(const Motion& motion) {
    const Posture posture = motion.posture();
    for (std::size_t i = 0; i < n_parts; ++i) {
      // The edge yields to the thighs of short people who sit on it, which slope down to their feet.
      const bool sits_there = motion.outline().lying.progress < 0.25;
      if (sits_there && (i == at(Part::left_thigh) || i == at(Part::right_thigh))) continue;
      for (const Vec3& p : surface_of(person.primitives()[i], posture[i])) {
        if (bed.depth_m(p) <= deepest_m) continue;
        deepest_m = bed.depth_m(p);
        deepest_part = i;
        deepest_progress = motion.outline().lying.progress;
      }
      if (last) fastest_m_s = std::max(fastest_m_s, glm::distance(posture[i].origin, (*last)[i].origin) / tick_s);
    }
    worst_gap_m = std::max(worst_gap_m, worst_gap(person, posture));
    const Excess now = worst_excess(posture);
    if (now.radians > excess.radians) excess = now;
    last = posture;
  }
};

bool lies(const Motion& motion) { return motion.stage() == Stage::lying; }

void wait(Motion& motion, double seconds, Watch& watch) {
  for (int i = 0; i < seconds / tick_s; ++i) {
    motion.advance();
    watch(motion);
  }
}

/// Sits down, lies down, turns to both sides, half rises, gets up.
Watch whole_night(const Humanoid& person, const Bed& bed) {
  Watch watch{person, bed};
  Motion motion = bed.before(person);
  const LyingPlace place = bed.place(person);
  motion.sit_down(place.edge);
  run_until(motion, sits, std::ref(watch));
  motion.lie_down(place);
  run_until(motion, lies, std::ref(watch));
  const auto turn = [&](double roll, double curl, double raise) {
    motion.adjust(Channel::roll, roll, 2.0);
    motion.adjust(Channel::curl, curl, 2.0);
    motion.adjust(Channel::raise, raise, 2.0);
    wait(motion, 2.5, watch);
  };
  turn(0.5 * pi, 0.5, 0.0);
  turn(-0.5 * pi, 1.0, 0.0);
  turn(-0.5, 0.2, 0.0);
  turn(0.0, 0.0, 0.7);
  motion.adjust(Channel::right_hand_to_head, 1.0, 1.0);
  wait(motion, 1.5, watch);
  motion.rise();
  run_until(motion, stands, std::ref(watch));
  return watch;
}

}  // namespace

TEST_CASE("whoever lies down, turns over and gets up keeps together, above the mattress and within joints' limits",
          "[lying]") {
  for (const double stature_m : {1.5, 1.7, 1.86, 2.0}) {
    PersonSpec spec;
    spec.stature_m = stature_m;
    const Humanoid person(spec);
    for (const double to_edge_m : {0.3, 0.45, 0.8, 1.2}) {
      for (const double side : {1.0, -1.0}) {
        const Bed bed{to_edge_m, side, 0.7};
        INFO(stature_m << " m, edge at " << side * to_edge_m << " m");
        const Watch watch = whole_night(person, bed);
        CHECK(watch.worst_gap_m < 1e-9);
        INFO("part " << watch.deepest_part << " at progress " << watch.deepest_progress);
        CHECK(watch.deepest_m < 0.02);
        CHECK(watch.fastest_m_s < 3.0);
        INFO("joint " << watch.excess.joint << " axis " << watch.excess.axis << " by "
                      << watch.excess.radians / degree);
        CHECK(watch.excess.radians < 10 * degree);
      }
    }
  }
}

TEST_CASE("on the back the face looks up and the head lies towards +Z, on a side it looks to that side", "[lying]") {
  const Bed bed{0.45, 1.0, 0.0};
  Motion motion = bed.before(man());
  motion.sit_down(bed.place(man()).edge);
  run_until(motion, sits, [](const Motion&) {});
  motion.lie_down(bed.place(man()));
  run_until(motion, lies, [](const Motion&) {});
  const Posture back = motion.posture();
  CHECK(back[at(Part::torso)].forward().y > 0.999);
  CHECK(back[at(Part::head)].origin.z > 0.6);
  CHECK(back[at(Part::left_foot)].origin.z < -0.8);
  CHECK(glm::length(motion.position()) < 1e-9);
  // Left of somebody on their back with the head towards +Z is -X.
  CHECK(back[at(Part::left_thigh)].origin.x < back[at(Part::right_thigh)].origin.x);
  motion.adjust(Channel::roll, 0.5 * pi, 2.0);
  for (int i = 0; i < 120; ++i) motion.advance();
  CHECK(motion.posture()[at(Part::torso)].forward().x < -0.999);  // on the left side, facing left
  motion.adjust(Channel::roll, 0.0, 2.0);
  motion.adjust(Channel::raise, 0.7, 2.0);
  for (int i = 0; i < 120; ++i) motion.advance();
  const Posture half = motion.posture();
  CHECK(half[at(Part::torso)].up().y == Approx(std::sin(0.7)).margin(1e-6));
  CHECK(std::abs(half[at(Part::left_thigh)].up().y) < 0.1);  // legs lie
}

TEST_CASE("somebody who lies and is asked to rise again and again ends on their feet where they came from", "[lying]") {
  const Bed bed{0.45, -1.0, 0.3};
  const LyingPlace place = bed.place(man());
  for (const int ticks : {10, 60, 120, 180, 400}) {
    Motion motion = bed.before(man());
    const Vec2 from = motion.position();
    motion.sit_down(place.edge);
    run_until(motion, sits, [](const Motion&) {});
    motion.lie_down(place);
    for (int i = 0; i < ticks; ++i) motion.advance();
    motion.rise();
    motion.rise();
    Watch watch{man(), bed};
    run_until(motion, stands, std::ref(watch));
    CHECK(watch.fastest_m_s < 3.0);
    CHECK(glm::distance(motion.position(), from) < 1e-9);
    CHECK(motion.outline().lying == LyingOutline{});
  }
}

TEST_CASE("only who sits on the edge lies down", "[lying]") {
  const Bed bed{0.45, 1.0, 0.0};
  Motion motion = bed.before(man());
  CHECK_THROWS_AS(motion.lie_down(bed.place(man())), Error);
}
