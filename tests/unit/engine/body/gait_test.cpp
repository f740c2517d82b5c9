// Walking and turning.
#include <vector>

#include "pirsim/error.hpp"
#include "support/body_checks.hpp"

using namespace pirsim;
using namespace pirsim::body;
using namespace pirsim::body::test;

namespace {

Motion standing(double heading = 0.0, double dt = tick_s) { return Motion(man(), {0, 0}, heading, 0.0, dt); }

/// Ankle joint in the person's own frame on the floor: x right, y up, z back.
Vec3 ankle_seen_from_body(const Motion& motion, Joint joint) {
  const Vec2 p = motion.position();
  const Frame body{rotation_from_heading(motion.heading()), Vec3(p.x, 0, p.y)};
  return inverse(body) * joint_places(man(), motion.posture(), joint).by_child;
}

bool same(const Frame& a, const Frame& b) {
  return glm::distance(a.origin, b.origin) < 1e-9 && std::abs(std::abs(glm::dot(a.rotation, b.rotation)) - 1.0) < 1e-12;
}

}  // namespace

TEST_CASE("a walk of 10 m at 1 m/s takes 10 s and what starting and braking cost", "[motion]") {
  Motion motion = standing();
  motion.walk(Route({{0, 0}, {0, -10}}));
  const int ticks = run_until(motion, stands, [](const Motion&) {});
  // Trapezoid: length/v + v/a with a = 1.5 m/s^2.
  CHECK(ticks * tick_s == Approx(10.0 + 1.0 / 1.5).margin(0.1));
  CHECK(motion.position() == Vec2(0, -10));
  CHECK(motion.settled());
}

TEST_CASE("in the middle of a walk the body covers 1 m/s and makes two steps a second", "[motion]") {
  Motion motion = standing();
  motion.walk(Route({{0, 0}, {0, -20}}));
  for (int i = 0; i < 200; ++i) motion.advance();
  const double start = motion.position().y;
  double lowest = 1.0;
  int landings = 0;
  double before = 0.0;
  for (int i = 0; i < 500; ++i) {
    motion.advance();
    const double lift = ankle_seen_from_body(motion, Joint::left_ankle).y - man().measures().ankle_height_m;
    if (before > 1e-3 && lift <= 1e-3) ++landings;
    before = lift;
    lowest = std::min(lowest, lift);
  }
  CHECK(start - motion.position().y == Approx(10.0).epsilon(1e-9));
  CHECK(landings == Approx(10).margin(1));  // a stride of 1 m: each foot lands once a second
  CHECK(lowest > -1e-9);
}

TEST_CASE("steps and cadence of natural walkers grow with the pace as measured ones do", "[motion]") {
  // Steps a minute; published for adults: 100 to 120 at 1.2 to 1.4 m/s (Murray, Kory & Bernard 1964 and others).
  const auto cadence = [](double pace_m_s, double stature_m) {
    PersonSpec person;
    person.stature_m = stature_m;
    const Humanoid walker(person);
    Motion motion(walker, {0, 0}, 0.0, 0.0, tick_s);
    motion.set_manner(natural_manner(pace_m_s, stature_m));
    motion.walk(Route({{0, 0}, {0, -200}}));
    int landings = 0;
    bool in_air = false;
    const int settling = static_cast<int>(5.0 / tick_s), minute = static_cast<int>(60.0 / tick_s);
    for (int i = 0; i < settling + minute; ++i) {
      motion.advance();
      const bool lifted = motion.outline().feet[0].lift_m > 1e-6;
      if (i >= settling && in_air && !lifted) ++landings;
      in_air = lifted;
    }
    return 2.0 * landings;
  };
  const double slow = cadence(0.8, 1.75), usual = cadence(1.3, 1.75), fast = cadence(1.6, 1.75);
  CHECK(usual > 105);
  CHECK(usual < 118);
  CHECK(std::abs(std::log(fast / slow) / std::log(2.0) - 0.58) < 0.04);  // +-1 step a minute of either
  CHECK(cadence(1.3, 1.55) > usual);
  CHECK(cadence(1.3, 1.95) < usual);
}

