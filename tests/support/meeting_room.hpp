// A stand-in for the shipped meeting room, its five sensors and a person, for benchmarks and pictures: the measures
// are the paper's, the person is a plain stack of thirteen solids.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "support/random_scene.hpp"

namespace pirsim::testing {

inline constexpr double meeting_room_width = 7.065, meeting_room_depth = 4.345, meeting_room_height = 3.0;  // metres

inline std::vector<TriMesh> meeting_room() {
  const double w = meeting_room_width, d = meeting_room_depth, h = meeting_room_height, t = 0.1;
  std::vector<TriMesh> meshes{box_mesh({-t, -t, -d - t}, {w + t, 0, t}),
                              box_mesh({-t, h, -d - t}, {w + t, h + t, t}),
                              box_mesh({-t, 0, 0}, {w + t, h, t}),
                              box_mesh({-t, 0, -d - t}, {w + t, h, -d}),
                              box_mesh({-t, 0, -d}, {0, h, 0}),
                              box_mesh({w, 0, -d}, {w + t, h, 0}),
                              box_mesh({3.018, 0.70, -3.617}, {4.209, 0.74, -0.385}),
                              box_mesh({3.45, 0, -3.2}, {3.77, 0.70, -3.1}),
                              box_mesh({3.45, 0, -0.9}, {3.77, 0.70, -0.8}),
                              box_mesh({2.9, 1.1, -d}, {4.3, 1.9, -d + 0.05})};
  return meshes;
}

/// One EKMC1604111 at the paper's mounting: 17 facets of four zones of five rays (corners and centre).
inline void add_meeting_room_sensor(RayBundle& bundle, double x) {
  struct Facet {
    double x, y;
    float range;
  };
  std::vector<Facet> facets;
  const auto both_sides = [&](double at_x, double y, float range) {
    facets.push_back({at_x, y, range});
    facets.push_back({-at_x, y, range});
  };
  facets.push_back({0.0, -0.3545, 12.0F});
  for (const double at_x : {1.6225, 3.635, 6.512}) both_sides(at_x, -0.3545, 12.0F);
  both_sides(0.791, -1.630, 6.0F);
  both_sides(2.500, -1.725, 6.0F);
  both_sides(5.362, -2.332, 6.0F);
  both_sides(1.201, -4.502, 3.0F);
  both_sides(3.907, -4.829, 3.0F);

  const Vec3 eye(x, 2.65, -0.02);
  const Quat down = glm::angleAxis(-20.0 * std::numbers::pi / 180.0, Vec3(1, 0, 0));
  for (const Facet& facet : facets) {
    const double reach = glm::length(Vec3(facet.x, facet.y, 5.0));
    for (const auto& [side, up] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
      for (const auto& [right, above] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {0, 0}}) {
        const Vec3 local(facet.x + reach * (0.0707 * side + 0.0424 * right),
                         facet.y + reach * (0.0707 * up + 0.0424 * above), -5.0);
        bundle.rays.push_back(ray_through(eye, eye + down * local));
        bundle.range.push_back(facet.range);
      }
      close_zone(bundle);
    }
    close_cluster(bundle);
  }
  close_sensor(bundle);
}

inline RayBundle meeting_room_sensors() {
  RayBundle bundle;
  for (const double x : {1.010, 1.836, 2.663, 3.490, 4.316}) add_meeting_room_sensor(bundle, x);
  return bundle;
}

/// Thirteen solids of a person who stands at (x, z), facing -Z turned by `heading`, in the middle of a step.
inline std::vector<PosedShape> standing_person(double x, double z, double heading, double stride = 0.2) {
  const Frame world_from_person{rotation_from_heading(heading), {x, 0, z}};
  std::vector<PosedShape> solids;
  const auto limb = [&](Vec3 from, Vec3 to, double radius) {
    solids.push_back(PosedCapsule{Vec3f(world_from_person * from), Vec3f(world_from_person * to), float(radius)});
  };
  const auto box = [&](const Vec3& at, const Vec3& half_extents) {
    solids.push_back(place(Box{half_extents}, world_from_person * Frame{Quat(1, 0, 0, 0), at}));
  };
  limb({-0.1, 0.97, 0}, {0.1, 0.97, 0}, 0.11);
  box({0, 1.27, 0}, {0.19, 0.25, 0.11});
  solids.push_back(PosedSphere{Vec3f(world_from_person * Vec3(0, 1.72, 0)), 0.12F});
  for (const double side : {-1.0, 1.0}) {
    const double swing = side * stride;
    limb({side * 0.25, 1.47, 0}, {side * 0.27, 1.14, swing * 0.5}, 0.05);
    limb({side * 0.27, 1.14, swing * 0.5}, {side * 0.26, 0.88, swing - 0.08}, 0.045);
    limb({side * 0.1, 0.95, 0}, {side * 0.1, 0.51, -swing}, 0.075);
    limb({side * 0.1, 0.51, -swing}, {side * 0.1, 0.1, -swing * 0.9}, 0.055);
    box({side * 0.1, 0.04, -swing * 0.9 - 0.07}, {0.05, 0.04, 0.14});
  }
  return solids;
}

}  // namespace pirsim::testing
