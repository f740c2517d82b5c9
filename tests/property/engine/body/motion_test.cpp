// Random commands at random moments: every part stays continuous, and joints keep to a bounded speed.
#include <bit>
#include <vector>

#include "engine/body/motion.hpp"
#include "pirsim/random.hpp"
#include "support/body_checks.hpp"

using namespace pirsim;
using namespace pirsim::body;
using namespace pirsim::body::test;

namespace {

// A foot swings at up to 2.6 times the walking speed; arms and bends add to that. Over 3000 sequences the highest
// were 3.5 m/s (a forearm at a bend) and 7.5 rad/s (a thigh).
constexpr double fastest_part_m_s = 4.0;
constexpr double fastest_turn_rad_s = 9.0;

double angle_between(const Quat& a, const Quat& b) { return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b)))); }

class RandomCommands {
 public:
  explicit RandomCommands(std::uint32_t run) : stream_({.seed = 4, .run = run}) {}

  void maybe_command(Motion& motion) {
    if (stream_.uniform() > 0.04) return;
    switch (motion.stage()) {
      case Stage::standing:
        return from_standing(motion);
      case Stage::walking:
        if (stream_.uniform() < 0.4) return motion.stop();
        return motion.limit_speed(stream_.uniform() < 0.3 ? 0.0 : 1.5 * stream_.uniform());
      case Stage::turning:
        if (stream_.uniform() < 0.3) motion.stop();
        return;
      case Stage::sitting_down:
        return motion.rise();
      case Stage::rising:
        return motion.sit_down(seat_);
      case Stage::seated:
        return from_seated(motion);
      default:  // nobody lies down here
        return;
    }
  }

 private:
  void from_standing(Motion& motion) {
    motion.limit_speed(1.0);
    const double choice = stream_.uniform();
    const Vec2 p = motion.position();
    if (choice < 0.5) {
      std::vector<Vec2> points{p};
      const std::uint32_t corners = 1 + stream_.index(4);
      for (std::uint32_t i = 0; i < corners; ++i) {
        points.push_back(points.back() + 2.0 * Vec2(stream_.normal(), stream_.normal()));
      }
      motion.walk(Route(points));
    } else if (choice < 0.65) {
      motion.turn_to(7.0 * stream_.uniform() - 3.5);
    } else {
      const double heading = motion.heading() + 0.3 * (stream_.uniform() - 0.5);
      const Vec2 at_seat = p + (0.5 * stream_.uniform() - 0.6) * direction_of(heading);
      seat_.world_from_seat = {rotation_from_heading(heading),
                               Vec3(at_seat.x, 0.48 + 0.1 * stream_.uniform(), at_seat.y)};
      seat_.table_height_m.reset();
      if (stream_.uniform() < 0.7) seat_.table_height_m = 0.74;
      motion.sit_down(seat_);
    }
  }
  void from_seated(Motion& motion) {
    const double choice = stream_.uniform();
    if (choice < 0.3) return motion.work({0.15 * stream_.uniform(), 2.0 + 2.0 * stream_.uniform()});
    if (choice < 0.7) return motion.tilt_spine((30.0 * stream_.uniform() - 15.0) * degree);
    if (choice < 0.8) return motion.rest();
    motion.rise();
  }

  Stream stream_;
  SeatPlace seat_;
};

}  // namespace

