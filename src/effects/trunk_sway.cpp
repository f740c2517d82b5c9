// A seated person sways a little from side to side.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  const SwingSpec sway{effect.parameters.at("amplitude_deg"), effect.parameters.at("period_s"), 1.0};
  for_each_person(study, [&](PersonInForce& person) { person.changes.trunk_sway = sway; });
}

}  // namespace

const Effect& trunk_sway() {
  static const Effect effect{
      .info = {.name = "trunk_sway",
               .family = Family::motion,
               .stage = "body",
               .summary = "A seated person sways from side to side all the time: breathing, balancing, music.",
               .fingerprint = "activity at a steady rhythm, where a zone's edge lies on trunk or head",
               .confused_with = {"fidgeting", "soft_zone_edges", "arm_motion"},
               .parameters = {{.name = "amplitude_deg",
                               .unit = "deg",
                               .off = 0.0,
                               .typical = 1.0,
                               .low = 0.3,
                               .high = 3.0,
                               .least = 0.0,
                               .most = 12.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: to either side; quiet sitting to rocking"},
                              detail("period_s", "s", 4.0, 2.0, 6.0, 0.2, 60.0, "assumed: of breathing, or slower")},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
