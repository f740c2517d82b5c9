#include "engine/pir/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>
#include <utility>

#include "engine/pir/optics.hpp"
#include "pirsim/error.hpp"

namespace pirsim::pir {
namespace {

constexpr double tick_s = 0.01;         // straight lines over it are good to 1e-3 at 2.4 Hz
constexpr double settling_s = 5.0;      // many of the filter's time constants after the last change
constexpr double equal = radians(0.5);  // directions in a drawing that is read to a centimetre at 3 m

Vec2 middle(const ZoneSpec& zone) {
  return 0.25 * (zone.corners[0] + zone.corners[1] + zone.corners[2] + zone.corners[3]);
}

/// Is this the step from a zone to another one in its row or column of the drawing?
bool is_along_the_drawing(const Vec2& step) {
  constexpr double askew = 0.25;  // rows are straight to within a few hundredths; what lies across has 1 or more
  const double x = std::abs(step.x), y = std::abs(step.y);
  return std::min(x, y) <= askew * std::max(x, y) && step != Vec2(0.0);
}

double off_axis(const SensorModelSpec& model, const ClusterSpec& cluster) {
  return std::atan2(glm::length(cluster.centre), model.plane_m);
}

}  // namespace

Crossing::Crossing(std::vector<Spot> spots) : spots_(std::move(spots)) {
  std::ranges::stable_sort(spots_, {}, [](const Spot& spot) { return spot.tangent.x; });
}

std::vector<double> Crossing::power(const TargetPass& pass, double aperture_m2, double tick) const {
  const RatedTargetSpec& target = pass.target;
  std::vector<double> x_m;
  std::vector<double> weight_before_sr{0.0};  // of the spots further left
  for (const Spot& spot : spots_) {
    if (std::abs(spot.tangent.y) * pass.distance_m > 0.5 * target.height_m) continue;
    x_m.push_back(spot.tangent.x * pass.distance_m);
    weight_before_sr.push_back(weight_before_sr.back() + spot.weight_sr);
  }
  std::vector<double> power{0.0};
  if (x_m.empty()) return power;
  const double contrast =
      band_radiance(kelvin(pass.background_c) + target.contrast_k) - band_radiance(kelvin(pass.background_c));
  const double half_width = 0.5 * target.width_m, step_m = target.speed_m_s * tick;
  const double first = x_m.front() - half_width - step_m, last = x_m.back() + half_width + step_m;
  std::size_t left = 0, right = 0;  // the spots [left, right) are covered
  for (int i = 0; first + i * step_m <= last; ++i) {
    const double middle = first + i * step_m;
    while (right < x_m.size() && x_m[right] <= middle + half_width) ++right;
    while (left < right && x_m[left] < middle - half_width) ++left;
    const double covered_sr = left == right ? 0.0 : weight_before_sr[right] - weight_before_sr[left];
    power.push_back(aperture_m2 * contrast * covered_sr);
  }
  return power;
}

namespace {

/// A way on the drawing, from the middle of one zone to that of its neighbour.
struct Way {
  Vec2 from{0.0}, to{0.0};
  std::size_t zones_begin = 0, zones_end = 0;  ///< that count
};

std::vector<Way> ways_through(const std::vector<ZoneSpec>& zones, int n_zones) {
  std::vector<Way> ways;
  for (std::size_t i = 0; n_zones > 1 && i < zones.size(); ++i) {
    for (std::size_t k = 0; k < zones.size(); ++k) {
      const Vec2 from = middle(zones[i]), to = middle(zones[k]);
      if (is_along_the_drawing(to - from)) ways.push_back({from, to, 0, zones.size()});
    }
  }
  if (!ways.empty()) return ways;
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const Vec2 at = middle(zones[i]);
    for (const Vec2 step : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)}) {
      ways.push_back({at - step, at + step, i, i + 1});
    }
  }
  return ways;
}

/// Leaves those that go most nearly square to the direction in which the facet lies off the lens's axis: who passes by
/// sideways keeps their distance.
void keep_sideways(std::vector<Way>& ways, const SensorModelSpec& model, const Vec2& facet) {
  const auto sideways = [&](const Way& way) {
    const Vec2 step = glm::normalize(way.to - way.from);
    return std::abs(step.x * facet.y - step.y * facet.x) / model.plane_m;
  };
  double most = 0.0;
  for (const Way& way : ways) most = std::max(most, sideways(way));
  std::erase_if(ways, [&](const Way& way) { return sideways(way) < most - equal; });
}

}  // namespace

