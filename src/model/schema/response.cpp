#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <set>
#include <string_view>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "model/core/text.hpp"
#include "model/schema/fields.hpp"
#include "pirsim/random.hpp"
#include "pirsim/response.hpp"

namespace pirsim {

Response response_of(const SceneSpec& scene, const SensingSpec& sensing, const SensorSpec& sensor) {
  const Response own = scene.sensor_models.at(sensor.model).response;
  return own == Response::beam ? own : sensing.response.value_or(own);
}

double unit_sensitivity(const SceneSpec& scene, Units units, std::uint64_t seed, std::uint32_t sensor) {
  const SensitivitySpec& make = scene.sensor_models.at(scene.sensors[sensor].model).sensitivity;
  constexpr double low_tenth = -1.2816;  // of a standard normal
  switch (units) {
    case Units::guaranteed:
      return 1.0;
    case Units::typical:
      return make.median;
    case Units::low:
      return make.median * std::exp(low_tenth * glm::length(glm::dvec2(make.installation_sd, make.sd)));
    case Units::drawn:
      break;
  }
  Stream room({seed, 0, 0, Purpose::installation}), unit({seed, 0, sensor, Purpose::sensor_unit});
  return make.median * std::exp(make.installation_sd * room.normal() + make.sd * unit.normal());
}

std::string responses_in_words(const SceneSpec& scene, const SensingSpec& sensing) {
  std::map<Response, std::set<std::string>> models;
  for (const SensorSpec& sensor : scene.sensors) models[response_of(scene, sensing, sensor)].insert(sensor.model);
  std::string text;
  for (const auto& [response, names] : models) {
    const bool tells_units = response == Response::analog && sensing.units != Units::typical;
    text += (text.empty() ? "" : " and ") + std::string(word_of(response)) + " (" +
            joined(std::vector(names.begin(), names.end()), ", ") +
            (tells_units ? ", " + std::string(word_of(sensing.units)) + " units)" : ")");
  }
  return text;
}

namespace {

/// "low_hz, high_hz": what differs from the default and only the analog response asks for.
std::string analog_keys(const SensorModelSpec& model) {
  std::string keys;
  const auto add = [&]<typename Spec>(const Spec& spec, std::initializer_list<std::string_view> obeyed = {}) {
    const Spec usual{};
    each_field<Spec>([&](const auto& field) {
      if (same(spec.*field.member, usual.*field.member)) return;
      if (std::ranges::find(obeyed, field.name) == obeyed.end())
        keys += (keys.empty() ? "" : ", ") + std::string(field.name);
    });
  };
  add(model.optics);
  add(model.detector.element);
  add(model.detector.amplifier);
  add(model.detector.comparator, {"pulse_count", "pulse_window_s"});
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
    if (response_of(scene, sensing, sensor) != Response::zones || !told.insert(sensor.model).second) continue;
    const std::string keys = analog_keys(scene.sensor_models.at(sensor.model));
    if (keys.empty()) continue;
    remarks.warning(file_of(sensor.model, scene),
                    sensor.model + ": response: zones makes no use of " + keys + "; response: analog does");
  }
  return remarks.issues();
}

}  // namespace pirsim
