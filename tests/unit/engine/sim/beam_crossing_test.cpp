// The whole chain from lens data to motion, against times that can be computed on paper.
#include <cmath>

#include "engine/pir/optics.hpp"
#include "engine/pir/zone_motion.hpp"
#include "engine/rt/tracer.hpp"
#include "support/catch.hpp"
#include "support/plain_motion.hpp"
#include "support/zone_bytes.hpp"

using namespace pirsim;

namespace {

/// A sensor with one small zone straight ahead, so that its single ray runs along -Z from the origin.
SensorModelSpec one_beam(double range_m) {
  SensorModelSpec model;
  model.id = "one beam";
  model.clusters.push_back({{0, 0}, range_m, 1, {{{{{-0.01, 0}, {0, -0.01}, {0.01, 0}, {0, 0.01}}}, 1}}});
  return model;
}

struct Crossing {
  int first_active = -1, last_active = -1;  ///< ticks
  std::vector<int> motion;                  ///< ticks with a change
};

/// A sphere that moves at `speed` along the line x = speed * t - 2 m at the given height and distance, 50 Hz, 4 s.
Crossing cross(TracerKind kind, double speed, double height, double distance, double radius, double range_m) {
  RayBundle rays;
  pir::append(rays, {"eye", "one beam", Frame{}}, one_beam(range_m), RaysPerZone::one);
  const rt::Room room({});
  const auto tracer = rt::make_tracer(kind, {&room, &rays, &rays});
  Crossing crossing;
  test::ZoneBytes before(1, 0), after(1, 0);
  for (int tick = 0; tick <= 200; ++tick) {
    const double x = speed * tick / 50.0 - 2.0;
    const std::vector<PosedShape> solids{place(Sphere{radius}, {Quat(1, 0, 0, 0), Vec3(x, height, -distance)})};
    before = after;
    after = test::seen_by(*tracer, solids, 1);
    std::vector<std::uint8_t> bit(1, 0);
    test::mark_motion(rays, ChangePer::cluster, before, after, bit);
    if (bit[0] != 0) crossing.motion.push_back(tick);
    if (after[0] != 0) {
      if (crossing.first_active < 0) crossing.first_active = tick;
      crossing.last_active = tick;
    }
  }
  return crossing;
}

}  // namespace

TEST_CASE("a sphere on a straight line enters and leaves a beam at the computed ticks") {
  struct Case {
    double speed, height, distance, radius;
  };
  for (const auto kind : {TracerKind::reference, TracerKind::embree}) {
    for (const Case& c : {Case{1.0, 0.0, 3.0, 0.305}, Case{1.3, 0.1, 2.0, 0.25}, Case{0.7, -0.2, 5.0, 0.5}}) {
      // Within the beam while x^2 + height^2 < radius^2: half the chord at that height, met at x = 0 from both sides.
      const double half_chord = std::sqrt(c.radius * c.radius - c.height * c.height);
      const int enters = static_cast<int>(std::ceil((2.0 - half_chord) / c.speed * 50.0));
      const int leaves = static_cast<int>(std::floor((2.0 + half_chord) / c.speed * 50.0)) + 1;
      const Crossing crossing = cross(kind, c.speed, c.height, c.distance, c.radius, 12.0);
      CHECK(crossing.first_active == enters);
      CHECK(crossing.last_active == leaves - 1);
      CHECK(crossing.motion == std::vector<int>{enters, leaves});
    }
  }
}

TEST_CASE("a sphere beyond the beam's range, above it or behind the sensor is never seen") {
  const auto kind = TracerKind::embree;
  CHECK(cross(kind, 1.0, 0.0, 3.2, 0.3, 3.0).first_active > 0);   // its near side is within 3 m: 2.9 m
  CHECK(cross(kind, 1.0, 0.0, 3.31, 0.3, 3.0).first_active < 0);  // 3.01 m
  CHECK(cross(kind, 1.0, 0.31, 2.0, 0.3, 3.0).first_active < 0);
  CHECK(cross(kind, 1.0, 0.0, -2.0, 0.3, 3.0).first_active < 0);
}
