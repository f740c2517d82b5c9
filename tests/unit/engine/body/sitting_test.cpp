// Sitting down, rising, desk work and the spine's tilt.
#include <vector>

#include "pirsim/error.hpp"
#include "support/body_checks.hpp"

using namespace pirsim;
using namespace pirsim::body;
using namespace pirsim::body::test;

namespace {

constexpr std::size_t index(Joint joint) { return static_cast<std::size_t>(joint); }

/// Standing on the seat's axis, `ahead_m` before its pelvis point, with given errors.
Motion before_seat(double ahead_m, double aside_m = 0.0, double turned = 0.0) {
  return Motion(man(), {aside_m, -ahead_m}, turned, 0.0, tick_s);
}
Motion seated(double dt = tick_s) {
  Motion motion(man(), {0.0, -fall_back_m(man(), desk_seat())}, 0.0, 0.0, dt);
  motion.sit_down(desk_seat());
  run_until(motion, sits, [](const Motion&) {});
  return motion;
}
/// Largest downward acceleration, m/s^2.
double steepest_fall(const std::vector<double>& height, double dt) {
  double steepest = 0.0;
  for (std::size_t i = 2; i < height.size(); ++i) {
    steepest = std::max(steepest, -(height[i] - 2 * height[i - 1] + height[i - 2]) / (dt * dt));
  }
  return steepest;
}
void settle(Motion& motion) {
  run_until(
      motion, [](const Motion& m) { return m.settled(); }, [](const Motion&) {});
}

}  // namespace

TEST_CASE("on a chair whose pelvis point is 0.531 m high the hips pass 80 degrees and the pelvis is at that point",
          "[motion]") {
  for (const double ahead : {fall_back_m(man(), desk_seat()), 0.0, -0.25, 0.8}) {
    Motion motion = before_seat(ahead);
    motion.sit_down(desk_seat());
    Soundness soundness;
    run_until(motion, sits, [&](const Motion& m) { soundness.add(man(), m.posture()); });
    soundness.check();
    const Posture posture = motion.posture();
    CHECK(joint_angles(posture)[index(Joint::left_hip)].flexion > 80 * degree);
    CHECK(joint_angles(posture)[index(Joint::right_hip)].flexion > 80 * degree);
    CHECK(glm::distance(posture[at(Part::pelvis)].origin, Vec3(0, 0.531, 0)) < 1e-9);
    // Shanks are about upright.
    CHECK(posture[at(Part::left_shank)].up().y > std::cos(10 * degree));
    CHECK(posture[at(Part::right_shank)].up().y > std::cos(10 * degree));
  }
}

TEST_CASE("people of a manner of their own take its times to sit down and to rise", "[motion]") {
  const Manner natural = natural_manner(1.2, 1.86);
  Motion motion = before_seat(fall_back_m(man(), desk_seat()));
  motion.set_manner(natural);
  motion.sit_down(desk_seat());
  Soundness soundness;
  const auto watch = [&](const Motion& m) { soundness.add(man(), m.posture()); };
  // Who stands where the knees touch the seat only falls.
  CHECK(run_until(motion, sits, watch) * tick_s == Approx(natural.sitting_down_s).margin(0.1));
  settle(motion);
  motion.rise();
  CHECK(run_until(motion, stands, watch) * tick_s == Approx(natural.rising_s).margin(0.1));
  soundness.check();
}

TEST_CASE("small errors of place and heading before a seat are gone when seated", "[motion]") {
  Motion motion = before_seat(0.45, 0.07, 0.2);
  motion.sit_down(desk_seat());
  Soundness soundness;
  run_until(motion, sits, [&](const Motion& m) { soundness.add(man(), m.posture()); });
  soundness.check();
  CHECK(glm::distance(motion.position(), Vec2(0.0)) < 1e-9);
  CHECK(motion.heading() == Approx(0.0).margin(1e-12));
}

