// Random rooms, people and sensors, and the slowest tracer of all to compare the others with.
#pragma once

#include <array>
#include <vector>

#include "pirsim/geometry.hpp"
#include "pirsim/rays.hpp"
#include "support/random_shapes.hpp"

namespace pirsim::testing {

/// The twelve triangles of a box, given as its lower and upper corner.
inline TriMesh box_mesh(const Vec3& low, const Vec3& high) {
  TriMesh mesh{"box", {}, {}};
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

struct RandomScene {
  std::vector<TriMesh> room;
  std::vector<PosedShape> solids;
  RayBundle bundle;  ///< rated
};

inline void close_zone(RayBundle& bundle) {
  bundle.zone_rays_begin.push_back(static_cast<std::uint32_t>(bundle.rays.size()));
}
inline void close_cluster(RayBundle& bundle) {
  bundle.cluster_zones_begin.push_back(static_cast<std::uint32_t>(bundle.n_zones()));
}
inline void close_sensor(RayBundle& bundle) {
  bundle.sensor_clusters_begin.push_back(static_cast<std::uint32_t>(bundle.n_clusters()));
}

/// A sensor like a real one: clusters of four zones of five rays, 3, 6 or 12 m far. Half of the clusters are aimed at
/// a solid's surroundings, so that many rays graze.
inline void add_sensor(RayBundle& bundle, Draw& draw, const std::vector<PosedShape>& solids, int n_clusters) {
  const Vec3 eye = draw.inside({-2.5, 1.5, -2.5}, {2.5, 2.7, 2.5});
  constexpr std::array<float, 3> ranges{3.0F, 6.0F, 12.0F};
  for (int cluster = 0; cluster < n_clusters; ++cluster) {
    Vec3 aim = eye + draw.direction();
    if (!solids.empty() && draw.index(2) == 0) {
      const Bounds around = bounds(solids[draw.index(static_cast<std::uint32_t>(solids.size()))]);
      aim = draw.inside(Vec3(around.lower), Vec3(around.upper));
    }
    const Vec3 middle = glm::normalize(aim - eye);
    for (int zone = 0; zone < 4; ++zone) {
      const Vec3 zone_middle = glm::normalize(middle + 0.07 * draw.direction());
      for (int ray = 0; ray < 5; ++ray) {
        bundle.rays.push_back(ray_through(eye, eye + zone_middle + 0.03 * draw.direction()));
        bundle.range.push_back(ranges[static_cast<std::size_t>(cluster) % 3]);
      }
      close_zone(bundle);
    }
    close_cluster(bundle);
  }
  close_sensor(bundle);
}

inline RandomScene random_scene(Draw& draw) {
  RandomScene scene;
  scene.room.push_back(box_mesh({-3, 0, -3}, {3, 2.8, 3}));
  const std::uint32_t n_boxes = draw.index(4);
  for (std::uint32_t i = 0; i < n_boxes; ++i) {
    const Vec3 low = draw.inside({-2.5, 0, -2.5}, {2, 1.5, 2});
    scene.room.push_back(box_mesh(low, low + draw.inside({0.1, 0.02, 0.1}, {1.5, 1, 1.5})));
  }
  TriMesh loose{"loose triangles", {}, {}};
  const std::uint32_t n_loose = draw.index(6);
  for (std::uint32_t i = 0; i < n_loose; ++i) {
    const Vec3 middle = draw.inside({-2.5, 0, -2.5}, {2.5, 2.5, 2.5});
    for (int corner = 0; corner < 3; ++corner) loose.positions.push_back(middle + 0.5 * draw.direction());
    loose.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  scene.room.push_back(loose);

  const std::uint32_t n_solids = draw.index(16);
  const Vec3 person = draw.inside({-2, 0.9, -2}, {2, 1.2, 2});
  for (std::uint32_t i = 0; i < n_solids; ++i) {
    const Vec3 at = person + draw.inside({-0.5, -0.8, -0.5}, {0.5, 0.8, 0.5});
    scene.solids.push_back(place(draw.shape(), {draw.rotation(), at}));
  }
  const std::uint32_t n_sensors = 1 + draw.index(2);
  for (std::uint32_t i = 0; i < n_sensors; ++i) add_sensor(scene.bundle, draw, scene.solids, 12);
  return scene;
}

/// What one ray hits in double precision: all triangles and all solids, one after the other.
struct BruteForceHit {
  double room = 1e30;         ///< metres to the nearest triangle
  double solid = 1e30;        ///< metres to the nearest solid
  double uncertainty = 1e30;  ///< metres by which the nearest miss was one, or the nearest hit
};

/// Distance along the ray to a triangle, and how far inside (> 0) or outside (< 0) of its nearest edge, metres.
struct TriangleHit {
  double distance = 0.0;
  double inside = 0.0;
};
inline std::optional<TriangleHit> intersect(const Ray& ray, const std::array<Vec3, 3>& corners) {
  const Vec3 origin(ray.origin), direction(ray.direction);
  const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double slope = glm::dot(normal, direction);
  if (slope == 0.0) return std::nullopt;
  const double distance = glm::dot(normal, corners[0] - origin) / slope;
  const Vec3 point = origin + distance * direction;
  double inside = 1e30;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 edge = corners[(i + 1) % 3] - corners[i];
    const Vec3 inward = glm::normalize(glm::cross(normal, edge));
    inside = std::min(inside, glm::dot(point - corners[i], inward));
  }
  return TriangleHit{distance, inside};
}

inline std::array<Vec3, 3> corners_of(const TriMesh& mesh, std::size_t triangle) {
  // As the tracers have them: rounded to single precision.
  const auto corner = [&](std::size_t i) { return Vec3(Vec3f(mesh.positions[mesh.triangles[triangle][i]])); };
  return {corner(0), corner(1), corner(2)};
}

/// Whether the ray hits a solid strictly before the room and its range; `uncertainty` is the least distance by which
/// that could have been otherwise: a triangle's edge, a solid's silhouette, the range or a tie.
inline bool sees_solid(const RandomScene& scene, std::size_t ray_index, double& uncertainty) {
  const Ray& ray = scene.bundle.rays[ray_index];
  const double range = scene.bundle.range[ray_index];
  double room = range;
  uncertainty = 1e30;
  for (const TriMesh& mesh : scene.room) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto hit = intersect(ray, corners_of(mesh, i));
      if (!hit || hit->distance < -1e-5) continue;
      uncertainty = std::min(uncertainty, std::abs(hit->inside));
      if (hit->inside >= 0 && hit->distance >= 0) room = std::min(room, hit->distance);
    }
  }
  bool is_seen = false;
  for (const PosedShape& solid : scene.solids) {
    const SearchedHit hit = search(ray, solid, range);
    uncertainty = std::min(uncertainty, std::abs(hit.depth));
    if (hit.depth > 0) continue;
    uncertainty = std::min(uncertainty, std::abs(hit.entry - room));
    is_seen |= hit.entry < room;
  }
  return is_seen;
}

}  // namespace pirsim::testing
