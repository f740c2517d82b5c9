#include "sim/analog_model.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <utility>

#include "body/body_part.hpp"
#include "pir/calibration.hpp"
#include "pir/planck.hpp"
#include "pirsim/response.hpp"
#include "schema/fields.hpp"

namespace pirsim::sim {

namespace {

/// Of all facets, each once, in ascending order.
std::vector<int> lens_steps(const SensorModelSpec& model) {
  std::set<int> steps;
  for (const ClusterSpec& cluster : model.clusters) steps.insert(cluster.lens_step);
  return {steps.begin(), steps.end()};
}

}  // namespace

const PowerModel::Lens& PowerModel::lens(const SensorModelSpec& model, const SensingInForce& sensing,
                                         const PowerModel* like) {
  std::shared_ptr<const Lens>& known = lenses_[model.id];
  if (known) return *known;
  Lens lens{model, sensing.analog_rays_per_zone, {}};
  // Two blurs in a row are one of their root sum of squares.
  lens.model.optics.blur_deg = glm::length(Vec2(model.optics.blur_deg, sensing.soft_edges.sigma_deg));
  if (like != nullptr) {
    const auto other = like->lenses_.find(model.id);
    if (other != like->lenses_.end() && other->second->rays_per_zone == lens.rays_per_zone &&
        same(other->second->model, lens.model)) {
      return *(known = other->second);
    }
  }
  lens.quadrature = pir::lens_quadrature(lens.model, lens.rays_per_zone);
  return *(known = std::make_shared<const Lens>(std::move(lens)));
}

PowerModel::PowerModel(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room,
                       const PowerModel* like)
    : rays_(std::make_unique<pir::PowerRays>()) {
  const RayBundle& bundle = rays_->bundle;
  for (const SensorSpec& sensor : scene.sensors) {
    if (response_of(scene, sensing, sensor) != Response::analog) {
      pir::append_blind(*rays_);
      receivers_begin_.push_back(receivers_begin_.back());
      continue;
    }
    const SensorModelSpec& model = scene.sensor_models.at(sensor.model);
    const std::size_t first_cluster = bundle.n_clusters();
    pir::append(*rays_, sensor, model, lens(model, sensing, like).quadrature);
    const std::vector<int> steps = lens_steps(model);
    for (std::size_t c = 0; c < model.clusters.size(); ++c) {
      const auto step = std::ranges::lower_bound(steps, model.clusters[c].lens_step) - steps.begin();
      const std::size_t end = bundle.zone_rays_begin[bundle.cluster_zones_begin[first_cluster + c + 1]];
      receivers_.resize(end, receivers_begin_.back() + static_cast<std::uint32_t>(step));
    }
    receivers_begin_.push_back(receivers_begin_.back() + static_cast<std::uint32_t>(steps.size()));
  }
  for (const BlindFieldSpec& field : sensing.blind_fields) pir::blind(rays_->bundle, scene, field);
  clipped_ = std::make_unique<RayBundle>(rays_->bundle);
  const double ambient = pir::band_radiance(pir::kelvin(sensing.ambient_c));
  std::vector<double> mesh_radiances;
  for (const TriMesh& mesh : scene.meshes) {
    mesh_radiances.push_back(mesh.temperature_c ? pir::band_radiance(pir::kelvin(*mesh.temperature_c)) : ambient);
  }
  for (std::size_t i = 0; i < clipped_->rays.size(); ++i) {
    const auto hit = room.first_hit(clipped_->rays[i], clipped_->range[i]);
    if (hit) clipped_->range[i] = hit->distance;
    backgrounds_.push_back(hit ? mesh_radiances[hit->mesh] : ambient);
  }
}

BodyRadiance radiance_of(const WarmthSpec& warmth, double ambient_c) {
  const auto temperatures_c = body::surface_temperatures_c(warmth, ambient_c);
  BodyRadiance radiance{};
  for (std::size_t i = 0; i < radiance.size(); ++i) radiance[i] = pir::band_radiance(pir::kelvin(temperatures_c[i]));
  return radiance;
}

namespace {

CalibratedSensor calibrated(const SensorModelSpec& model, double tick_s) {
  const pir::Calibration calibration = pir::calibrate(model);
  const double gain = calibration.volts_per_watt;
  CalibratedSensor sensor{
      model, tick_s, 1.0, {model.detector, gain, tick_s}, {pir::without_noise(model.detector), gain, tick_s}, {}, {}};
  for (const auto& [step, aperture_m2] : calibration.apertures_m2)
    sensor.rated_watts_per_step.push_back(aperture_m2 / pir::aperture_m2(model.optics) * watts_per_step);
  return sensor;
}

using Sensors = std::vector<std::shared_ptr<const CalibratedSensor>>;

/// As one of these, or as a sensor of the other model, if there is one of the make.
std::shared_ptr<const CalibratedSensor> with_gain(const SensorModelSpec& model, double tick_s, double gain,
                                                  const Sensors& own, const AnalogModel* like) {
  std::shared_ptr<const CalibratedSensor> of_make;
  const auto look_in = [&](const Sensors& sensors) {
    for (const auto& known : sensors) {
      if (known == nullptr || known->tick_s != tick_s || !same(known->model, model)) continue;
      if (of_make == nullptr || known->gain == gain) of_make = known;
      if (known->gain == gain) return;
    }
  };
  if (like != nullptr) look_in(like->sensors());
  if (of_make == nullptr || of_make->gain != gain) look_in(own);
  if (of_make != nullptr && of_make->gain == gain) return of_make;
  CalibratedSensor sensor = of_make != nullptr ? *of_make : calibrated(model, tick_s);
  sensor.gain = gain;
  sensor.watts_per_step.clear();
  for (const double watts : sensor.rated_watts_per_step) sensor.watts_per_step.push_back(watts * gain);
  return std::make_shared<const CalibratedSensor>(std::move(sensor));
}

}  // namespace

bool AnalogModel::is_needed(const SceneSpec& scene, const SensingSpec& sensing) {
  return std::ranges::any_of(
      scene.sensors, [&](const SensorSpec& sensor) { return response_of(scene, sensing, sensor) == Response::analog; });
}

AnalogModel::AnalogModel(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room,
                         const AnalogModel* like) {
  for (const SensorSpec& sensor : scene.sensors) {
    const bool is_analog = response_of(scene, sensing, sensor) == Response::analog;
    const SensorModelSpec& model = scene.sensor_models.at(sensor.model);
    sensors_.push_back(is_analog ? with_gain(model, 1.0 / sensing.tick_rate_hz, sensor.gain, sensors_, like) : nullptr);
  }
  power_ = std::make_unique<PowerModel>(scene, sensing, room, like != nullptr ? &like->power() : nullptr);
}

}  // namespace pirsim::sim
