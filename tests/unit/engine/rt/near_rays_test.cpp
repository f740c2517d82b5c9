#include "engine/rt/tracer.hpp"

#include <bit>

#include "engine/rt/direct_tracer.hpp"
#include "support/catch.hpp"
#include "support/fine_mesh.hpp"
#include "support/random_scene.hpp"
#include "support/zone_bytes.hpp"

using namespace pirsim;
using namespace pirsim::rt;
using pirsim::testing::Draw;
using pirsim::testing::RandomScene;

namespace {

/// A frame a little off another: by up to `metres`, turned by up to `radians`.
Frame moved(Draw& draw, const Frame& frame, double metres, double radians) {
  const Quat turn = glm::angleAxis(draw.between(0.0, radians), draw.direction());
  return {glm::normalize(turn * frame.rotation), frame.origin + draw.between(0.0, metres) * draw.direction()};
}

/// A point on the surface of a solid in its own frame, or inside.
Vec3 point_of(Draw& draw, const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius * draw.direction();
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return draw.between(-1.0, 1.0) * Vec3(0, capsule->half_length, 0) + capsule->radius * draw.direction();
  }
  const Vec3 half = std::get<Box>(shape).half_extents;
  const auto side = [&] { return draw.index(2) == 0 ? -1.0 : 1.0; };
  const double x = side(), y = side(), z = side();
  return half * Vec3(x, y, z);
}

}  // namespace

TEST_CASE("no point of a solid moves farther than its displacement nor leaves the grown solid", "[rt]") {
  Draw draw(31);
  std::size_t n_far = 0, n_outside = 0, n_beyond_half = 0;
  constexpr std::size_t n = 20000;
  for (std::size_t i = 0; i < n; ++i) {
    const Shape shape = draw.shape();
    const Frame before{draw.rotation(), draw.inside({-6, 0, -6}, {6, 3, 6})};
    const Frame after = moved(draw, before, 0.1, 0.3);
    const PosedShape from = place(shape, before), to = place(shape, after);
    const Vec3 point = point_of(draw, shape);
    const double displacement = static_cast<double>(displacement_m(from, to));
    const double moved_m = glm::distance(before * point, after * point);
    // A sphere and a capsule may turn about themselves: what counts is how far the solid as a whole is from where it
    // was.
    const double apart_m = testing::signed_distance(from, after * point);
    constexpr double rounding_m = 1e-5;
    n_far += apart_m > displacement + rounding_m ? 1 : 0;
    if (std::holds_alternative<Box>(shape)) n_far += moved_m > displacement + rounding_m ? 1 : 0;
    n_beyond_half += apart_m > 0.5 * displacement ? 1 : 0;
    const PosedShape around = grown(from, static_cast<float>(displacement));
    n_outside += testing::signed_distance(around, after * point) > rounding_m ? 1 : 0;
  }
  CHECK(n_far == 0);
  CHECK(n_outside == 0);
  CHECK(n_beyond_half > n / 20);  // the bound isn't idle
}

TEST_CASE("solids of different kinds or sizes are infinitely far apart") {
  const PosedSphere sphere{Vec3f(0.0F), 0.1F};
  CHECK(displacement_m(sphere, PosedSphere{Vec3f(0.0F), 0.1F}) == 0.0F);
  CHECK(std::isinf(displacement_m(sphere, PosedSphere{Vec3f(0.0F), 0.2F})));
  CHECK(std::isinf(displacement_m(sphere, PosedCapsule{Vec3f(0.0F), Vec3f(0.0F), 0.1F})));
  CHECK(std::isinf(displacement_m(PosedMesh{}, PosedMesh{})));
}

TEST_CASE("a tracer that follows moving solids gives the bits of one that sees each place for the first time", "[rt]") {
  Draw draw(32);
  const Shape mesh = testing::meshed(Capsule{0.1, 0.2}, 3);
  std::size_t n_wrong = 0, n_active = 0;
  for (int scene_index = 0; scene_index < 6; ++scene_index) {
    const RandomScene scene = testing::random_scene(draw);
    const Room room(scene.room);
    RayBundle clipped = scene.bundle;
    room.clip(clipped);
    DirectTracer following({&room, &scene.bundle, &clipped});
    std::vector<Shape> shapes{draw.shape(), draw.shape(), draw.shape(), draw.shape(), mesh};
    std::vector<Frame> frames(shapes.size());
    for (Frame& frame : frames) frame = {draw.rotation(), draw.inside({-2, 0, -2}, {2, 2, 2})};
    for (int tick = 0; tick < 150; ++tick) {
      DirectTracer fresh({&room, &scene.bundle, &clipped});
      std::vector<PosedShape> solids;
      const double step_m = tick % 50 == 49 ? 1.0 : 0.03;  // now and then they jump
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        frames[i] = moved(draw, frames[i], step_m, 0.05);
        solids.push_back(place(shapes[i], frames[i]));
      }
      const test::ZoneBytes expected = test::seen_by(fresh, solids, clipped.n_zones());
      const test::ZoneBytes zones = test::seen_by(following, solids, clipped.n_zones());
      for (std::size_t zone = 0; zone < zones.size(); ++zone) {
        n_wrong += zones[zone] != expected[zone] ? 1 : 0;
        n_active += expected[zone];
      }
    }
  }
  CHECK(n_wrong == 0);
  CHECK(n_active > 1000);
}
