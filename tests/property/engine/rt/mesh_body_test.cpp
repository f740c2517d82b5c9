// Mesh bodies before every tracer.
#include <algorithm>

#include "engine/rt/tracer.hpp"
#include "pirsim/model.hpp"
#include "support/catch.hpp"
#include "support/fine_mesh.hpp"
#include "support/zone_bytes.hpp"

using namespace pirsim;
using pirsim::TracerKind;
using pirsim::testing::Draw;
using pirsim::testing::RandomScene;
using namespace pirsim::test;

namespace {

constexpr TracerKind usual = CompileOptions{}.tracer;
constexpr std::array three_kinds{TracerKind::reference, TracerKind::embree, usual};

/// Closed and open surfaces; the same ones stand in for many solids, as they do for a person's.
std::vector<MeshSolid> wardrobe(Draw& draw) {
  std::vector<MeshSolid> meshes{testing::mesh_solid(testing::round_mesh(0.12, 0.0, 3)),
                                testing::mesh_solid(testing::round_mesh(0.06, 0.2, 2)),
                                testing::mesh_solid(testing::box_mesh({-0.2, -0.3, -0.1}, {0.2, 0.3, 0.1})),
                                testing::mesh_solid({"sheet", {{0, 0, 0}, {0.3, 0, 0}, {0, 0.5, 0}}, {{0, 1, 2}}})};
  meshes.push_back(testing::mesh_solid(testing::triangle_soup(draw, 60)));
  return meshes;
}

const MeshSolid& any_of(const std::vector<MeshSolid>& meshes, Draw& draw) {
  return meshes[draw.index(static_cast<std::uint32_t>(meshes.size()))];
}
Frame anywhere(Draw& draw) { return {draw.rotation(), draw.inside({-2, 0, -2}, {2, 2, 2})}; }

}  // namespace

TEST_CASE("all tracers give the same zones in 250 random scenes with mesh bodies", "[rt][mesh_body]") {
  std::size_t n_zones = 0, n_active = 0, n_by_meshes = 0;
  for (std::uint64_t seed = 0; seed < 250; ++seed) {
    Draw draw(60000 + seed);
    const std::vector<MeshSolid> meshes = wardrobe(draw);
    const RandomScene scene = testing::random_scene(draw);
    const rt::Room room(scene.room);
    RayBundle clipped = scene.bundle;
    room.clip(clipped);
    std::vector<std::unique_ptr<rt::Tracer>> tracers;
    for (const TracerKind kind : three_kinds)
      tracers.push_back(rt::make_tracer(kind, {&room, &scene.bundle, &clipped}));
    std::vector<PosedShape> solids = scene.solids;
    for (int tick = 0; tick < 4; ++tick) {
      for (PosedShape& solid : solids) {
        if (draw.index(2) == 0) solid = place(any_of(meshes, draw), anywhere(draw));
      }
      const std::size_t n = scene.bundle.n_zones();
      const ZoneBytes expected = seen_by(*tracers[0], solids, n);
      for (std::size_t i = 1; i < tracers.size(); ++i) {
        INFO("seed " << seed << ", tick " << tick << ", " << rt::name(three_kinds[i]) << " tracer");
        REQUIRE(seen_by(*tracers[i], solids, n) == expected);
      }
      std::vector<PosedShape> primitives = solids;
      std::erase_if(primitives, [](const PosedShape& solid) { return std::holds_alternative<PosedMesh>(solid); });
      const ZoneBytes without_meshes = seen_by(*tracers[0], primitives, n);
      n_zones += expected.size();
      n_active += static_cast<std::size_t>(std::count(expected.begin(), expected.end(), 1));
      for (std::size_t i = 0; i < expected.size(); ++i) n_by_meshes += expected[i] != without_meshes[i] ? 1 : 0;
    }
  }
  CHECK(n_by_meshes > n_zones / 50);
  WARN(n_zones << " zones compared, " << n_active << " active, " << n_by_meshes << " of them by meshes alone");
}

