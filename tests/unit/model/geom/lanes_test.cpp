#include "model/geom/ray_tests.hpp"

#include <array>
#include <cstring>

#include "support/catch.hpp"
#include "support/random_shapes.hpp"

using namespace pirsim;
using ray_tests::Lanes, ray_tests::n_lanes;

namespace {
template <typename F>
ray_tests::Vector<F> vector(const Vec3f& v) {
  return {F(v.x), F(v.y), F(v.z)};
}
}  // namespace

TEST_CASE("a lane gets the bits that a float gets", "[lanes]") {
  testing::Draw draw(5);
  std::size_t hits = 0, differences = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3 from = draw.inside({-8, 0, -8}, {8, 3, 8}), middle = draw.inside({-4, 0, -4}, {4, 2, 4});
    const Ray ray = testing::ray_through(from, middle + draw.inside(Vec3(-0.25), Vec3(0.25)));
    Vec3f a(middle + 0.2 * draw.direction()), b(middle - 0.2 * draw.direction());
    if (i % 50 == 0) b = a;                  // a sphere
    if (i % 50 == 1) b = a + ray.direction;  // along the ray
    const float radius = static_cast<float>(draw.between(0.01, 0.2)),
                range = static_cast<float>(draw.between(0.0, 20.0));
    const bool hit = entry_distance(ray, PosedCapsule{a, b, radius}, range).has_value();
    const auto lanes = ray_tests::capsule(vector<Lanes>(ray.origin), vector<Lanes>(ray.direction),
                                          ray_tests::capsule_axis(vector<Lanes>(a), vector<Lanes>(b)), Lanes(radius));
    const auto single = ray_tests::capsule(vector<float>(ray.origin), vector<float>(ray.direction),
                                           ray_tests::capsule_axis(vector<float>(a), vector<float>(b)), radius);
    const unsigned int mask = bits(ray_tests::is_hit(lanes, Lanes(range)));
    std::array<float, n_lanes> enter;
    std::memcpy(enter.data(), &lanes.enter.value, sizeof enter);
    for (std::size_t lane = 0; lane < enter.size(); ++lane) {
      const bool is_same = std::memcmp(&enter[lane], &single.enter, sizeof(float)) == 0;
      if (((mask >> lane & 1U) != 0) != hit || !is_same) ++differences;
    }
    hits += hit ? 1 : 0;
  }
  CHECK(differences == 0);
  CHECK(hits > 20000);
  CHECK(hits < 180000);
}
