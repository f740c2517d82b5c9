// What coverage studies and walk tests have in common: a scene and its sensors, with the survey's effects in force.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "effects/pipeline.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/error.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "schema/study_in_force.hpp"
#include "sim/detection.hpp"
#include "sim/sensor_array.hpp"

namespace pirsim::studies {

/// Immutable, shared by threads. Detectors are without noise: the same target at the same place gives the same.
class SurveyBase {
 public:
  /// script: sensing, seed, effects and the trials that the survey has people in. Throws Error(input) for unknown
  /// effects, sensors and meshes.
  SurveyBase(SceneSpec scene, const ScriptSpec& script);

  [[nodiscard]] const SceneSpec& scene() const noexcept { return study_.scene; }
  [[nodiscard]] const SensingInForce& sensing() const noexcept { return study_.sensing; }
  [[nodiscard]] const std::vector<TrialInForce>& trials() const noexcept { return study_.trials; }
  [[nodiscard]] std::uint64_t seed() const noexcept { return study_.seed; }
  [[nodiscard]] const sim::SensorArray& array() const noexcept { return *array_; }
  [[nodiscard]] const effects::Pipeline& stages() const noexcept { return stages_; }
  [[nodiscard]] sim::Detector make_detector() const { return sim::Detector(*array_); }
  [[nodiscard]] sim::Logger make_logger() const { return {stages_, study_.sensing, array_->n_sensors()}; }

 private:
  StudyInForce study_;
  std::unique_ptr<const sim::SensorArray> array_;
  effects::Pipeline stages_;
};

/// A warning for each of these effects that changes nothing: because of the sensors' response, or in any survey of this
/// kind.
[[nodiscard]] std::vector<Issue> idle_effects(std::span<const EffectSpec> effects, const SurveyBase& survey,
                                              effects::Survey kind);

}  // namespace pirsim::studies