TEST_CASE("random commands keep every part continuous, every joint in its limits and everything above the floor",
          "[motion]") {
  Soundness soundness;
  double fastest = 0.0;
  double fastest_turn = 0.0;
  std::array<int, 6> seen{};
  std::size_t fastest_part = 0;
  std::size_t turning_part = 0;
  Stage fastest_stage{};
  Stage turning_stage{};
  for (std::uint32_t run = 0; run < 300; ++run) {
    RandomCommands commands(run);
    Motion motion(man(), {0, 0}, 0.0, 0.0, tick_s);
    Posture before = motion.posture();
    for (int tick = 0; tick < 700; ++tick) {
      commands.maybe_command(motion);
      motion.advance();
      const Posture now = motion.posture();
      ++seen[static_cast<std::size_t>(motion.stage())];
      soundness.add(man(), now);
      for (std::size_t i = 0; i < n_parts; ++i) {
        const double speed = glm::distance(now[i].origin, before[i].origin) / tick_s;
        const double turn = angle_between(now[i].rotation, before[i].rotation) / tick_s;
        if (speed > fastest) fastest = speed, fastest_part = i, fastest_stage = motion.stage();
        if (turn > fastest_turn) fastest_turn = turn, turning_part = i, turning_stage = motion.stage();
      }
      before = now;
    }
  }
  soundness.check();
  for (const int count : seen) CHECK(count > 1000);
  INFO("fastest " << name(static_cast<Part>(fastest_part)) << " while " << name(fastest_stage) << ", turning "
                  << name(static_cast<Part>(turning_part)) << " while " << name(turning_stage));
  CHECK(fastest < fastest_part_m_s);
  CHECK(fastest_turn < fastest_turn_rad_s);
}

TEST_CASE("postures that follow upon one another are worked out as single ones are: bit for bit", "[motion]") {
  const auto bytes = [](const Posture& posture) { return std::bit_cast<std::array<char, sizeof posture>>(posture); };
  std::array<int, n_parts> kept{};
  for (std::uint32_t run = 0; run < 100; ++run) {
    RandomCommands commands(run);
    Motion motion(man(), {0, 0}, 0.0, 0.0, tick_s);
    Poser poser(man());
    for (int tick = 0; tick < 500; ++tick) {
      commands.maybe_command(motion);
      motion.advance();
      const Posture& posture = poser.posture(motion.outline());
      for (std::size_t i = 0; i < n_parts; ++i) kept[i] += (poser.renewed() >> i & 1U) == 0 ? 1 : 0;
      REQUIRE(bytes(posture) == bytes(posture_of(man(), motion.outline())));
    }
  }
  for (const int count : kept) CHECK(count > 1000);
}

TEST_CASE("the whole of Study A is sound for people of all sizes, and arms at work move at a bounded speed",
          "[motion]") {
  for (const double stature : {1.5, 1.7, 1.86, 2.05}) {
    PersonSpec spec;
    spec.stature_m = stature;
    spec.mass_kg = 23.0 * stature * stature;
    const Humanoid humanoid(spec);
    Soundness soundness;
    double fastest = 0.0;
    Motion motion(humanoid, {4.0, 2.0}, 0.0, 0.0, tick_s);
    Posture before = motion.posture();
    const auto see = [&](const Motion& m) {
      const Posture now = m.posture();
      soundness.add(humanoid, now);
      for (std::size_t i = 0; i < n_parts; ++i) {
        fastest = std::max(fastest, glm::distance(now[i].origin, before[i].origin) / tick_s);
      }
      before = now;
    };
    motion.walk(Route({{4, 2}, {4, 0.5}, {1, 0.5}, {0, 0.2}}));
    run_until(motion, stands, see);
    motion.turn_to(0.0);
    run_until(motion, stands, see);
    motion.sit_down(desk_seat());
    run_until(motion, sits, see);
    motion.work({});
    fastest = 0.0;
    Stream stream({.seed = 8, .run = 1});
    for (int tick = 0; tick < 9000; ++tick) {
      if (tick % 1500 == 0) motion.tilt_spine((static_cast<int>(stream.index(3)) - 1) * 15.0 * degree);
      motion.advance();
      see(motion);
    }
    CHECK(fastest < 2.0);
    motion.rise();
    run_until(motion, stands, see);
    motion.walk(Route({{0, 0.2}, {1, 0.5}, {4, 0.5}, {4, 2}}));
    run_until(motion, stands, see);
    soundness.check();
    CHECK(glm::distance(motion.position(), Vec2(4, 2)) < 1e-9);
  }
}

TEST_CASE("a copy of a motion goes on as the original does", "[motion]") {
  RandomCommands commands(1000);
  Motion motion(man(), {0, 0}, 0.0, 0.0, tick_s);
  for (int tick = 0; tick < 3000; ++tick) {
    commands.maybe_command(motion);
    Motion copy = motion;
    CHECK(copy == motion);
    motion.advance();
    copy.advance();
    CHECK(copy.posture() == motion.posture());
  }
}
