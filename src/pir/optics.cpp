#include "pirsim/pir/optics.hpp"

#include <algorithm>

namespace pirsim::pir {
namespace {

Vec3 direction_through(const SensorModelSpec& model, const Vec2& point) {
  return glm::normalize(Vec3(point.x, point.y, -model.plane_m));
}

/// (u, v) in [0, 1]^2 to the zone, corners included.
Vec2 bilinear(const std::array<Vec2, 4>& corners, double u, double v) {
  const Vec2 lower = corners[0] * (1.0 - u) + corners[1] * u;
  const Vec2 upper = corners[3] * (1.0 - u) + corners[2] * u;
  return lower * (1.0 - v) + upper * v;
}

Vec2 centre_of(const std::array<Vec2, 4>& corners) {
  return (corners[0] + corners[1] + corners[2] + corners[3]) * 0.25;
}

std::vector<Vec2> zone_points(const ZoneSpec& zone, RaysPerZone rays) {
  std::vector<Vec2> points;
  if (rays == RaysPerZone::one) return {centre_of(zone.corners)};
  if (rays == RaysPerZone::five) {
    points.assign(zone.corners.begin(), zone.corners.end());
    points.push_back(centre_of(zone.corners));
    return points;
  }
  const int side = rays == RaysPerZone::nine ? 3 : 4;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      points.push_back(bilinear(zone.corners, column / (side - 1.0), row / (side - 1.0)));
    }
  }
  return points;
}

}  // namespace

std::vector<Vec3> zone_directions(const SensorModelSpec& model, const ZoneSpec& zone, RaysPerZone rays) {
  std::vector<Vec3> directions;
  for (const Vec2& point : zone_points(zone, rays)) directions.push_back(direction_through(model, point));
  return directions;
}

void append(RayBundle& bundle, const SensorSpec& sensor, const SensorModelSpec& model, RaysPerZone rays) {
  const Frame& frame = sensor.world_from_sensor;
  for (const ClusterSpec& cluster : model.clusters) {
    for (const ZoneSpec& zone : cluster.zones) {
      for (const Vec3& direction : zone_directions(model, zone, rays)) {
        bundle.rays.push_back({Vec3f(frame.origin), Vec3f(glm::normalize(frame.rotation * direction))});
        bundle.range.push_back(static_cast<float>(cluster.range_m));
      }
      bundle.zone_rays_begin.push_back(static_cast<std::uint32_t>(bundle.rays.size()));
    }
    bundle.cluster_zones_begin.push_back(static_cast<std::uint32_t>(bundle.n_zones()));
  }
  bundle.sensor_clusters_begin.push_back(static_cast<std::uint32_t>(bundle.n_clusters()));
}

}  // namespace pirsim::pir
