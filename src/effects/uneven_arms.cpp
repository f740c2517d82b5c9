// Nobody swings their arms like a clock.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  const UnevenArmsSpec arms{effect.parameters.at("spread"), effect.parameters.at("pause_share")};
  for_each_person(study, [&](PersonInForce& person) { person.changes.uneven_arms = arms; });
}

}  // namespace

const Effect& uneven_arms() {
  static const Effect effect{
      .info =
          {.name = "uneven_arms",
           .family = Family::motion,
           .stage = "body",
           .summary =
               "Each swing of the arms at desk work has an amplitude and a period of its own, and some are left out.",
           .fingerprint = "the arms' line in the spectrum is broad; gaps where arms rest",
           .confused_with = {"arm_motion", "missed_triggers", "natural_motion"},
           .parameters = {{.name = "spread",
                           .unit = "",
                           .off = 0.0,
                           .typical = 0.2,
                           .low = 0.05,
                           .high = 0.4,
                           .least = 0.0,
                           .most = 1.0,
                           .source = "assumed: of the logarithm, about a mean of 1"},
                          {.name = "pause_share",
                           .unit = "",
                           .off = 0.0,
                           .typical = 0.2,
                           .low = 0.0,
                           .high = 0.6,
                           .least = 0.0,
                           .most = 1.0,
                           .source = "assumed: of the swings"}},
           .reach = Reach::geometry,
           .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
