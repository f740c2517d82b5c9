// A rated distance holds at the rated contrast of temperature; signals fall with the square of the distance.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

constexpr double rated_k =
    4.0;  // data sheet of the EKMC series: detection distance at 4 K between target and background

void alter(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const double factor = std::sqrt(effect.parameters.at("delta_t_k") / rated_k);
  for (auto& [id, model] : scene.sensor_models) {
    for (ClusterSpec& cluster : model.clusters) cluster.range_m *= factor;
  }
}

}  // namespace

const Effect& thermal_contrast() {
  static const Effect effect{
      .info = {.name = "thermal_contrast",
               .family = Family::optics,
               .stage = "optics",
               .summary = "People stand out from the background by another temperature than the rated 4 K.",
               .fingerprint = "far zones fall silent or reach further, by the square root of the contrast",
               .confused_with = {"range_scale", "missed_triggers", "body_size"},
               .same_as = "range_scale",
               .parameters = {{.name = "delta_t_k",
                               .unit = "K",
                               .off = rated_k,
                               .typical = 2.0,
                               .low = 1.0,
                               .high = 12.0,
                               .least = 0.01,
                               .most = 40.0,
                               .scale = Scale::logarithmic,
                               .source =
                                   "Panasonic data sheet EKMC: rated at 4 K; range assumed: warm clothes in a warm "
                                   "room to bare skin in a cool one; only its size counts: surroundings warmer by as "
                                   "much change zones alike"}},
               .reach = Reach::geometry},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