TEST_CASE("in the controlled fall knees and feet stay, and the pelvis never falls faster than gravity lets it",
          "[motion]") {
  constexpr double dt = 0.001;
  Motion motion(man(), {0.0, -fall_back_m(man(), desk_seat())}, 0.0, 0.0, dt);
  const Posture start = motion.posture();
  const Vec3 knee = joint_places(man(), start, Joint::left_knee).by_child;
  motion.sit_down(desk_seat());
  std::vector<double> height;
  run_until(motion, sits, [&](const Motion& m) {
    const Posture posture = m.posture();
    height.push_back(posture[at(Part::pelvis)].origin.y);
    CHECK(glm::distance(joint_places(man(), posture, Joint::left_knee).by_child, knee) < 1e-9);
    CHECK(posture[at(Part::right_foot)] == start[at(Part::right_foot)]);
  });
  CHECK(std::is_sorted(height.rbegin(), height.rend()));
  CHECK(steepest_fall(height, dt) < 9.81);
  CHECK(steepest_fall(height, dt) > 0.5);  // it does fall
}

TEST_CASE("reversing a fall and reversing that again keeps within gravity's limit too", "[motion]") {
  constexpr double dt = 0.002;
  double steepest = 0.0;
  for (int fallen = 20; fallen < 600; fallen += 40) {
    for (int risen = 1; risen < 300; risen += 40) {
      Motion motion(man(), {0.0, -fall_back_m(man(), desk_seat())}, 0.0, 0.0, dt);
      std::vector<double> height;
      const auto go = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) {
          motion.advance();
          height.push_back(motion.posture()[at(Part::pelvis)].origin.y);
        }
      };
      motion.sit_down(desk_seat());
      go(fallen);
      motion.rise();
      go(risen);
      if (motion.stage() == Stage::rising) motion.sit_down(desk_seat());
      go(650);
      steepest = std::max(steepest, steepest_fall(height, dt));
    }
  }
  CHECK(steepest < 9.81);
}

TEST_CASE("fall_back_m is where no chair has to be moved", "[motion]") {
  const SeatPlace seat = desk_seat();
  Motion motion = before_seat(fall_back_m(man(), seat));
  const Posture start = motion.posture();
  motion.sit_down(seat);
  const int ticks = run_until(motion, sits, [](const Motion&) {});
  CHECK(ticks * tick_s < 1.3);
  CHECK(motion.posture()[at(Part::left_foot)] == start[at(Part::left_foot)]);
}

TEST_CASE("rising leads back to the very place and posture where sitting down began", "[motion]") {
  for (const double ahead : {fall_back_m(man(), desk_seat()), -0.3}) {
    Motion motion = before_seat(ahead, 0.03, -0.1);
    const Motion start = motion;
    motion.sit_down(desk_seat());
    run_until(motion, sits, [](const Motion&) {});
    motion.work({});
    for (int i = 0; i < 200; ++i) motion.advance();
    motion.tilt_spine(0.2);
    for (int i = 0; i < 77; ++i) motion.advance();
    motion.rise();
    Soundness soundness;
    run_until(motion, stands, [&](const Motion& m) { soundness.add(man(), m.posture()); });
    soundness.check();
    CHECK(motion.posture() == start.posture());
    CHECK(motion.position() == start.position());
    CHECK(motion.heading() == start.heading());
  }
}

TEST_CASE("sitting down and rising can be reversed at any moment", "[motion]") {
  for (int when = 0; when < 160; when += 9) {
    Motion motion = before_seat(-0.2);
    const Motion start = motion;
    motion.sit_down(desk_seat());
    for (int i = 0; i < when; ++i) motion.advance();
    if (!sits(motion)) motion.rise();
    for (int i = 0; i < 23 && motion.stage() == Stage::rising; ++i) motion.advance();
    if (motion.stage() == Stage::rising) motion.sit_down(desk_seat());
    if (!stands(motion)) {
      run_until(motion, sits, [](const Motion&) {});
      CHECK(glm::distance(motion.position(), Vec2(0.0)) < 1e-9);
      motion.rise();
    }
    run_until(motion, stands, [](const Motion&) {});
    CHECK(motion.posture() == start.posture());
  }
}