TEST_CASE("seen from a body that walks straight, a foot runs along the upper half of the paper's ellipse", "[motion]") {
  Motion motion = standing();
  motion.walk(Route({{0, 0}, {0, -20}}));
  for (int i = 0; i < 300; ++i) motion.advance();
  double highest = 0.0;
  double worst = 0.0;
  for (int i = 0; i < 400; ++i) {
    motion.advance();
    const Vec3 p = ankle_seen_from_body(motion, Joint::right_ankle);
    const double lift = p.y - man().measures().ankle_height_m;
    highest = std::max(highest, lift);
    CHECK(p.x == Approx(0.5 * man().measures().hip_width_m).margin(1e-9));
    if (lift > 1e-9) {
      worst = std::max(worst, std::abs(lift - 0.15 * std::sqrt(std::max(0.0, 1.0 - p.z * p.z / (0.25 * 0.25)))));
    } else {
      worst = std::max(worst, std::abs(p.z) - 0.25);
    }
  }
  CHECK(highest == Approx(0.15).margin(0.001));
  CHECK(worst < 0.001);
}

TEST_CASE("a foot that stands neither slides nor sinks while the other swings", "[motion]") {
  for (const auto& points :
       {std::vector<Vec2>{{0, 0}, {0, -6}}, std::vector<Vec2>{{0, 0}, {0, -3}, {3, -4}, {3, -8}}}) {
    Motion motion = standing();
    motion.walk(Route(points));
    Posture before = motion.posture();
    int moved_together = 0;
    int kept = 0;
    run_until(motion, stands, [&](const Motion& m) {
      const Posture now = m.posture();
      const bool left = same(now[at(Part::left_foot)], before[at(Part::left_foot)]);
      const bool right = same(now[at(Part::right_foot)], before[at(Part::right_foot)]);
      kept += left || right;
      // Only a tick in which the feet change roles shows both moved.
      moved_together += !left && !right;
      before = now;
    });
    const double steps = Route(points).length_m() / 0.5 + 2;
    CHECK(moved_together <= steps);
    CHECK(kept > 5 * moved_together);
  }
}

TEST_CASE("feet change roles without moving: with fine ticks no foot jumps", "[motion]") {
  Motion motion = standing(0.0, 0.0005);
  motion.walk(Route({{0, 0}, {0, -3}}));
  Posture before = motion.posture();
  double worst = 0.0;
  run_until(motion, stands, [&](const Motion& m) {
    const Posture now = m.posture();
    for (const Part foot : {Part::left_foot, Part::right_foot}) {
      worst = std::max(worst, glm::distance(now[at(foot)].origin, before[at(foot)].origin));
    }
    before = now;
  });
  CHECK(worst < 0.0005 * 3.0);  // a swinging foot's top speed at 1 m/s is 2.6 m/s, tilting adds a little
}

TEST_CASE("a walk's postures hold together, keep within the joints' limits and stay above the floor", "[motion]") {
  Soundness soundness;
  for (const auto& points :
       {std::vector<Vec2>{{0, 0}, {0, -4}}, std::vector<Vec2>{{0, 0}, {0, -2}, {2, -2}, {2, 1}, {1, 2}},
        std::vector<Vec2>{{0, 0}, {0, -2}, {-1.5, -2.7}, {-2, -4}}, std::vector<Vec2>{{0, 0}, {0, -2}, {0.2, -0.5}},
        std::vector<Vec2>{{0, 0}, {0, -0.1}}, std::vector<Vec2>{{0, 0}, {0.3, 0.9}}}) {
    Motion motion = standing();
    motion.walk(Route(points));
    run_until(motion, stands, [&](const Motion& m) { soundness.add(man(), m.posture()); });
    CHECK(glm::distance(motion.position(), points.back()) < 1e-9);
  }
  soundness.check();
}

