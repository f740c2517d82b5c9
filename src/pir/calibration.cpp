#include "pir/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "pir/analog_circuit.hpp"
#include "pir/optics.hpp"
#include "pir/planck.hpp"
#include "pirsim/error.hpp"

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

namespace {

constexpr double tick_s = 0.01;     // straight lines over it are good to 1e-3 at 2.4 Hz
constexpr double settling_s = 5.0;  // many of the filter's time constants after the last change

/// Of the rated target at the rated distance, for each square metre of aperture and volt per watt.
double rated_excursion(const SensorModelSpec& model, int lens_step) {
  const std::size_t facet = reference_facet(model, lens_step);
  const TargetPass pass{.distance_m = model.clusters[facet].range_m};
  const double result = excursion(model.detector, 1.0, target_power(model, facet, pass, 1.0, tick_s), tick_s);
  if (!(result > 0.0)) {
    throw Error(ErrorCode::input, model.id + ": the rated target brings no signal at " +
                                      std::to_string(pass.distance_m) + " m, so that there is nothing to calibrate by");
  }
  return result;
}

}  // namespace

double excursion(const DetectorSpec& spec, double volts_per_watt, std::span<const double> power_w, double tick) {
  DetectorSpec silent = spec;
  silent.amplifier.noise_v_pp = 0.0;
  const AnalogFilter filter(silent, volts_per_watt, tick);
  double before_w = power_w.front(), farthest = 0.0;
  AnalogFilter::Sections sections = filter.at_rest(before_w);
  const auto advance = [&](double now_w) {
    filter.advance(sections, before_w, now_w, 0.0);
    before_w = now_w;
    const double volts = filter.output(sections);
    farthest = std::max({farthest, volts / spec.comparator.positive_v, -volts / spec.comparator.negative_v});
  };
  for (const double now_w : power_w) advance(now_w);
  for (double after_s = 0.0; after_s < settling_s; after_s += tick) advance(power_w.back());
  return farthest;
}

Calibration calibrate(const SensorModelSpec& model) {
  const int first_step = std::ranges::min_element(model.clusters, {}, &ClusterSpec::lens_step)->lens_step;
  const double first_aperture_m2 = aperture_m2(model.optics);
  const double first_excursion = rated_excursion(model, first_step);
  const double gain = model.detector.amplifier.volts_per_watt.value_or(1.0 / (first_excursion * first_aperture_m2));
  std::map<int, double> apertures{{first_step, first_aperture_m2}};
  Calibration calibration{gain, {}};
  for (const ClusterSpec& cluster : model.clusters) {
    const auto [aperture, is_new] = apertures.try_emplace(cluster.lens_step, 0.0);
    // Twice the aperture, twice the signal.
    if (is_new) aperture->second = 1.0 / (rated_excursion(model, cluster.lens_step) * gain);
    calibration.apertures_m2.push_back(aperture->second);
  }
  return calibration;
}

double excursion(const SensorModelSpec& model, const Calibration& calibration, std::size_t cluster,
                 const TargetPass& pass) {
  const std::vector<double> power_w = target_power(model, cluster, pass, calibration.apertures_m2[cluster], tick_s);
  return excursion(model.detector, calibration.volts_per_watt, power_w, tick_s);
}

double detection_range(const SensorModelSpec& model, const Calibration& calibration, std::size_t cluster,
                       TargetPass pass) {
  const PassedFacet facet(model, cluster);
  const auto detected_at = [&](double distance_m) {
    pass.distance_m = distance_m;
    const std::vector<double> power_w = facet.power(pass, calibration.apertures_m2[cluster], tick_s);
    return excursion(model.detector, calibration.volts_per_watt, power_w, tick_s) >= 1.0;
  };
  // From far to near: near by, zones are filled and their humps pass fast, so that a target may go unnoticed there.
  constexpr double nearest_m = 0.1, farthest_m = 100.0, stride = 1.05, precision = 1e-3;
  double far_m = farthest_m, near_m = farthest_m;
  while (!detected_at(near_m)) {
    far_m = near_m;
    near_m /= stride;
    if (near_m < nearest_m) return 0.0;
  }
  while (far_m - near_m > precision * near_m) {
    const double middle_m = 0.5 * (near_m + far_m);
    (detected_at(middle_m) ? near_m : far_m) = middle_m;
  }
  return near_m;
}

}  // namespace pirsim::pir