TEST_CASE("seats out of reach are refused", "[motion]") {
  SeatPlace seat = desk_seat();
  seat.world_from_seat.origin.y = 1.2;
  CHECK_THROWS_AS(before_seat(0.4).sit_down(seat), Error);
  seat.world_from_seat.origin.y = 0.1;
  CHECK_THROWS_AS(before_seat(0.4).sit_down(seat), Error);
  CHECK_THROWS_AS(before_seat(0.4, 0.6).sit_down(desk_seat()), pirsim::Error);
  CHECK_THROWS_AS(before_seat(0.4, 0.0, 1.5).sit_down(desk_seat()), pirsim::Error);
}

TEST_CASE("hands follow plus and minus 0.1 sin(2 pi t / 3) m from the tick of the work command on", "[motion]") {
  Motion motion = seated();
  motion.work({});
  const double base = 0.189 + std::sqrt(0.4 * 0.4 - 0.013 * 0.013);  // the fitted place, see docs/physics/humanoid.md
  const double plane = 0.74 + man().radius_m(Part::left_forearm);
  int out_of_reach = 0;
  for (int tick = 0; tick < 600; ++tick, motion.advance()) {
    if (tick <= 50) continue;
    const Posture posture = motion.posture();
    const double wave = 0.1 * std::sin(2 * std::numbers::pi * tick * tick_s / 3.0);
    for (const double side : {-1.0, 1.0}) {
      const Part forearm = side < 0 ? Part::left_forearm : Part::right_forearm;
      const Joint joint = side < 0 ? Joint::left_shoulder : Joint::right_shoulder;
      const Vec3 hand = posture[at(forearm)] * Vec3(0, -0.5 * man().measures().forearm_m, 0);
      const Vec3 shoulder_at = joint_places(man(), posture, joint).by_child;
      const Vec3 wanted(side * 0.247, plane, -(base - side * wave));
      const double reach = 0.995 * (man().measures().upper_arm_m + man().measures().forearm_m);
      CHECK(hand.y == Approx(plane).margin(1e-9));
      if (glm::distance(shoulder_at, wanted) <= reach) {
        CHECK(glm::distance(hand, wanted) < 1e-3);  // 0.247 m is rounded
      } else {                                      // the far end is a little beyond the stretched arm
        CHECK(glm::distance(shoulder_at, hand) == Approx(reach));
        CHECK(glm::distance(hand, wanted) < 0.008);
        ++out_of_reach;
      }
    }
  }
  CHECK(out_of_reach < 250);
}

TEST_CASE("at equal arm phase and tilt a sitter's postures are the same bits, whatever came before", "[motion]") {
  Motion plain = seated();
  plain.work({});
  for (int i = 0; i < 150; ++i) plain.advance();
  Motion other = seated();
  other.work({0.05, 1.7});
  for (int i = 0; i < 61; ++i) other.advance();
  other.tilt_spine(-15 * degree);
  for (int i = 0; i < 20; ++i) other.advance();
  other.tilt_spine(15 * degree);
  for (int i = 0; i < 33; ++i) other.advance();
  other.work({});
  other.tilt_spine(0.0);
  for (int i = 0; i < 450; ++i) other.advance();
  REQUIRE(plain.settled());
  REQUIRE(other.settled());
  for (int i = 0; i < 150; ++i) {
    CHECK(plain.posture() == other.posture());
    plain.advance();
    other.advance();
  }
  // Must fail for other phases: the test can tell postures apart.
  plain.advance();
  CHECK_FALSE(plain.posture() == other.posture());
}

