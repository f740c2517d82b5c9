// Leaves of doors cut rays where plain geometry says, and every tracer sees the same past them.
#include "engine/rt/tracer.hpp"

#include <array>
#include <cmath>

#include "support/catch.hpp"
#include "support/random_scene.hpp"

using namespace pirsim;
using namespace pirsim::testing;

namespace {

constexpr double tick_s = 0.05;

DoorSpec random_door(Draw& draw, const std::string& id) {
  DoorSpec door;
  door.id = id;
  door.world_from_door = {rotation_from_heading(draw.between(-pi, pi)), draw.inside({-2, 0, -2}, {2, 0, 2})};
  door.width_m = draw.between(0.6, 1.2);
  door.hinge = draw.index(2) == 0 ? DoorHinge::left : DoorHinge::right;
  door.opens = draw.index(2) == 0 ? DoorOpens::inward : DoorOpens::outward;
  door.open_deg = draw.between(60.0, 170.0);
  door.turn_s = 19.0 * tick_s;
  return door;
}

/// The corners of the leaf from the door's numbers alone: a plan, extruded. Seen by who goes along -Z, x is to the
/// right.
std::array<Vec3, 8> corners_by_hand(const DoorSpec& door, double turned) {
  const double side = door.hinge == DoorHinge::left ? 1.0 : -1.0;
  const double in = door.opens == DoorOpens::inward ? 1.0 : -1.0;
  const Vec2 hinge(-0.5 * side * door.width_m, 0.0);
  const Vec2 along(side * std::cos(turned), -in * std::sin(turned)), across(-along.y, along.x);
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec2 p =
        hinge + ((i & 1) != 0 ? door.width_m : 0.0) * along + ((i & 4) != 0 ? 0.5 : -0.5) * door.thickness_m * across;
    corners[i] = door.world_from_door * Vec3(p.x, (i & 2) != 0 ? door.height_m : 0.0, p.y);
  }
  return corners;
}

}  // namespace

TEST_CASE("at twenty angles leaves cut rays where a box of twelve triangles does") {
  Draw draw(11);
  TriMesh box = box_mesh({0, 0, 0}, {1, 1, 1});
  std::size_t n_cut = 0, n_wrong = 0;
  for (int tries = 0; tries < 20; ++tries) {
    const DoorSpec door = random_door(draw, "D");
    const std::vector<DoorLeaf> leaves{DoorLeaf(door, tick_s)};
    REQUIRE(leaves[0].open_step() == 19);
    RayBundle bundle;
    for (int i = 0; i < 400; ++i) {
      const Vec3 middle = door.world_from_door * Vec3(0, 1, 0);
      bundle.rays.push_back(ray_through(draw.inside({-4, 0.2, -4}, {4, 2.5, 4}), middle + 0.9 * draw.direction()));
      bundle.range.push_back(8.0F);
    }
    const rt::LeafCuts cuts(bundle, leaves);
    std::vector<float> range;
    for (LeafStep step = 0; step < 20; ++step) {
      cuts.cut(std::array{step}, range);
      const auto corners = corners_by_hand(door, radians(door.open_deg) * step / 19.0);
      box.positions.assign(corners.begin(), corners.end());
      for (std::size_t i = 0; i < bundle.rays.size(); ++i) {
        double expected = 8.0, uncertainty = 1e30;
        bool inside = signed_distance(leaves[0].at(step), Vec3(bundle.rays[i].origin)) < 1e-4;
        for (std::size_t t = 0; t < 12 && !inside; ++t) {
          const auto hit = intersect(bundle.rays[i], corners_of(box, t));
          if (!hit || hit->distance < 0.0) continue;
          if (hit->inside >= 0.0) expected = std::min(expected, hit->distance);
          uncertainty = std::min(uncertainty, std::abs(hit->inside));
        }
        if (inside) continue;
        n_cut += expected < 8.0 ? 1 : 0;
        // Diagonals of faces are no edges: what differs there differs by nothing.
        if (std::abs(range[i] - expected) > 1e-4 && uncertainty > 1e-4) ++n_wrong;
      }
    }
  }
  CHECK(n_wrong == 0);
  CHECK(n_cut > 10000);
}

