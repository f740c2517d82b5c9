#include "pirsim/sim/analog_model.hpp"

#include <algorithm>
#include <map>

#include "pirsim/pir/target_pass.hpp"

namespace pirsim::sim {
namespace {

constexpr double m2_per_mm2 = 1e-6;
constexpr double settling_s = 5.0;  // many of the filter's time constants after the last change

std::vector<double> rated_target(const SensorModelSpec& model, int lens_step, double aperture_m2, double tick_s) {
  const std::size_t facet = pir::reference_facet(model, lens_step);
  pir::TargetPass pass;
  pass.distance_m = model.clusters[facet].range_m;
  return pir::target_power(model, facet, pass, aperture_m2, tick_s);
}

DetectorSpec without_noise(DetectorSpec spec) {
  spec.amplifier.noise_v_pp = 0.0;
  return spec;
}

/// How far a course of power drives the signal to the comparator's thresholds, in units of them: 1 is just detected.
double excursion(const DetectorSpec& spec, double volts_per_watt, double tick_s, const std::vector<double>& power_w) {
  const pir::AnalogFilter filter(without_noise(spec), volts_per_watt, tick_s);
  pir::AnalogFilter::Sections sections = filter.at_rest(power_w.front());
  double farthest = 0.0, before_w = power_w.front();
  const auto advance = [&](double now_w) {
    filter.advance(sections, before_w, now_w, 0.0);
    before_w = now_w;
    const double volts = filter.output(sections);
    farthest = std::max({farthest, volts / spec.comparator.positive_v, -volts / spec.comparator.negative_v});
  };
  for (const double now_w : power_w) advance(now_w);
  for (double after_s = 0.0; after_s < settling_s; after_s += tick_s) advance(power_w.back());
  return farthest;
}

}  // namespace

CalibratedSensor calibrate(const SensorModelSpec& model, double tick_s) {
  const int first_step = std::ranges::min_element(model.clusters, {}, &ClusterSpec::lens_step)->lens_step;
  std::map<int, double> apertures{{first_step, model.optics.aperture_mm2 * m2_per_mm2}};
  const auto first_target = rated_target(model, first_step, apertures[first_step], tick_s);
  const double volts_per_watt =
      model.detector.amplifier.volts_per_watt.value_or(1.0 / excursion(model.detector, 1.0, tick_s, first_target));
  CalibratedSensor sensor{
      {model.detector, volts_per_watt, tick_s}, {without_noise(model.detector), volts_per_watt, tick_s}, {}};
  for (const ClusterSpec& cluster : model.clusters) {
    const auto [aperture, is_new] = apertures.try_emplace(cluster.lens_step, 0.0);
    // Twice the aperture, twice the signal.
    if (is_new) {
      const auto target = rated_target(model, cluster.lens_step, 1.0, tick_s);
      aperture->second = 1.0 / excursion(model.detector, volts_per_watt, tick_s, target);
    }
    sensor.apertures_m2.push_back(aperture->second);
  }
  return sensor;
}

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
    if (found == known.end()) found = known.emplace(model.id, calibrate(model, 1.0 / sensing.tick_rate_hz)).first;
    sensors_.back() = found->second;
    apertures_m2.back() = found->second.apertures_m2;
  }
  power_ = std::make_unique<PowerModel>(scene, sensing, room, apertures_m2);
}

}  // namespace pirsim::sim
