#include "pirsim/rt/tracer.hpp"

#include <algorithm>
#include <vector>

#include "pirsim/core/parallel.hpp"
#include "support/catch.hpp"
#include "support/random_scene.hpp"

using namespace pirsim;
using pirsim::rt::TracerKind;
using pirsim::testing::Draw;
using pirsim::testing::RandomScene;

namespace {

/// A scene with its two tracers.
struct Traced {
  explicit Traced(const RandomScene& scene) : rated(scene.bundle), clipped(scene.bundle), room(scene.room) {
    room.clip(clipped);
    reference = rt::make_tracer(TracerKind::reference, {&room, &rated, &clipped});
    embree = rt::make_tracer(TracerKind::embree, {&room, &rated, &clipped});
  }
  ZoneActivity by(rt::Tracer& tracer, const std::vector<PosedShape>& solids) const {
    ZoneActivity zones(rated.n_zones(), std::uint8_t{7});
    tracer.trace(solids, zones);
    return zones;
  }

  RayBundle rated, clipped;
  rt::Room room;
  std::unique_ptr<rt::Tracer> reference, embree;
};

std::size_t active(const ZoneActivity& zones) {
  return static_cast<std::size_t>(std::count(zones.begin(), zones.end(), std::uint8_t{1}));
}

TriMesh mirrored(TriMesh mesh) {
  for (Vec3& position : mesh.positions) position = testing::mirrored(position);
  return mesh;
}
PosedShape mirrored(const PosedShape& shape) {
  if (const auto* s = std::get_if<PosedSphere>(&shape)) return PosedSphere{testing::mirrored(s->centre), s->radius};
  if (const auto* c = std::get_if<PosedCapsule>(&shape)) {
    return PosedCapsule{testing::mirrored(c->a), testing::mirrored(c->b), c->radius};
  }
  const auto& b = std::get<PosedBox>(shape);
  const glm::mat3 axes(-testing::mirrored(b.axes[0]), testing::mirrored(b.axes[1]), testing::mirrored(b.axes[2]));
  return PosedBox{testing::mirrored(b.centre), axes, b.half_extents};
}
RandomScene mirrored(RandomScene scene) {
  for (TriMesh& mesh : scene.room) mesh = mirrored(mesh);
  for (PosedShape& solid : scene.solids) solid = mirrored(solid);
  for (Ray& ray : scene.bundle.rays) ray = testing::mirrored(ray);
  return scene;
}

}  // namespace

TEST_CASE("both tracers give the same zones in 2000 random scenes, while people come, move and go", "[rt]") {
  std::size_t n_zones = 0, n_active = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Draw draw(1000 + seed);
    const RandomScene scene = testing::random_scene(draw);
    const Traced traced(scene);
    std::vector<PosedShape> solids = scene.solids;
    for (int tick = 0; tick < 4; ++tick) {
      INFO("seed " << 1000 + seed << ", tick " << tick << ", " << solids.size() << " solids");
      const ZoneActivity expected = traced.by(*traced.reference, solids);
      REQUIRE(traced.by(*traced.embree, solids) == expected);
      n_zones += expected.size();
      n_active += active(expected);
      if (tick % 2 == 0 && !solids.empty()) solids.resize(draw.index(static_cast<std::uint32_t>(solids.size())));
      for (PosedShape& solid : solids) {
        if (draw.index(2) == 0) solid = place(draw.shape(), {draw.rotation(), draw.inside({-2, 0, -2}, {2, 2, 2})});
      }
      if (tick % 2 == 1) solids.insert(solids.end(), scene.solids.begin(), scene.solids.end());
    }
  }
  CHECK(n_active > n_zones / 20);
  CHECK(n_active < n_zones / 2);
  WARN(n_zones << " zones compared, " << n_active << " of them active");
}

