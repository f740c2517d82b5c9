#include "sim/analog_model.hpp"

#include <map>

#include "pir/calibration.hpp"

namespace pirsim::sim {
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

Response AnalogModel::response(const SceneSpec& scene, const SensingSpec& sensing, std::size_t sensor) {
  return sensing.response.value_or(scene.sensor_models.at(scene.sensors[sensor].model).response);
}

bool AnalogModel::is_needed(const SceneSpec& scene, const SensingSpec& sensing) {
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    if (response(scene, sensing, i) == Response::analog) return true;
  }
  return false;
}

AnalogModel::AnalogModel(const SceneSpec& scene, const SensingSpec& sensing, const rt::Room& room) {
  std::map<std::string, CalibratedSensor> known;
  std::vector<std::vector<double>> apertures_m2;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    sensors_.emplace_back();
    apertures_m2.emplace_back();
    if (response(scene, sensing, i) != Response::analog) continue;
    const SensorModelSpec& model = scene.sensor_models.at(scene.sensors[i].model);
    auto found = known.find(model.id);
    if (found == known.end()) found = known.emplace(model.id, calibrated(model, 1.0 / sensing.tick_rate_hz)).first;
    sensors_.back() = found->second;
    apertures_m2.back() = found->second.apertures_m2;
  }
  power_ = std::make_unique<PowerModel>(scene, sensing, room, apertures_m2);
}

}  // namespace pirsim::sim
