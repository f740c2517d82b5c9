#include "pir/target_pass.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "pir/planck.hpp"
#include "pir/zone_quadrature.hpp"

namespace pirsim::pir {

PassedFacet::PassedFacet(const SensorModelSpec& model, std::size_t cluster, int rays_per_zone) {
  const ClusterSpec& facet = model.clusters[cluster];
  const Vec3 axis = glm::normalize(Vec3(facet.centre.x, facet.centre.y, -model.plane_m));
  const Vec3 right = glm::normalize(glm::cross(axis, Vec3(0, 1, 0)));
  const Vec3 up = glm::cross(right, axis);
  for (const ZoneSpec& zone : facet.zones) {
    for (const WeightedDirection& ray : zone_quadrature(model, zone, rays_per_zone)) {
      const Vec3 point = ray.direction / glm::dot(ray.direction, axis);
      spots_.push_back({{glm::dot(point, right), glm::dot(point, up)}, zone.polarity * ray.solid_angle_sr});
    }
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(rays_per_zone); ++i) {
    middle_tangent_ += spots_[i].tangent.y / rays_per_zone;
  }
  std::ranges::stable_sort(spots_, {}, [](const Spot& spot) { return spot.tangent.x; });
}

std::vector<double> PassedFacet::power(const TargetPass& pass, double aperture_m2, double tick_s) const {
  std::vector<double> x_m;
  std::vector<double> weight_before_sr{0.0};  // of the spots further left
  for (const Spot& spot : spots_) {
    if (std::abs(spot.tangent.y - middle_tangent_) * pass.distance_m > 0.5 * pass.height_m) continue;
    x_m.push_back(spot.tangent.x * pass.distance_m);
    weight_before_sr.push_back(weight_before_sr.back() + spot.weight_sr);
  }
  std::vector<double> power{0.0};
  if (x_m.empty()) return power;
  const double contrast = band_radiance(kelvin(pass.background_c) + pass.temperature_difference_k) -
                          band_radiance(kelvin(pass.background_c));
  const double half_width = 0.5 * pass.width_m, step_m = pass.speed_m_s * tick_s;
  const double first = x_m.front() - half_width - step_m, last = x_m.back() + half_width + step_m;
  std::size_t left = 0, right = 0;  // the spots [left, right) are covered
  for (int tick = 0; first + tick * step_m <= last; ++tick) {
    const double middle = first + tick * step_m;
    while (right < x_m.size() && x_m[right] <= middle + half_width) ++right;
    while (left < right && x_m[left] < middle - half_width) ++left;
    const double covered_sr = left == right ? 0.0 : weight_before_sr[right] - weight_before_sr[left];
    power.push_back(aperture_m2 * contrast * covered_sr);
  }
  return power;
}

std::vector<double> target_power(const SensorModelSpec& model, std::size_t cluster, const TargetPass& pass,
                                 double aperture_m2, double tick_s, int rays_per_zone) {
  return PassedFacet(model, cluster, rays_per_zone).power(pass, aperture_m2, tick_s);
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
