// A lens throws a blurred image of its element: whether somebody at a zone's edge is seen is a matter of chance.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// Where the physics is: pir::edge_levels grows nested copies of every zone, pir::SoftEdges decides what they notice.
void alter(StudyInForce& study, const EffectSpec& effect) {
  SoftEdgesSpec& edges = study.sensing.soft_edges;
  edges.sigma_deg = effect.parameters.at("sigma_deg");
  const std::string rule = word(effect, "rule");
  edges.rule = rule == "covered_area" ? EdgeRule::covered_area
               : rule == "swept_area" ? EdgeRule::swept_area
                                      : EdgeRule::drawn_edge;
  if (edges.rule == EdgeRule::covered_area) edges.threshold = effect.parameters.at("threshold");
}

}  // namespace

const Effect& soft_zone_edges() {
  static const Effect effect{
      .info = {.name = "soft_zone_edges",
               .family = Family::optics,
               .stage = "optics",
               .summary =
                   "Zones have blurred edges. What counts as motion: a change across an edge that each window and "
                   "channel draws anew, a change of the covered share, or by chance what is swept.",
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
                               .source = "assumed: from a moulded lens's few tenths of a degree to a defocused one"},
                              {.name = "threshold",
                               .unit = "",
                               .role = Role::detail,
                               .off = 0.5,
                               .typical = 0.5,
                               .low = 0.3,
                               .high = 0.7,
                               .least = 0.0,
                               .most = 1.0,
                               .source = "assumed: share of a zone",
                               .only_if = {"rule", "covered_area"}}},
               .choices = {{"rule", ChoiceKind::variant, {"drawn_edge", "covered_area", "swept_area"}, "drawn edges"}},
               .reach = Reach::geometry,
               .acts_on = ActsOn::zone_sensors},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