TEST_CASE("a left arm swings with the right foot", "[motion]") {
  Motion motion = standing();
  motion.walk(Route({{0, 0}, {0, -10}}));
  for (int i = 0; i < 100; ++i) motion.advance();
  double product = 0.0;
  for (int i = 0; i < 100; ++i) {
    motion.advance();
    const auto angles = joint_angles(motion.posture());
    const double left_arm = angles[static_cast<std::size_t>(Joint::left_shoulder)].flexion;
    const double right_arm = angles[static_cast<std::size_t>(Joint::right_shoulder)].flexion;
    const double right_foot = -ankle_seen_from_body(motion, Joint::right_ankle).z;
    product += left_arm * right_foot;
    CHECK(left_arm == Approx(-right_arm).margin(1e-9));
  }
  CHECK(product > 0.5);
}

TEST_CASE("a speed limit slows a walker down, holds him in mid-stride and lets him go on", "[motion]") {
  Motion motion = standing();
  motion.walk(Route({{0, 0}, {0, -5}}));
  for (int i = 0; i < 112; ++i) motion.advance();
  motion.limit_speed(0.0);
  for (int i = 0; i < 100; ++i) motion.advance();
  CHECK(motion.speed_m_s() == 0.0);
  CHECK(motion.stage() == Stage::walking);
  const Posture waiting = motion.posture();
  motion.advance();
  CHECK(motion.posture() == waiting);
  motion.limit_speed(0.5);
  for (int i = 0; i < 100; ++i) motion.advance();
  CHECK(motion.speed_m_s() == Approx(0.5));
  motion.limit_speed(2.0);
  run_until(motion, stands, [](const Motion&) {});
  CHECK(motion.position() == Vec2(0, -5));
}

TEST_CASE("who is told to stop stands within two steps, feet together", "[motion]") {
  for (int when = 1; when < 240; when += 7) {
    Motion motion = standing();
    motion.walk(Route({{0, 0}, {0, -5}}));
    for (int i = 0; i < when; ++i) motion.advance();
    const double from = motion.position().y;
    double before = motion.speed_m_s();
    double hardest = 0.0;
    motion.stop();
    run_until(motion, stands, [&](const Motion& m) {
      hardest = std::max(hardest, (before - m.speed_m_s()) / tick_s);
      before = m.speed_m_s();
    });
    CHECK(hardest < 1.1 * 1.5 + 0.05 / tick_s);  // m/s^2; at the very end what is left of the way is taken at once
    CHECK(from - motion.position().y <= 1.0);
    const Posture posture = motion.posture();
    const Vec3 apart = posture[at(Part::right_foot)].origin - posture[at(Part::left_foot)].origin;
    CHECK(glm::distance(apart, Vec3(man().measures().hip_width_m, 0, 0)) < 1e-9);
  }
}

TEST_CASE("who waits in mid-stride and is told to stop brings the feet together on the spot", "[motion]") {
  for (int when = 40; when < 240; when += 7) {
    Motion motion = standing();
    motion.walk(Route({{0, 0}, {0, -5}}));
    for (int i = 0; i < when; ++i) motion.advance();
    motion.limit_speed(0.0);
    for (int i = 0; i < 60; ++i) motion.advance();
    if (stands(motion)) continue;
    const Vec2 place = motion.position();
    Soundness soundness;
    motion.stop();
    run_until(motion, stands, [&](const Motion& m) { soundness.add(man(), m.posture()); });
    soundness.check();
    CHECK(motion.position() == place);
    const Posture posture = motion.posture();
    const Vec3 apart = posture[at(Part::right_foot)].origin - posture[at(Part::left_foot)].origin;
    CHECK(glm::distance(apart, Vec3(man().measures().hip_width_m, 0, 0)) < 1e-9);
  }
}

