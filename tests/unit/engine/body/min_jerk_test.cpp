#include "engine/body/arms.hpp"

#include <cmath>
#include <vector>

#include "support/catch.hpp"

using pirsim::body::MinJerk;

TEST_CASE("a minimum-jerk motion from rest follows 10 t^3 - 15 t^4 + 6 t^5", "[motion]") {
  MinJerk motion(2.0);
  motion.move_to(5.0, 50);
  for (int tick = 0; tick <= 50; ++tick) {
    const double t = tick / 50.0;
    CHECK(motion.value() == Approx(2.0 + 3.0 * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)).margin(1e-12));
    motion.advance();
  }
}

TEST_CASE("a minimum-jerk motion ends at its target bit for bit, whatever came before", "[motion]") {
  MinJerk direct(0.0);
  direct.move_to(0.1, 30);
  for (int i = 0; i < 30; ++i) direct.advance();
  MinJerk wandering(0.7);
  for (const double target : {-0.4, 0.9, 0.3, 0.1}) {
    wandering.move_to(target, 40);
    for (int i = 0; i < 13; ++i) wandering.advance();
  }
  for (int i = 0; i < 40; ++i) wandering.advance();
  CHECK(direct.settled());
  CHECK(direct.value() == 0.1);
  CHECK(direct == wandering);
}

TEST_CASE("sending a minimum-jerk motion elsewhere halfway keeps position, velocity and acceleration", "[motion]") {
  MinJerk motion(0.0);
  motion.move_to(1.0, 1000);
  std::vector<double> x;
  for (int i = 0; i < 3000; ++i) {
    if (i == 430) motion.move_to(-0.5, 1000);
    x.push_back(motion.value());
    motion.advance();
  }
  // Third differences stay of the order of the jerk (at most about 60 * 2 / 1000^3), with no step in the second.
  double worst = 0.0;
  for (std::size_t i = 3; i < x.size(); ++i) {
    worst = std::max(worst, std::abs(x[i] - 3 * x[i - 1] + 3 * x[i - 2] - x[i - 3]));
  }
  CHECK(worst < 3e-7);
}

TEST_CASE("a minimum-jerk motion that is sent to and fro does not overshoot its ends", "[motion]") {
  double lowest = 0.0;
  double highest = 0.0;
  for (int first = 1; first < 60; ++first) {
    for (int second = 0; second < 60; ++second) {
      MinJerk motion(0.0);
      motion.move_to(1.0, 60);
      for (int i = 0; i < first; ++i) motion.advance();
      motion.move_to(0.0, 60);
      for (int i = 0; i < second; ++i) motion.advance();
      motion.move_to(1.0, 60);
      while (!motion.settled()) {
        motion.advance();
        lowest = std::min(lowest, motion.value());
        highest = std::max(highest, motion.value());
      }
    }
  }
  CHECK(lowest > -0.01);
  CHECK(highest < 1.01);
}