std::vector<Crossing> crossings(const SensorModelSpec& model, std::size_t cluster, int n_zones, int rays_per_zone) {
  const ClusterSpec& facet = model.clusters[cluster];
  const std::vector<std::vector<WeightedDirection>> rays = symmetric_quadrature(model, facet.zones, rays_per_zone);
  std::vector<Way> ways = ways_through(facet.zones, n_zones);
  keep_sideways(ways, model, facet.centre);
  std::vector<Crossing> found;
  for (const Way& way : ways) {
    const Vec2 through = 0.5 * (way.from + way.to), step = way.to - way.from;
    const Vec3 axis = glm::normalize(Vec3(through.x, through.y, -model.plane_m)), along(step.x, step.y, 0.0);
    const Vec3 right = glm::normalize(along - glm::dot(along, axis) * axis), up = glm::cross(right, axis);
    std::vector<Crossing::Spot> spots;
    for (std::size_t i = way.zones_begin; i < way.zones_end; ++i) {
      for (const WeightedDirection& ray : rays[i]) {
        const Vec3 point = ray.direction / glm::dot(ray.direction, axis);
        spots.push_back({{glm::dot(point, right), glm::dot(point, up)}, facet.zones[i].polarity * ray.solid_angle_sr});
      }
    }
    found.emplace_back(std::move(spots));
  }
  return found;
}

std::vector<std::size_t> reference_facets(const SensorModelSpec& model, int lens_step) {
  double least = std::numbers::pi;
  for (const ClusterSpec& cluster : model.clusters) {
    if (cluster.lens_step == lens_step) least = std::min(least, off_axis(model, cluster));
  }
  std::vector<std::size_t> facets;
  for (std::size_t i = 0; i < model.clusters.size(); ++i) {
    const ClusterSpec& cluster = model.clusters[i];
    if (cluster.lens_step == lens_step && off_axis(model, cluster) <= least + equal) facets.push_back(i);
  }
  return facets;
}

DetectorSpec without_noise(DetectorSpec spec) {
  spec.amplifier.noise_v_pp = 0.0;
  return spec;
}

RatedStep::RatedStep(const SensorModelSpec& model, int lens_step, int rays_per_zone)
    : comparator_(model.detector.comparator), filter_(without_noise(model.detector), 1.0, tick_s) {
  rated_.target.lens_step = lens_step;
  for (const RatedTargetSpec& target : model.targets) {
    if (target.lens_step == lens_step) rated_.target = target;
  }
  for (const std::size_t facet : reference_facets(model, lens_step)) {
    rated_.distance_m = model.clusters[facet].range_m;
    std::vector<Crossing> more = crossings(model, facet, rated_.target.zones, rays_per_zone);
    std::ranges::move(more, std::back_inserter(ways_));
  }
}

double RatedStep::excursion(const TargetPass& pass) const {
  double sum = 0.0;
  for (const Crossing& way : ways_) {
    double before_w = 0.0, farthest = 0.0;
    AnalogFilter::Sections sections = filter_.at_rest(before_w);
    const auto advance = [&](double now_w) {
      filter_.advance(sections, before_w, now_w, 0.0);
      before_w = now_w;
      const double volts = filter_.output(sections);
      farthest = std::max({farthest, volts / comparator_.positive_v, -volts / comparator_.negative_v});
    };
    for (const double now_w : way.power(pass, 1.0, tick_s)) advance(now_w);
    for (double after_s = 0.0; after_s < settling_s; after_s += tick_s) advance(0.0);
    sum += farthest;
  }
  return sum / static_cast<double>(ways_.size());
}

double RatedStep::detection_range(double gain_m2_v_per_w, TargetPass pass) const {
  const auto detected_at = [&](double distance_m) {
    pass.distance_m = distance_m;
    return gain_m2_v_per_w * excursion(pass) >= 1.0;
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

Calibration calibrate(const SensorModelSpec& model) {
  std::map<int, double> excursions;  // by lens step
  for (const ClusterSpec& cluster : model.clusters) {
    const auto [excursion, is_new] = excursions.try_emplace(cluster.lens_step, 0.0);
    if (!is_new) continue;
    const RatedStep step(model, cluster.lens_step);
    excursion->second = step.excursion(step.rated());
    if (!(excursion->second > 0.0)) {
      throw Error(ErrorCode::input, model.id + ": the rated target brings no signal at " +
                                        std::to_string(step.rated().distance_m) +
                                        " m, so that there is nothing to calibrate by");
    }
  }
  const double first_m2 = aperture_m2(model.optics), first_excursion = excursions.begin()->second;
  Calibration result{model.detector.amplifier.volts_per_watt.value_or(1.0 / (first_excursion * first_m2)), {}};
  // Twice the aperture, twice the signal.
  for (const auto& [step, excursion] : excursions) {
    result.apertures_m2[step] = 1.0 / (excursion * result.volts_per_watt);
  }
  result.apertures_m2.begin()->second = first_m2;
  return result;
}

}  // namespace pirsim::pir