TEST_CASE("no tracer leaves out a mesh that a ray clips by micrometres at its outermost vertex", "[rt][mesh_body]") {
  const rt::Room nothing{{}};
  Draw draw(61);
  std::size_t n_hits = 0;
  constexpr int n_rays = 2000;
  for (int i = 0; i < n_rays; ++i) {
    const std::vector<MeshSolid> meshes = wardrobe(draw);
    const MeshSolid& mesh = meshes[draw.index(3)];  // a convex one
    const Frame frame{draw.index(2) == 0 ? Quat(1, 0, 0, 0) : draw.rotation(), draw.inside({-6, 0, -6}, {6, 3, 6})};
    const Vec3 outwards = draw.direction();
    const auto& positions = mesh.surface->mesh().positions;
    const Vec3 vertex = *std::max_element(positions.begin(), positions.end(), [&](const Vec3& a, const Vec3& b) {
      return glm::dot(frame.rotation * a, outwards) < glm::dot(frame.rotation * b, outwards);
    });
    const Vec3 aim = frame * vertex - outwards * std::pow(10.0, draw.between(-6.0, -3.0));
    const Vec3 along = glm::normalize(glm::cross(outwards, draw.direction()));
    RayBundle bundle;
    bundle.rays.push_back({Vec3f(aim - draw.between(1.0, 11.0) * along), Vec3f(along)});
    bundle.range.push_back(12.0F);
    testing::close_zone(bundle);
    testing::close_cluster(bundle);
    testing::close_sensor(bundle);
    std::vector<PosedShape> solids{place(mesh, frame)};
    while (solids.size() < 8) {
      solids.push_back(place(any_of(meshes, draw), {draw.rotation(), draw.inside({-6, 50, -6}, {6, 60, 6})}));
    }
    const bool expected = entry_distance(bundle.rays[0], solids[0], 12.0F).has_value();
    n_hits += expected ? 1 : 0;
    for (const TracerKind kind : three_kinds) {
      const ZoneBytes zones = seen_by(*rt::make_tracer(kind, {&nothing, &bundle, &bundle}), solids, 1);
      INFO("ray " << i << ", " << rt::name(kind) << " tracer");
      REQUIRE((zones[0] == 1) == expected);
    }
  }
  CHECK(n_hits > n_rays * 3 / 4);
}

TEST_CASE("the usual tracer, which remembers what it has seen, tells two meshes at one place apart",
          "[rt][mesh_body]") {
  const rt::Room nothing{{}};
  RayBundle bundle;
  bundle.rays.push_back({Vec3f(0, 0, 3), Vec3f(0, 0, -1)});
  bundle.range.push_back(6.0F);
  testing::close_zone(bundle);
  testing::close_cluster(bundle);
  testing::close_sensor(bundle);
  const MeshSolid in_the_way = testing::mesh_solid(testing::box_mesh(Vec3(-0.1), Vec3(0.1)));
  const MeshSolid beside = testing::mesh_solid(testing::box_mesh({0.2, -0.1, -0.1}, {0.4, 0.1, 0.1}));
  const auto tracer = rt::make_tracer(usual, {&nothing, &bundle, &bundle});
  const auto sees = [&](const PosedShape& solid) { return seen_by(*tracer, std::vector{solid}, 1)[0] == 1; };
  for (int round = 0; round < 2; ++round) {
    CHECK(sees(place(in_the_way, {})));
    CHECK_FALSE(sees(place(beside, {})));
    CHECK(sees(place(beside, {Quat(1, 0, 0, 0), {-0.3, 0, 0}})));
    CHECK(sees(place(beside, {glm::angleAxis(0.2, Vec3(0, 0, 1)), {-0.3, 0, 0}})));
    CHECK_FALSE(sees(place(beside, {rotation_from_heading(1.5), {-0.3, 0, 0}})));
  }
}
