#include "engine/rt/tracer.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/rt/direct_tracer.hpp"
#include "model/core/parallel.hpp"
#include "support/catch.hpp"
#include "support/random_scene.hpp"
#include "support/zone_bytes.hpp"

using namespace pirsim;
using pirsim::TracerKind;
using pirsim::testing::Draw;
using pirsim::testing::RandomScene;
using namespace pirsim::test;

namespace {

/// A scene with its tracers.
struct Traced {
  explicit Traced(const RandomScene& scene) : rated(scene.bundle), clipped(scene.bundle), room(scene.room) {
    room.clip(clipped);
    reference = rt::make_tracer(TracerKind::reference, {&room, &rated, &clipped});
    embree = rt::make_tracer(TracerKind::embree, {&room, &rated, &clipped});
    for (const rt::RayKernel* kernel : rt::all_ray_kernels()) {
      if (kernel->is_available())
        direct.emplace_back(std::make_unique<rt::DirectTracer>(rt::TracerSetup{&room, &rated, &clipped}, *kernel));
    }
  }
  ZoneBytes by(rt::Tracer& tracer, const std::vector<PosedShape>& solids) const {
    return seen_by(tracer, solids, rated.n_zones());
  }

  RayBundle rated, clipped;
  rt::Room room;
  std::unique_ptr<rt::Tracer> reference, embree;
  std::vector<std::unique_ptr<rt::DirectTracer>> direct;  ///< one an instruction set
};

std::size_t active(const ZoneBytes& zones) {
  return static_cast<std::size_t>(std::count(zones.begin(), zones.end(), std::uint8_t{1}));
}

/// A direction in which a solid's oriented box touches it, and the point where it does: an axis for round solids, a
/// point on an edge for a box.
std::pair<Vec3, Vec3> outermost_point(Draw& draw, const PosedShape& shape) {
  const double side = draw.index(2) == 0 ? -1.0 : 1.0;
  if (const auto* s = std::get_if<PosedSphere>(&shape)) {
    Vec3 axis(0.0);
    axis[static_cast<int>(draw.index(3))] = side;
    return {axis, Vec3(s->centre) + axis * double(s->radius)};
  }
  if (const auto* c = std::get_if<PosedCapsule>(&shape)) {
    const Vec3 axis = glm::normalize(side * (Vec3(c->b) - Vec3(c->a)));
    return {axis, Vec3(side > 0 ? c->b : c->a) + axis * double(c->radius)};
  }
  const auto& b = std::get<PosedBox>(shape);
  const int i = static_cast<int>(draw.index(3)), j = (i + 1) % 3, k = (i + 2) % 3;
  const Vec3 first = side * Vec3(b.axes[i]), second = Vec3(b.axes[j]);
  const Vec3 corner = Vec3(b.centre) + first * double(b.half_extents[i]) + second * double(b.half_extents[j]);
  return {glm::normalize(first + second),
          corner + draw.between(-0.5, 0.5) * double(b.half_extents[k]) * Vec3(b.axes[k])};
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

TEST_CASE(
    "all tracers, on every instruction set, give the same zones in 800 random scenes, while people come, move and go",
    "[rt][seconds]") {
  std::size_t n_zones = 0, n_active = 0;
  for (std::uint64_t seed = 0; seed < 800; ++seed) {
    Draw draw(1000 + seed);
    const RandomScene scene = testing::random_scene(draw);
    const Traced traced(scene);
    std::vector<PosedShape> solids = scene.solids;
    for (int tick = 0; tick < 4; ++tick) {
      INFO("seed " << 1000 + seed << ", tick " << tick << ", " << solids.size() << " solids");
      const ZoneBytes expected = traced.by(*traced.reference, solids);
      REQUIRE(traced.by(*traced.embree, solids) == expected);
      for (const auto& direct : traced.direct) REQUIRE(traced.by(*direct, solids) == expected);
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

TEST_CASE("people traced one by one give the zones of all of them together", "[rt]") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Draw draw(3000 + seed);
    const RandomScene scene = testing::random_scene(draw);
    const Traced traced(scene);
    const std::span<const PosedShape> all(scene.solids);
    const std::size_t cut = draw.index(static_cast<std::uint32_t>(all.size()) + 1);
    const ZoneBytes together = traced.by(*traced.reference, scene.solids);
    for (rt::Tracer* tracer : {static_cast<rt::Tracer*>(traced.direct.front().get()), traced.embree.get()}) {
      ZoneSet apart(together.size());
      tracer->add(0, all.first(cut), apart);
      tracer->add(1, all.subspan(cut), apart);
      REQUIRE(bytes_of(apart) == together);
    }
  }
}

TEST_CASE("the tracers agree with a loop over all triangles and solids in double precision", "[rt][seconds]") {
  constexpr double grazing = 1e-5;  // metres
  std::size_t n_zones = 0, n_grazing = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Draw draw(5000 + seed);
    const RandomScene scene = testing::random_scene(draw);
    const Traced traced(scene);
    const ZoneBytes zones = traced.by(*traced.embree, scene.solids);
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

TEST_CASE("Embree leaves out no solid that a ray clips by micrometres at its outermost points", "[rt]") {
  const rt::Room nothing{{}};
  std::size_t n_hits = 0;
  constexpr int n_rays = 4000;
  Draw draw(12);
  for (int i = 0; i < n_rays; ++i) {
    // Square to the world, where Embree's boxes are tightest, or turned anyhow; others far off, so that there are
    // boxes.
    const Frame frame{draw.index(2) == 0 ? Quat(1, 0, 0, 0) : draw.rotation(), draw.inside({-6, 0, -6}, {6, 3, 6})};
    const PosedShape solid = place(draw.shape(), frame);
    std::vector<PosedShape> solids(8, solid);
    for (std::size_t k = 1; k < solids.size(); ++k) {
      solids[k] = place(draw.shape(), {draw.rotation(), draw.inside({-6, 50, -6}, {6, 60, 6})});
    }
    const auto [outwards, outermost] = outermost_point(draw, solid);
    const Vec3 along = glm::normalize(glm::cross(outwards, draw.direction()));
    const Vec3 aim = outermost - outwards * std::pow(10.0, draw.between(-6.0, -3.0));
    RayBundle bundle;
    bundle.rays.push_back({Vec3f(aim - draw.between(1.0, 11.0) * along), Vec3f(along)});
    bundle.range.push_back(12.0F);
    testing::close_zone(bundle);
    testing::close_cluster(bundle);
    testing::close_sensor(bundle);
    const bool expected = entry_distance(bundle.rays[0], solid, 12.0F).has_value();
    n_hits += expected ? 1 : 0;
    for (const TracerKind kind : {TracerKind::reference, TracerKind::embree}) {
      const ZoneBytes zones = seen_by(*rt::make_tracer(kind, {&nothing, &bundle, &bundle}), solids, 1);
      INFO("ray " << i << ", shape " << solid.index() << ", " << rt::name(kind) << " tracer");
      REQUIRE((zones[0] == 1) == expected);
    }
  }
  CHECK(n_hits > n_rays * 9 / 10);
}

TEST_CASE("an occluder that is added never adds an active zone, and boxed-in sensors see nobody", "[rt]") {
  std::size_t taken = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(7000 + seed);
    RandomScene scene = testing::random_scene(draw);
    const Traced before(scene);
    const ZoneBytes without = before.by(*before.embree, scene.solids);
    const Vec3 low = draw.inside({-2.5, 0, -2.5}, {0.5, 0.5, 0.5});
    scene.room.push_back(testing::box_mesh(low, low + draw.inside({1, 1, 1}, {2, 2, 2})));
    const Traced after(scene);
    const ZoneBytes with = after.by(*after.embree, scene.solids);
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
    const ZoneBytes zones = here.by(*here.embree, scene.solids);
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
    constexpr std::array kinds{TracerKind::embree, TracerKind::reference, TracerKind::direct};
    const TracerKind kind = kinds[i % kinds.size()];
    const auto tracer = rt::make_tracer(kind, {&traced.room, &traced.rated, &traced.clipped});
    ZoneBytes all;
    for (int tick = 0; tick < 50; ++tick) {
      std::vector<PosedShape> solids = scene.solids;
      for (PosedShape& solid : solids) {
        solid = place(own.shape(), {own.rotation(), own.inside({-2, 0, -2}, {2, 2, 2})});
      }
      const ZoneBytes zones = traced.by(*tracer, solids);
      all.insert(all.end(), zones.begin(), zones.end());
    }
    return all;
  };
  std::vector<ZoneBytes> alone, together;
  for (std::size_t i = 0; i < 24; ++i) alone.push_back(run(i));
  ordered_parallel<ZoneBytes>(24, 0, run, [&](ZoneBytes& zones) { together.push_back(zones); });
  CHECK(alone == together);
}
