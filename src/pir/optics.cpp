#include "pir/optics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "pirsim/geometry.hpp"

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

/// What the sensor sees of the zone, on the plane that touches the unit sphere in the zone's middle.
class TangentPlane {
 public:
  explicit TangentPlane(const Vec3& middle) : middle_(middle) {
    const Vec3 side = std::abs(middle.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    right_ = glm::normalize(glm::cross(middle, side));
    up_ = glm::cross(right_, middle);
  }
  [[nodiscard]] Vec2 project(const Vec3& direction) const {
    return Vec2(glm::dot(direction, right_), glm::dot(direction, up_)) / glm::dot(direction, middle_);
  }
  [[nodiscard]] Vec3 direction(const Vec2& p) const { return glm::normalize(middle_ + p.x * right_ + p.y * up_); }

 private:
  Vec3 middle_, right_{0.0}, up_{0.0};
};

/// An edge as the line normal . p = distance, with the middle on its inner side.
struct Edge {
  Vec2 normal{0.0};
  double distance = 0.0;
};

Vec2 meeting_point(const Edge& a, const Edge& b) {
  const double det = a.normal.x * b.normal.y - a.normal.y * b.normal.x;
  return Vec2(a.distance * b.normal.y - b.distance * a.normal.y, b.distance * a.normal.x - a.distance * b.normal.x) /
         det;
}

}  // namespace

ZoneSpec grown(const SensorModelSpec& model, const ZoneSpec& zone, double angle) {
  if (angle == 0.0) return zone;
  const TangentPlane plane(direction_through(model, centre_of(zone.corners)));
  std::array<Vec2, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = plane.project(direction_through(model, zone.corners[i]));
  std::array<Edge, 4> edges{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 along = glm::normalize(corners[(i + 1) % 4] - corners[i]);
    Vec2 normal(along.y, -along.x);
    double distance = glm::dot(normal, corners[i]);
    if (distance < 0.0) {
      normal = -normal;
      distance = -distance;
    }
    edges[i] = {normal, std::tan(std::max(0.0, std::atan(distance) + angle))};
  }
  ZoneSpec result = zone;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 d = plane.direction(meeting_point(edges[(i + 3) % 4], edges[i]));
    result.corners[i] = Vec2(d.x, d.y) * (model.plane_m / -d.z);
  }
  return result;
}

std::vector<double> edge_levels(double sigma_deg) {
  if (sigma_deg <= 0.0) return {0.0};
  // Of the standard normal distribution at 1/14, 3/14, ..., 13/14.
  constexpr std::array quantiles{0.0, -0.366106357, 0.366106357, -0.791638608, 0.791638608, -1.465233793, 1.465233793};
  std::vector<double> levels;
  for (const double quantile : quantiles) levels.push_back(quantile * radians(sigma_deg));
  return levels;
}

std::vector<Vec3> zone_directions(const SensorModelSpec& model, const ZoneSpec& zone, RaysPerZone rays) {
  std::vector<Vec3> directions;
  for (const Vec2& point : zone_points(zone, rays)) directions.push_back(direction_through(model, point));
  return directions;
}

namespace {

void append_level(RayBundle& bundle, const Frame& frame, const SensorModelSpec& model, RaysPerZone rays,
                  double growth) {
  for (const ClusterSpec& cluster : model.clusters) {
    for (const ZoneSpec& zone : cluster.zones) {
      for (const Vec3& direction : zone_directions(model, grown(model, zone, growth), rays)) {
        bundle.rays.push_back({Vec3f(frame.origin), Vec3f(glm::normalize(frame.rotation * direction))});
        bundle.range.push_back(static_cast<float>(cluster.range_m));
      }
      bundle.zone_rays_begin.push_back(static_cast<std::uint32_t>(bundle.rays.size()));
    }
    bundle.cluster_zones_begin.push_back(static_cast<std::uint32_t>(bundle.n_zones()));
  }
}

}  // namespace

void append(RayBundle& bundle, const SensorSpec& sensor, const SensorModelSpec& model, RaysPerZone rays,
            std::span<const double> levels) {
  constexpr std::array hard{0.0};
  for (const double growth : levels.empty() ? std::span<const double>(hard) : levels) {
    append_level(bundle, sensor.world_from_sensor, model, rays, growth);
  }
  bundle.sensor_clusters_begin.push_back(static_cast<std::uint32_t>(bundle.n_clusters()));
}

}  // namespace pirsim::pir