TEST_CASE("a turn ends at its heading on the same spot and never exceeds 120 degrees a second", "[motion]") {
  for (const double target : {0.3, -1.2, 2.0, 3.1, -3.0, 0.01}) {
    Motion motion = standing(0.2);
    motion.turn_to(target);
    Soundness soundness;
    double before = motion.heading();
    double fastest = 0.0;
    run_until(motion, stands, [&](const Motion& m) {
      soundness.add(man(), m.posture());
      fastest = std::max(fastest, std::abs(wrapped(m.heading() - before)) / tick_s);
      before = m.heading();
      CHECK(m.position() == Vec2(0, 0));
    });
    soundness.check();
    CHECK(motion.heading() == Approx(target).margin(1e-12));
    CHECK(fastest < 120 * degree);
  }
}

TEST_CASE("a mirrored turn gives the mirrored posture at every tick", "[motion]") {
  Motion left = standing();
  Motion right = standing();
  left.turn_to(1.9);
  right.turn_to(-1.9);
  const auto mirrored_part = [](std::size_t i) { return i < 3 ? i : (i % 2 == 1 ? i + 1 : i - 1); };
  double worst = 0.0;
  run_until(left, stands, [&](const Motion&) {
    const Posture a = left.posture();
    const Posture b = right.posture();
    for (std::size_t i = 0; i < n_parts; ++i) {
      const Frame& twin = b[mirrored_part(i)];
      const Vec3 origin(-twin.origin.x, twin.origin.y, twin.origin.z);
      // The pelvis capsule's Y points right: its mirror image points left.
      const Vec3 up = twin.up();
      const Vec3 expected = (i == 0 ? -1.0 : 1.0) * Vec3(-up.x, up.y, up.z);
      worst = std::max({worst, glm::distance(a[i].origin, origin), glm::distance(a[i].up(), expected)});
    }
    right.advance();
  });
  CHECK(worst < 1e-12);
}

TEST_CASE("the same walk in another place and direction is the same walk", "[motion]") {
  const double heading = 0.9;
  const Vec2 place(3, -2);
  Motion here = standing();
  Motion there(man(), place, heading, 0.0, tick_s);
  here.walk(Route({{0, 0}, {0, -4}}));
  there.walk(Route({place, place + 4.0 * direction_of(heading)}));
  const Frame there_from_here{rotation_from_heading(heading), Vec3(place.x, 0, place.y)};
  double worst = 0.0;
  run_until(here, stands, [&](const Motion&) {
    const Posture a = here.posture();
    const Posture b = there.posture();
    for (std::size_t i = 0; i < n_parts; ++i) {
      worst = std::max(worst, glm::distance(there_from_here * a[i].origin, b[i].origin));
    }
    there.advance();
  });
  CHECK(worst < 1e-9);
}

TEST_CASE("a smaller person makes smaller and lower steps", "[motion]") {
  PersonSpec spec;
  spec.stature_m = 0.5 * 1.86;
  spec.mass_kg = 20.0;
  const Humanoid child(spec);
  Motion motion(child, {0, 0}, 0, 0, tick_s);
  motion.walk(Route({{0, 0}, {0, -10}}));
  double highest = 0.0;
  run_until(motion, stands, [&](const Motion& m) {
    const Vec3 ankle = joint_places(child, m.posture(), Joint::left_ankle).by_child;
    highest = std::max(highest, ankle.y - child.measures().ankle_height_m);
  });
  CHECK(highest == Approx(0.075).epsilon(0.02));
}

TEST_CASE("a walk that starts elsewhere or from a seat is refused", "[motion]") {
  Motion motion = standing();
  CHECK_THROWS_AS(motion.walk(Route({{1, 0}, {0, -5}})), pirsim::Error);
  CHECK_THROWS_AS(motion.tilt_spine(0.1), pirsim::Error);
  CHECK_THROWS_AS(motion.rise(), pirsim::Error);
  CHECK_THROWS_AS(motion.work({}), pirsim::Error);
  motion.walk(Route({{0, 0}, {0, -5}}));
  CHECK_THROWS_AS(motion.turn_to(1.0), pirsim::Error);
  CHECK_THROWS_AS(motion.sit_down(desk_seat()), pirsim::Error);
}
