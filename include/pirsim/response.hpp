// Which response the sensors of a study give, and which of their numbers mean nothing to it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// The response in force: the study's word, or else the sensor model's own.
[[nodiscard]] Response response_of(const SceneSpec& scene, const SensingSpec& sensing, const SensorSpec& sensor);

/// How sensitive this unit is, relative to what its make's rated distances tell (SensitivitySpec). seed: of the study.
[[nodiscard]] double unit_sensitivity(const SceneSpec& scene, Units units, std::uint64_t seed, std::uint32_t sensor);

/// For a reader, with the models of sensors that give it, and the units if they aren't the usual ones: "zones
/// (HC-SR501) and analog (EKMC1604111, guaranteed units)".
[[nodiscard]] std::string responses_in_words(const SceneSpec& scene, const SensingSpec& sensing);

/// A warning for each sensor model that hard zones leave numbers of unused: those that differ from the defaults, which
/// stand for the EKMC family.
[[nodiscard]] std::vector<Issue> idle_sensor_keys(const SceneSpec& scene, const SensingSpec& sensing);

}  // namespace pirsim
