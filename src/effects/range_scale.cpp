// A lens reaches further than its data sheet promises, or less far.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  for (auto& [id, model] : scene.sensor_models) {
    for (ClusterSpec& cluster : model.clusters) cluster.range_m *= effect.parameters.at("scale");
  }
}

}  // namespace

const Effect& range_scale() {
  static const Effect effect{
      .info = {.name = "range_scale",
               .family = Family::optics,
               .stage = "optics",
               .summary = "All rated detection distances are wrong by one factor.",
               .fingerprint = "only seats near the end of a range change",
               .confused_with = {"thermal_contrast", "body_size"},
               .parameters = {factor("scale", 0.5, 1.8, 0.8,
                                     "assumed: a data sheet promises a least distance, a lens ages")},
               .reach = Reach::geometry},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
