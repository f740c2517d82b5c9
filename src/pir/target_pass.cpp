#include "pirsim/pir/target_pass.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "pirsim/pir/planck.hpp"
#include "pirsim/pir/zone_quadrature.hpp"

namespace pirsim::pir {
namespace {

/// A point of a zone on the plane in which the plate moves, and its share of the facet's sensitivity.
struct Spot {
  Vec2 point{0.0};         ///< x the way of the plate, y up; metres
  double weight_sr = 0.0;  ///< signed by the zone's polarity
};

Vec3 ahead(const SensorModelSpec& model, const Vec2& point) {
  return glm::normalize(Vec3(point.x, point.y, -model.plane_m));
}

std::vector<Spot> spots_of(const SensorModelSpec& model, const ClusterSpec& facet, double distance_m, int n) {
  const Vec3 axis = ahead(model, facet.centre);
  const Vec3 right = glm::normalize(glm::cross(axis, Vec3(0, 1, 0)));
  const Vec3 up = glm::cross(right, axis);
  std::vector<Spot> spots;
  for (const ZoneSpec& zone : facet.zones) {
    for (const WeightedDirection& ray : zone_quadrature(model, zone, n)) {
      const Vec3 point = ray.direction * (distance_m / glm::dot(ray.direction, axis));
      spots.push_back({{glm::dot(point, right), glm::dot(point, up)}, zone.polarity * ray.solid_angle_sr});
    }
  }
  return spots;
}

double mean_height(const std::vector<Spot>& spots, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += spots[i].point.y;
  return sum / static_cast<double>(n);
}

}  // namespace

std::vector<double> target_power(const SensorModelSpec& model, std::size_t cluster, const TargetPass& pass,
                                 double aperture_m2, double tick_s, int rays_per_zone) {
  std::vector<Spot> spots = spots_of(model, model.clusters[cluster], pass.distance_m, rays_per_zone);
  const double height = mean_height(spots, static_cast<std::size_t>(rays_per_zone));
  std::erase_if(spots, [&](const Spot& spot) { return std::abs(spot.point.y - height) > 0.5 * pass.height_m; });
  const double contrast = band_radiance(kelvin(pass.background_c) + pass.temperature_difference_k) -
                          band_radiance(kelvin(pass.background_c));
  const auto by_x = [](const Spot& a, const Spot& b) { return a.point.x < b.point.x; };
  std::ranges::sort(spots, by_x);
  const double half_width = 0.5 * pass.width_m, step_m = pass.speed_m_s * tick_s;
  std::vector<double> power{0.0};
  if (spots.empty()) return power;
  const double first = spots.front().point.x - half_width - step_m, last = spots.back().point.x + half_width + step_m;
  for (int tick = 0; first + tick * step_m <= last; ++tick) {
    const double middle = first + tick * step_m;
    double covered_sr = 0.0;
    for (const Spot& spot : spots) {
      if (std::abs(spot.point.x - middle) <= half_width) covered_sr += spot.weight_sr;
    }
    power.push_back(aperture_m2 * contrast * covered_sr);
  }
  return power;
}

std::size_t reference_facet(const SensorModelSpec& model, int lens_step) {
  std::size_t best = model.clusters.size();
  for (std::size_t i = 0; i < model.clusters.size(); ++i) {
    if (model.clusters[i].lens_step != lens_step) continue;
    const auto off_axis = [&](std::size_t facet) { return std::abs(model.clusters[facet].centre.x); };
    if (best == model.clusters.size() || off_axis(i) < off_axis(best)) best = i;
  }
  return best;
}

}  // namespace pirsim::pir
