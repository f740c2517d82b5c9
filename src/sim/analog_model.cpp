#include "sim/analog_model.hpp"

#include <algorithm>
#include <map>

#include "body/body_part.hpp"
#include "pir/calibration.hpp"
#include "pir/planck.hpp"
#include "pirsim/response.hpp"

namespace pirsim::sim {

PowerModel::PowerModel(const SceneSpec& scene, const SensingSpec& sensing, const rt::Room& room,
                       std::span<const std::vector<double>> apertures_m2)
    : rays_(std::make_unique<pir::PowerRays>()) {
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const SensorSpec& sensor = scene.sensors[i];
    if (apertures_m2[i].empty()) {
      pir::append_blind(*rays_);
    } else {
      pir::append(*rays_, sensor, scene.sensor_models.at(sensor.model), apertures_m2[i], sensing.analog_rays_per_zone);
    }
    sensors_.resize(rays_->bundle.rays.size(), static_cast<std::uint32_t>(i));
  }
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

DetectorSpec without_noise(DetectorSpec spec) {
  spec.amplifier.noise_v_pp = 0.0;
  return spec;
}

CalibratedSensor calibrated(const SensorModelSpec& model, double tick_s) {
  pir::Calibration calibration = pir::calibrate(model);
  const double gain = calibration.volts_per_watt;
  return {{model.detector, gain, tick_s},
          {without_noise(model.detector), gain, tick_s},
          std::move(calibration.apertures_m2)};
}

}  // namespace

bool AnalogModel::is_needed(const SceneSpec& scene, const SensingSpec& sensing) {
  return std::ranges::any_of(
      scene.sensors, [&](const SensorSpec& sensor) { return response_of(scene, sensing, sensor) == Response::analog; });
}

AnalogModel::AnalogModel(const SceneSpec& scene, const SensingSpec& sensing, const rt::Room& room) {
  std::map<std::string, CalibratedSensor> known;
  std::vector<std::vector<double>> apertures_m2;
  for (const SensorSpec& sensor : scene.sensors) {
    sensors_.emplace_back();
    apertures_m2.emplace_back();
    if (response_of(scene, sensing, sensor) != Response::analog) continue;
    const SensorModelSpec& model = scene.sensor_models.at(sensor.model);
    auto found = known.find(model.id);
    if (found == known.end()) found = known.emplace(model.id, calibrated(model, 1.0 / sensing.tick_rate_hz)).first;
    sensors_.back() = found->second;
    apertures_m2.back() = found->second.apertures_m2;
  }
  power_ = std::make_unique<PowerModel>(scene, sensing, room, apertures_m2);
}

}  // namespace pirsim::sim
