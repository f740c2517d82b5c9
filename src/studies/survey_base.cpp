#include "studies/survey_base.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "effects/catalogue.hpp"

namespace pirsim::studies {
namespace {

SceneSpec without_noise(SceneSpec scene) {
  for (auto& [id, model] : scene.sensor_models) model.detector.amplifier.noise_v_pp = 0.0;
  return scene;
}

}  // namespace

SurveyBase::SurveyBase(SceneSpec scene, const ScriptSpec& script)
    : study_(effects::in_force(without_noise(std::move(scene)), script)),
      array_(std::make_unique<const sim::SensorArray>(study_.scene, study_.sensing,
                                                      std::make_shared<const rt::Room>(study_.scene.meshes))),
      stages_(script.effects, {study_.scene, study_.sensing, array_->clipped()}) {}

std::vector<Issue> idle_effects(std::span<const EffectSpec> effects, const SurveyBase& survey, effects::Survey kind) {
  Diagnostics remarks;
  for (const Issue& issue : effects::idle(effects, survey.scene(), survey.sensing())) {
    remarks.warning(issue.where, issue.message);
  }
  for (const EffectSpec& effect : effects) {
    const std::vector<effects::Survey>& idle_in = effects::info(effect.name).idle_in;
    if (std::ranges::find(idle_in, kind) == idle_in.end()) continue;
    remarks.warning(effect.where, effect.name + " does nothing in a " + std::string(name(kind)));
  }
  return remarks.issues();
}

}  // namespace pirsim::studies
