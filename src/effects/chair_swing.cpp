// Who sits swings on the chair.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  const SwingSpec swing{effect.parameters.at("amplitude_deg"), effect.parameters.at("period_s"),
                        effect.parameters.at("share")};
  for_each_person(study, [&](PersonInForce& person) { person.changes.chair_swing = swing; });
}

}  // namespace

const Effect& chair_swing() {
  static const Effect effect{
      .info = {.name = "chair_swing",
               .family = Family::motion,
               .stage = "body",
               .summary = "A seated person turns to and fro on the swivel chair, in bouts.",
               .fingerprint = "bouts in which every sensor that sees the sitter is active",
               .confused_with = {"fidgeting", "natural_motion", "soft_zone_edges"},
               .parameters = {{.name = "amplitude_deg",
                               .unit = "deg",
                               .off = 0.0,
                               .typical = 10.0,
                               .low = 3.0,
                               .high = 25.0,
                               .least = 0.0,
                               .most = 60.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: to either side"},
                              detail("period_s", "s", 3.0, 1.5, 6.0, 0.4, 60.0, "assumed"),
                              detail("share", "", 0.5, 0.1, 1.0, 0.0, 1.0, "assumed: of the time, in bouts of 20 s")},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
