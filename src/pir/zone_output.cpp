#include "pir/zone_output.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "pirsim/sensor_keys.hpp"

namespace pirsim {
namespace pir {

std::optional<Comparator> zone_output(const ComparatorSpec& spec, double tick_s) {
  if (spec.pulse_count == 1 && spec.hold_s == 0.0 && spec.blind_s == 0.0) return std::nullopt;
  ComparatorSpec unsigned_pulses = spec;
  unsigned_pulses.pulse_signs = PulseSigns::any;
  return Comparator(unsigned_pulses, tick_s);
}

}  // namespace pir

namespace {

/// "low_hz, high_hz": what differs from the default and only the analog response asks for.
std::string analog_keys(const SensorModelSpec& model) {
  std::string keys;
  const auto add = [&](const char* key, const auto& value, const auto& usual) {
    if (value == usual) return;
    keys += keys.empty() ? "" : ", ";
    keys += key;
  };
  const OpticsSpec usual_optics;
  add("blur_deg", model.optics.blur_deg, usual_optics.blur_deg);
  add("aperture_mm2", model.optics.aperture_mm2, usual_optics.aperture_mm2);
  const auto& [element, amplifier, comparator] = model.detector;
  const DetectorSpec usual;
  add("thermal_s", element.thermal_s, usual.element.thermal_s);
  add("electrical_s", element.electrical_s, usual.element.electrical_s);
  add("low_hz", amplifier.low_hz, usual.amplifier.low_hz);
  add("high_hz", amplifier.high_hz, usual.amplifier.high_hz);
  add("order", amplifier.order, usual.amplifier.order);
  add("volts_per_watt", amplifier.volts_per_watt, usual.amplifier.volts_per_watt);
  add("noise_v_pp", amplifier.noise_v_pp, usual.amplifier.noise_v_pp);
  add("offset_v", amplifier.offset_v, usual.amplifier.offset_v);
  add("lowest_v", amplifier.lowest_v, usual.amplifier.lowest_v);
  add("highest_v", amplifier.highest_v, usual.amplifier.highest_v);
  add("positive_v", comparator.positive_v, usual.comparator.positive_v);
  add("negative_v", comparator.negative_v, usual.comparator.negative_v);
  add("pulse_signs", comparator.pulse_signs, usual.comparator.pulse_signs);
  return keys;
}

/// Where the model was read from: a sensor's file is named after it.
Where file_of(const std::string& model, const SceneSpec& scene) {
  const auto file = std::ranges::find_if(scene.files, [&](const InputFile& read) {
    return std::filesystem::path(read.path).filename() == model + ".yaml";
  });
  return file == scene.files.end() ? Where{} : Where{file->path, 0, 0};
}

}  // namespace

std::vector<Issue> idle_sensor_keys(const SceneSpec& scene, const SensingSpec& sensing) {
  Diagnostics remarks;
  std::set<std::string> told;
  for (const SensorSpec& sensor : scene.sensors) {
    const SensorModelSpec& model = scene.sensor_models.at(sensor.model);
    if (sensing.response.value_or(model.response) != Response::zones || !told.insert(sensor.model).second) continue;
    const std::string keys = analog_keys(model);
    if (keys.empty()) continue;
    remarks.warning(file_of(sensor.model, scene),
                    sensor.model + ": response: zones makes no use of " + keys + "; response: analog does");
  }
  return remarks.issues();
}

}  // namespace pirsim