TEST_CASE("an open leaf's mesh has the box's corners") {
  Draw draw(12);
  for (int tries = 0; tries < 50; ++tries) {
    const DoorSpec door = random_door(draw, "D");
    const DoorLeaf leaf(door, tick_s);
    const TriMesh mesh = leaf.open_mesh();
    for (const Vec3& corner : corners_by_hand(door, radians(door.open_deg))) {
      CHECK(std::ranges::any_of(mesh.positions, [&](const Vec3& p) { return glm::distance(p, corner) < 1e-9; }));
      CHECK(std::abs(signed_distance(leaf.at(leaf.open_step()), corner)) < 1e-5);
    }
  }
}

TEST_CASE("distances on the floor to what a leaf sweeps are those to its steps") {
  Draw draw(13);
  for (int tries = 0; tries < 300; ++tries) {
    DoorSpec door = random_door(draw, "D");
    door.turn_s = 200.0 * tick_s;
    const DoorLeaf leaf(door, tick_s);
    const Vec3 point = draw.inside({-3, 1, -3}, {3, 1, 3});
    double least = 1e30;
    for (LeafStep step = 0; step <= leaf.open_step(); ++step) {
      least = std::min(least, std::max(0.0, signed_distance(leaf.at(step), point)));
    }
    CHECK(leaf.distance_to_sweep_m(floor_point(point)) == Approx(least).margin(0.03));
    CHECK(glm::distance(leaf.threshold(), floor_point(point)) - leaf.reach_m() <= least + 1e-9);
  }
}

TEST_CASE("all tracers see the same past leaves that turn") {
  std::size_t n_seen = 0, n_hidden = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Draw draw(seed);
    RandomScene scene = random_scene(draw);
    SceneSpec spec;
    spec.doors = {random_door(draw, "A"), random_door(draw, "B")};
    const std::vector<DoorLeaf> leaves = leaves_of(spec, tick_s);
    const rt::Room room(scene.room);
    RayBundle clipped = scene.bundle;
    room.clip(clipped);
    const rt::LeafCuts cuts(clipped, leaves);
    const rt::TracerSetup setup{&room, &scene.bundle, &clipped, &cuts};
    const std::array tracers{rt::make_tracer(TracerKind::reference, setup), rt::make_tracer(TracerKind::embree, setup),
                             rt::make_tracer(TracerKind::direct, setup)};
    const auto without = rt::make_tracer(TracerKind::reference, {&room, &scene.bundle, &clipped});
    ZoneSet bare(scene.bundle.n_zones());
    without->add(0, scene.solids, bare);
    const std::vector<std::uint8_t> surfaces(scene.solids.size(), 0);
    const std::array<rt::Moved, 1> there{{{0, scene.solids, surfaces}}}, gone{{{0, {}, {}}}};
    for (int turn = 0; turn < 8; ++turn) {
      const std::array steps{static_cast<LeafStep>(draw.index(20)), static_cast<LeafStep>(draw.index(20))};
      std::array<ZoneSet, 3> zones;
      std::array<std::vector<rt::SolidId>, 3> hits;
      for (std::size_t t = 0; t < 3; ++t) {
        if (turn > 0) tracers[t]->turn_leaves(steps);  // at first they stand as before a run
        zones[t] = ZoneSet(scene.bundle.n_zones());
        tracers[t]->add(0, scene.solids, zones[t]);
        std::vector<rt::FirstHitChange> changes;
        tracers[t]->follow(there, changes);
        hits[t] = tracers[t]->first_hits();
        tracers[t]->follow(gone, changes);
      }
      CHECK(zones[1] == zones[0]);
      CHECK(zones[2] == zones[0]);
      CHECK(hits[1] == hits[0]);
      CHECK(hits[2] == hits[0]);
      for (std::size_t zone = 0; zone < bare.size(); ++zone) {
        CHECK((bare.test(zone) || !zones[0].test(zone)));
        n_seen += zones[0].test(zone) ? 1 : 0;
        n_hidden += bare.test(zone) && !zones[0].test(zone) ? 1 : 0;
      }
    }
  }
  CHECK(n_seen > 500);
  CHECK(n_hidden > 100);
}
