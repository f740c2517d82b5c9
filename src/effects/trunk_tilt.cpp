// The trunk doesn't keep to the script.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  for_each_work(study, [&](action::Work& work) {
    for (double& tilt : work.tilt_choices_deg) tilt *= effect.parameters.at("amplitude_scale");
    work.tilt_every_s *= effect.parameters.at("period_scale");
  });
}

}  // namespace

const Effect& trunk_tilt() {
  static const Effect effect{
      .info = {.name = "trunk_tilt",
               .family = Family::motion,
               .stage = "body",
               .summary = "Trunks tilt further or less far, more often or less often than the script says.",
               .fingerprint = "the peak at every change of posture grows, shrinks or moves",
               .confused_with = {"arm_motion", "clock_lag", "fidgeting"},
               .parameters = {factor("amplitude_scale", 0.3, 1.8, 0.6, "assumed"),
                              factor("period_scale", 0.7, 1.4, 1.0, "assumed")},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
