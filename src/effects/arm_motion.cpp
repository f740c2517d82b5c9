// Arms don't keep to the script.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  for_each_work(study, [&](action::Work& work) {
    work.arm_amplitude_m *= effect.parameters.at("amplitude_scale");
    work.arm_period_s *= effect.parameters.at("period_scale");
  });
}

}  // namespace

const Effect& arm_motion() {
  static const Effect effect{
      .info = {.name = "arm_motion",
               .family = Family::motion,
               .stage = "body",
               .summary = "Arms move further or less far, faster or slower than the script says.",
               .fingerprint = "the arms' line in the spectrum moves or changes its height",
               .confused_with = {"trunk_tilt", "body_size", "fidgeting"},
               .parameters = {factor("amplitude_scale", 0.3, 1.8, 0.6, "assumed"),
                              factor("period_scale", 0.83, 1.17, 1.0,
                                     "assumed: 2.5-3.5 s for the 3 s of Study A, kept by a person with a clock")},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
