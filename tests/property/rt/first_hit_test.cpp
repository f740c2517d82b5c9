// What each ray hits first, by every tracer.
#include <algorithm>
#include <memory>

#include "rt/tracer.hpp"
#include "support/catch.hpp"
#include "support/fine_mesh.hpp"
#include "support/random_scene.hpp"

using namespace pirsim;
using pirsim::TracerKind;
using pirsim::rt::FirstHit;
using pirsim::testing::Draw;
using pirsim::testing::RandomScene;

namespace {

constexpr std::array kinds{TracerKind::reference, TracerKind::embree, TracerKind::direct};

/// One ray after the other against one solid after the other.
std::vector<FirstHit> by_brute_force(const RayBundle& clipped, const std::vector<PosedShape>& solids) {
  std::vector<FirstHit> hits;
  for (std::uint32_t ray = 0; ray < clipped.rays.size(); ++ray) {
    float reach = clipped.range[ray];
    std::optional<std::uint32_t> first;
    for (std::uint32_t solid = 0; solid < solids.size(); ++solid) {
      if (const auto distance = entry_distance(clipped.rays[ray], solids[solid], reach)) {
        reach = *distance;
        first = solid;
      }
    }
    if (first) hits.push_back({ray, *first});
  }
  return hits;
}

void sort(std::vector<FirstHit>& hits) { std::ranges::sort(hits, {}, &FirstHit::ray); }

}  // namespace

TEST_CASE("all tracers agree in 400 random scenes on the solid that each ray hits first", "[rt][first_met]") {
  std::size_t n_hits = 0, n_hidden = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Draw draw(90000 + seed);
    const RandomScene scene = testing::random_scene(draw);
    const rt::Room room(scene.room);
    RayBundle clipped = scene.bundle;
    room.clip(clipped);
    std::vector<std::unique_ptr<rt::Tracer>> tracers;
    for (const TracerKind kind : kinds) tracers.push_back(rt::make_tracer(kind, {&room, &scene.bundle, &clipped}));
    std::vector<PosedShape> solids = scene.solids;
    const MeshSolid mesh = testing::mesh_solid(testing::round_mesh(0.15, 0.1, 2));
    for (int tick = 0; tick < 4; ++tick) {
      for (PosedShape& solid : solids) {
        const Frame frame{draw.rotation(), draw.inside({-2, 0, -2}, {2, 2, 2})};
        if (draw.index(3) == 0) solid = draw.index(4) == 0 ? place(mesh, frame) : place(draw.shape(), frame);
      }
      // A twin in the same place is hits as early: the first of the two counts.
      if (solids.size() > 1) solids.back() = solids.front();
      const std::vector<FirstHit> expected = by_brute_force(clipped, solids);
      n_hits += expected.size();
      for (const FirstHit& each : expected) n_hidden += each.solid + 1 == solids.size() && solids.size() > 1 ? 1 : 0;
      for (std::size_t i = 0; i < kinds.size(); ++i) {
        INFO("seed " << seed << ", tick " << tick << ", " << rt::name(kinds[i]) << " tracer");
        std::vector<FirstHit> hits{{7, 7}};
        tracers[i]->find_first(solids, hits);
        sort(hits);
        REQUIRE(hits == expected);
      }
    }
    // Somebody leaves.
    solids.resize(solids.size() / 2);
    const std::vector<FirstHit> expected = by_brute_force(clipped, solids);
    for (const auto& tracer : tracers) {
      std::vector<FirstHit> hits;
      tracer->find_first(solids, hits);
      sort(hits);
      REQUIRE(hits == expected);
    }
  }
  CHECK(n_hits > 5000);
  CHECK(n_hidden == 0);
}