TEST_CASE("the tracers agree with a loop over all triangles and solids in double precision", "[rt]") {
  constexpr double grazing = 1e-5;  // metres
  std::size_t n_zones = 0, n_grazing = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Draw draw(5000 + seed);
    const RandomScene scene = testing::random_scene(draw);
    const Traced traced(scene);
    const ZoneActivity zones = traced.by(*traced.embree, scene.solids);
    for (std::size_t zone = 0; zone < zones.size(); ++zone) {
      bool is_active = false, is_grazing = false;
      for (std::size_t i = scene.bundle.zone_rays_begin[zone]; i < scene.bundle.zone_rays_begin[zone + 1]; ++i) {
        double uncertainty = 0.0;
        is_active |= testing::sees_solid(scene, i, uncertainty);
        is_grazing |= uncertainty < grazing;
      }
      ++n_zones;
      if (is_active != (zones[zone] == 1)) {
        INFO("seed " << 5000 + seed << ", zone " << zone);
        REQUIRE(is_grazing);
        ++n_grazing;
      }
    }
  }
  WARN(n_grazing << " of " << n_zones << " zones differ, all of them with a ray within 1e-5 m of grazing");
  CHECK(n_grazing < n_zones / 1000);
}

TEST_CASE("an occluder that is added never adds an active zone, and boxed-in sensors see nobody", "[rt]") {
  std::size_t taken = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(7000 + seed);
    RandomScene scene = testing::random_scene(draw);
    const Traced before(scene);
    const ZoneActivity without = before.by(*before.embree, scene.solids);
    const Vec3 low = draw.inside({-2.5, 0, -2.5}, {0.5, 0.5, 0.5});
    scene.room.push_back(testing::box_mesh(low, low + draw.inside({1, 1, 1}, {2, 2, 2})));
    const Traced after(scene);
    const ZoneActivity with = after.by(*after.embree, scene.solids);
    for (std::size_t zone = 0; zone < with.size(); ++zone) REQUIRE(with[zone] <= without[zone]);
    taken += active(without) - active(with);

    for (std::size_t i = 0; i < scene.bundle.rays.size(); i += 12 * 20) {  // one a sensor
      const Vec3 eye(scene.bundle.rays[i].origin);
      scene.room.push_back(testing::box_mesh(eye - 1e-3, eye + 1e-3));
    }
    std::erase_if(scene.solids, [&](const PosedShape& solid) {
      return std::any_of(scene.bundle.rays.begin(), scene.bundle.rays.end(),
                         [&](const Ray& ray) { return testing::signed_distance(solid, Vec3(ray.origin)) < 0.01; });
    });
    const Traced boxed_in(scene);
    REQUIRE(active(boxed_in.by(*boxed_in.embree, scene.solids)) == 0);
  }
  CHECK(taken > 100);
}

TEST_CASE("the mirrored scene gives the mirrored zones, exactly", "[rt]") {
  std::size_t n_active = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Draw draw(9000 + seed);
    const RandomScene scene = testing::random_scene(draw);
    const RandomScene mirror = mirrored(scene);
    const Traced here(scene), there(mirror);
    INFO("seed " << 9000 + seed);
    REQUIRE(here.clipped.range == there.clipped.range);
    const ZoneActivity zones = here.by(*here.embree, scene.solids);
    REQUIRE(there.by(*there.embree, mirror.solids) == zones);
    REQUIRE(there.by(*there.reference, mirror.solids) == zones);
    n_active += active(zones);
  }
  CHECK(n_active > 1000);
}

TEST_CASE("tracers of one room on several threads give the zones that one thread gives", "[rt]") {
  Draw draw(11);
  RandomScene scene = testing::random_scene(draw);
  while (scene.solids.size() < 8) scene = testing::random_scene(draw);
  const Traced traced(scene);
  const auto run = [&](std::size_t i) {
    Draw own(20 + i);
    const TracerKind kind = i % 2 == 0 ? TracerKind::embree : TracerKind::reference;
    const auto tracer = rt::make_tracer(kind, {&traced.room, &traced.rated, &traced.clipped});
    ZoneActivity all;
    for (int tick = 0; tick < 50; ++tick) {
      std::vector<PosedShape> solids = scene.solids;
      for (PosedShape& solid : solids) {
        solid = place(own.shape(), {own.rotation(), own.inside({-2, 0, -2}, {2, 2, 2})});
      }
      const ZoneActivity zones = traced.by(*tracer, solids);
      all.insert(all.end(), zones.begin(), zones.end());
    }
    return all;
  };
  std::vector<ZoneActivity> alone, together;
  for (std::size_t i = 0; i < 24; ++i) alone.push_back(run(i));
  ordered_parallel<ZoneActivity>(24, 0, run, [&](ZoneActivity& zones) { together.push_back(zones); });
  CHECK(alone == together);
}
