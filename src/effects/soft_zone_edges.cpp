// A lens throws a blurred image of its element: whether somebody at a zone's edge is seen is a matter of chance.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// Where the physics is: pir::edge_levels grows nested copies of every zone, pir::EdgeDraw draws one a window.
void alter(StudyInForce& study, const EffectSpec& effect) {
  study.sensing.edge_sigma_deg = effect.parameters.at("sigma_deg");
}

}  // namespace

const Effect& soft_zone_edges() {
  static const Effect effect{
      .info = {.name = "soft_zone_edges",
               .family = Family::optics,
               .stage = "optics",
               .summary = "Zones have blurred edges: each window and channel draws how far out they are, normally "
                          "distributed.",
               .fingerprint = "silent and low cells rise several-fold, high ones don't; isolated ones; a still person "
                              "never triggers",
               .confused_with = {"fidgeting", "false_triggers", "seat_scatter"},
               .parameters = {{.name = "sigma_deg",
                               .unit = "deg",
                               .off = 0.0,
                               .typical = 0.8,
                               .low = 0.2,
                               .high = 2.0,
                               .least = 0.0,
                               .most = 5.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: from a moulded lens's few tenths of a degree to a defocused one"}},
               .reach = Reach::geometry,
               .acts_on = ActsOn::zone_sensors},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
