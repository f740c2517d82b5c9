// What each ray hits first of several people, by every tracer.
#include <algorithm>
#include <memory>
#include <vector>

#include "engine/rt/tracer.hpp"
#include "support/catch.hpp"
#include "support/fine_mesh.hpp"
#include "support/random_scene.hpp"

using namespace pirsim;
using pirsim::TracerKind;
using pirsim::rt::no_solid;
using pirsim::rt::SolidId;
using pirsim::testing::Draw;
using pirsim::testing::RandomScene;

namespace {

constexpr std::array kinds{TracerKind::reference, TracerKind::embree, TracerKind::direct};

struct Person {
  std::vector<PosedShape> solids;
  std::vector<std::uint8_t> surfaces;
};

/// One ray after the other against one solid after the other.
std::vector<SolidId> by_brute_force(const RayBundle& clipped, const std::vector<Person>& people) {
  std::vector<SolidId> first(clipped.rays.size(), no_solid);
  for (std::size_t ray = 0; ray < first.size(); ++ray) {
    float reach = clipped.range[ray];
    for (std::uint16_t person = 0; person < people.size(); ++person) {
      for (std::uint16_t solid = 0; solid < people[person].solids.size(); ++solid) {
        const auto distance = entry_distance(clipped.rays[ray], people[person].solids[solid], reach);
        if (!distance) continue;
        reach = *distance;
        first[ray] = {person, solid};
      }
    }
  }
  return first;
}

PosedShape moved_by(PosedShape solid, const Vec3f& way) {
  if (auto* sphere = std::get_if<PosedSphere>(&solid)) sphere->centre += way;
  if (auto* capsule = std::get_if<PosedCapsule>(&solid)) capsule->a += way, capsule->b += way;
  if (auto* box = std::get_if<PosedBox>(&solid)) box->centre += way;
  return solid;
}

int surface_of(const std::vector<Person>& people, SolidId id) {
  return id == no_solid ? -1 : 1000 * id.person + people[id.person].surfaces[id.solid];
}

/// A tracer, and what its changes add up to.
struct Followed {
  std::unique_ptr<rt::Tracer> tracer;
  std::vector<SolidId> first;

  /// Who has gone brings changes from solids that `people` still have.
  void follow(std::span<const rt::Moved> moved) {
    std::vector<rt::FirstHitChange> changes{{7, no_solid, no_solid}};
    tracer->follow(moved, changes);
    for (const auto& [ray, before, after] : changes) {
      REQUIRE(before == first[ray]);
      first[ray] = after;
    }
  }
};

}  // namespace

TEST_CASE("all tracers agree in 150 random scenes on what each ray hits first of several people", "[rt][first_met]") {
  std::size_t n_hits = 0, n_of_others = 0, n_twins = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Draw draw(90000 + seed);
    const RandomScene scene = testing::random_scene(draw);
    const rt::Room room(scene.room);
    RayBundle clipped = scene.bundle;
    room.clip(clipped);
    std::vector<Followed> tracers;
    for (const TracerKind kind : kinds) {
      tracers.push_back({rt::make_tracer(kind, {&room, &scene.bundle, &clipped}),
                         std::vector<SolidId>(clipped.rays.size(), no_solid)});
    }
    const MeshSolid mesh = testing::mesh_solid(testing::round_mesh(0.15, 0.1, 2));
    std::vector<Person> people(1 + draw.index(3));
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
      Person& person = people[i % people.size()];
      person.solids.push_back(scene.solids[i]);
      person.surfaces.push_back(static_cast<std::uint8_t>(draw.index(2)));
    }
    for (int tick = 0; tick < 12; ++tick) {
      std::vector<rt::Moved> moved;
      for (std::size_t i = 0; i < people.size(); ++i) {
        if (tick > 0 && draw.index(2) == 0) continue;
        Person& person = people[i];
        for (PosedShape& solid : person.solids) {
          const Frame frame{draw.rotation(), draw.inside({-2, 0, -2}, {2, 2, 2})};
          // Most go on a little, and come before or behind what they were behind or before.
          if (draw.index(4) == 0) solid = draw.index(4) == 0 ? place(mesh, frame) : place(draw.shape(), frame);
          if (draw.index(2) == 0) solid = moved_by(solid, Vec3f(draw.inside({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1})));
        }
        // A twin in the same place is hit as early: the first of the two counts.
        if (person.solids.size() > 1) person.solids.back() = person.solids.front();
        // Somebody leaves, or part of them.
        if (tick == 8) person.solids.resize(draw.index(2) == 0 ? 0 : person.solids.size() / 2);
        person.surfaces.resize(person.solids.size());
        moved.push_back({i, person.solids, person.surfaces});
      }
      const std::vector<SolidId> expected = by_brute_force(clipped, people);
      for (std::size_t ray = 0; ray < expected.size(); ++ray) {
        const SolidId id = expected[ray];
        if (id == no_solid) continue;
        ++n_hits;
        const auto& solids = people[id.person].solids;
        n_twins += id.solid > 0 && solids.size() > 1 && id.solid + 1U == solids.size() && tick < 8 ? 1 : 0;
        n_of_others += id.person > 0 ? 1 : 0;
      }
      for (std::size_t i = 0; i < kinds.size(); ++i) {
        INFO("seed " << seed << ", tick " << tick << ", " << rt::name(kinds[i]) << " tracer");
        tracers[i].follow(moved);
        REQUIRE(tracers[i].tracer->first_hits() == expected);
        for (std::size_t ray = 0; ray < expected.size(); ++ray) {
          REQUIRE(surface_of(people, tracers[i].first[ray]) == surface_of(people, expected[ray]));
        }
      }
    }
  }
  CHECK(n_hits > 5000);
  CHECK(n_of_others > 1000);
  CHECK(n_twins == 0);
}