TEST_CASE("desk work repeats bit for bit after a period that is a whole number of ticks but for rounding", "[motion]") {
  constexpr double period_s = 1.16;
  REQUIRE(period_s / tick_s != std::round(period_s / tick_s));
  Motion motion = seated();
  motion.work({0.1, period_s});
  for (int i = 0; i < 60; ++i) motion.advance();
  std::vector<Posture> first;
  for (int i = 0; i < 58 * 40; ++i, motion.advance()) {
    if (i < 58) first.push_back(motion.posture());
    if (i >= 58) CHECK(motion.posture() == first[static_cast<std::size_t>(i % 58)]);
  }
}

TEST_CASE("the whole choreography of desk work is sound, and no forearm dips below the table", "[motion]") {
  Motion motion = seated();
  motion.work({});
  for (int i = 0; i < 60; ++i) motion.advance();
  Soundness soundness;
  double lowest = 2.0;
  const std::array<double, 6> tilts{15, -15, 0, -15, 15, 0};
  for (int tick = 0; tick < 6 * 300; ++tick) {
    if (tick % 300 == 0) motion.tilt_spine(tilts[static_cast<std::size_t>(tick / 300)] * degree);
    const Posture posture = motion.posture();
    soundness.add(man(), posture);
    for (const Part part : {Part::left_forearm, Part::right_forearm}) {
      lowest = std::min(lowest, lowest_point(man().solids()[at(part)], posture[at(part)]));
    }
    motion.advance();
  }
  soundness.check();
  CHECK(lowest > 0.74 - 1e-9);
}

TEST_CASE("a near hand's elbow is where the circles about shoulder and hand cross in the table's plane, outside",
          "[motion]") {
  Motion motion = seated();
  motion.work({});
  const double plane = 0.74 + man().radius_m(Part::left_forearm);
  int compared = 0;
  for (int tick = 0; tick < 300; ++tick) {
    motion.advance();
    if (tick < 100) continue;
    const Posture posture = motion.posture();
    const Vec3 shoulder_at = joint_places(man(), posture, Joint::right_shoulder).by_child;
    const Vec3 hand = posture[at(Part::right_forearm)] * Vec3(0, -0.5 * man().measures().forearm_m, 0);
    const Vec3 elbow = joint_places(man(), posture, Joint::right_elbow).by_child;
    // Circle-circle intersection in (x, z).
    const double drop = shoulder_at.y - plane;
    const double r1 = std::sqrt(std::pow(man().measures().upper_arm_m, 2) - drop * drop);
    const double r2 = man().measures().forearm_m;
    const Vec2 between = floor_point(hand - shoulder_at);
    const double d = glm::length(between);
    if (d > 0.95 * (r1 + r2)) continue;  // beyond, the elbow is kept a little above the lowest place
    const double along = (r1 * r1 - r2 * r2 + d * d) / (2 * d);
    const Vec2 unit = between / d;
    Vec2 side(-unit.y, unit.x);
    if (side.x < 0.0) side = -side;
    const Vec2 expected = floor_point(shoulder_at) + along * unit + std::sqrt(r1 * r1 - along * along) * side;
    CHECK(glm::distance(floor_point(elbow), expected) < 1e-9);
    CHECK(elbow.y == Approx(plane).margin(1e-9));
    ++compared;
  }
  CHECK(compared > 20);
}

TEST_CASE("a tilted spine turns the head about the hips by exactly that angle, and the arms follow", "[motion]") {
  Motion upright = seated();
  Motion tilted = upright;
  tilted.tilt_spine(15 * degree);
  settle(tilted);
  const Vec3 hips(0, 0.531, 0);
  const Vec3 a = upright.posture()[at(Part::head)].origin - hips;
  const Vec3 b = tilted.posture()[at(Part::head)].origin - hips;
  CHECK(glm::length(a) == Approx(glm::length(b)));
  CHECK(std::atan2(-b.z, b.y) - std::atan2(-a.z, a.y) == Approx(15 * degree).margin(1e-12));
}
