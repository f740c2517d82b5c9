// What happens to infrared before it becomes a signal: lens, element, surfaces that mirror.
// Assumed: a signal falls with the square of the distance and rises with the contrast of temperature.
// Method: ranges of clusters are scaled, or a field of the sensing in force is set, which src/pir carries out.
// Sources: Panasonic's data sheet of the EKMC series for the rated contrast; else assumed.
#include <algorithm>
#include <glm/geometric.hpp>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

// thermal_contrast: a rated distance holds at the rated contrast of temperature; signals fall with the square of the
// distance.

constexpr double rated_k =
    4.0;  // data sheet of the EKMC series: detection distance at 4 K between target and background

void alter_thermal_contrast(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const double factor = std::sqrt(effect.parameters.at("delta_t_k") / rated_k);
  for (auto& [id, model] : scene.sensor_models) {
    for (ClusterSpec& cluster : model.clusters) cluster.range_m *= factor;
  }
}

Effect thermal_contrast() {
  return {
      .info = {.name = "thermal_contrast",
               .family = Family::optics,
               .stage = "optics",
               .summary = "People stand out from the background by another temperature than the rated 4 K.",
               .fingerprint = "far zones fall silent or reach further, by the square root of the contrast",
               .confused_with = {"range_scale", "missed_triggers", "body_size"},
               .same_as = "range_scale",
               .parameters = {{.name = "delta_t_k",
                               .unit = "K",
                               .phrase = "difference in temperature",
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
               .reach = Reach::geometry,
               .in_analog = "as range_scale: another gain. Temperatures are the scene's and people's: `ambient_c`, "
                            "`warmth`"},
      .alter = alter_thermal_contrast};
}

// range_scale: a lens reaches further than its data sheet promises, or less far.

void alter_range_scale(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  for (auto& [id, model] : scene.sensor_models) {
    for (ClusterSpec& cluster : model.clusters) cluster.range_m *= effect.parameters.at("scale");
  }
}

Effect range_scale() {
  return {
      .info = {.name = "range_scale",
               .family = Family::optics,
               .stage = "optics",
               .summary = "All rated detection distances are wrong by one factor.",
               .fingerprint = "only seats near the end of a range change",
               .confused_with = {"thermal_contrast", "body_size"},
               .parameters = {factor("scale", 0.5, 1.8, 0.8,
                                     "assumed: a data sheet promises a least distance, a lens ages")},
               .reach = Reach::geometry,
               .in_analog = "another gain: such that the rated target is just detected at that many times the rated "
                            "distance. A threshold that is set otherwise looks the same"},
      .alter = alter_range_scale};
}

// soft_zone_edges: a lens throws a blurred image of its element: whether somebody at a zone's edge is seen is a matter
// of chance.

/// Where the physics is: pir::edge_levels grows nested copies of every zone, pir::SoftEdges decides what they notice.
void alter_soft_zone_edges(StudyInForce& study, const EffectSpec& effect) {
  SoftEdgesSpec& edges = study.sensing.soft_edges;
  edges.sigma_deg = effect.parameters.at("sigma_deg");
  const std::string rule = word(effect, "rule");
  edges.rule = rule == "covered_area" ? EdgeRule::covered_area
               : rule == "swept_area" ? EdgeRule::swept_area
                                      : EdgeRule::drawn_edge;
  if (edges.rule == EdgeRule::covered_area) edges.threshold = effect.parameters.at("threshold");
}

/// Analog sensors have no rule to draw.
void draw_soft_zone_edges(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec& script, Stream&) {
  if (any_of_zones(scene, script.sensing)) return;
  effect.choices.erase("rule");
}

Effect soft_zone_edges() {
  return {
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
                               .phrase = "blur (standard deviation)",
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
               .in_analog =
                   "more blur of the lens, beside its own `blur_deg` (root sum of squares); the gain stays. It "
                   "follows the physics, so `rule` and `threshold` mean nothing"},
      .alter = alter_soft_zone_edges,
      .draw = draw_soft_zone_edges};
}

// blind_field: dirt, a cable or a shelf close by makes a part of a lens blind.

void alter_blind_field(StudyInForce& study, const EffectSpec& effect) {
  study.sensing.blind_fields.push_back(
      {sensors_of(effect, study.scene), effect.parameters.at("share"), effect.parameters.at("side_deg")});
}

Effect blind_field() {
  return {
      .info =
          {.name = "blind_field",
           .family = Family::optics,
           .stage = "optics",
           .summary = "A part of a lens's field is blind, from its rim inwards.",
           .fingerprint = "one sensor falls silent for the seats on one side of it, and is as it was for the others",
           .confused_with = {"dead_sensor", "missing_occluder", "sensor_yaw", "sensor_tilt"},
           .parameters = {{.name = "share",
                           .unit = "",
                           .phrase = "blind share",
                           .off = 0.0,
                           .typical = 0.4,
                           .low = 0.15,
                           .high = 0.8,
                           .least = 0.0,
                           .most = 1.0,
                           .source = "assumed: of the rays"},
                          detail("side_deg", "deg", 0.0, -180.0, 180.0, -360.0, 360.0,
                                 "any: where the blind part begins, from the lens's right (0) to its upper side (90)")},
           .choices = {sensor_choice()},
           .reach = Reach::geometry},
      .alter = alter_blind_field};
}

// wall_reflection: a window, a screen or a steel cupboard mirrors far infrared: sensors see people in it.

/// Of upright faces, square metres, both sides of a box counted.
double upright_area_m2(const TriMesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 normal = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    constexpr double upright = 0.1;  // of the normal's vertical part
    if (std::abs(normal.y) <= upright * glm::length(normal)) area += 0.5 * glm::length(normal);
  }
  return area;
}

std::vector<std::string> upright_meshes(const SceneSpec& scene) {
  constexpr double worth_mentioning_m2 = 1.0;  // assumed
  std::vector<std::string> names;
  for (const TriMesh& mesh : scene.meshes) {
    if (upright_area_m2(mesh) >= worth_mentioning_m2) names.push_back(mesh.name);
  }
  return names;
}

std::string largest_mesh(const SceneSpec& scene) {
  if (scene.meshes.empty()) return "";
  return std::ranges::max_element(scene.meshes, {}, upright_area_m2)->name;
}

void alter_wall_reflection(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const auto wall = effect.choices.find("wall");
  study.sensing.reflections.push_back({wall == effect.choices.end() ? largest_mesh(scene) : wall->second,
                                       effect.parameters.at("coefficient"),
                                       word(effect, "finish") == "rough" ? effect.parameters.at("scatter_deg") : 0.0});
}

void draw_wall_reflection(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const std::vector<std::string> names = upright_meshes(scene);
  if (!names.empty()) effect.choices["wall"] = names[stream.index(static_cast<std::uint32_t>(names.size()))];
}

Effect wall_reflection() {
  return {
      .info = {.name = "wall_reflection",
               .family = Family::environment,
               .stage = "optics",
               .summary =
                   "Rays go on mirrored at a glossy wall, with the range that the weakened signal allows; a rough one "
                   "scatters them.",
               .fingerprint = "ghost zones: sensors see seats that they don't face",
               .confused_with = {"second_person", "false_triggers", "range_scale"},
               .parameters = {{.name = "coefficient",
                               .unit = "",
                               .phrase = "mirrored share",
                               .off = 0.0,
                               .typical = 0.5,
                               .low = 0.1,
                               .high = 0.95,
                               .least = 0.0,
                               .most = 1.0,
                               .source = "assumed: of power at 10 um; glass mirrors a tenth, bare metal nearly all"},
                              {.name = "scatter_deg",
                               .unit = "deg",
                               .role = Role::detail,
                               .off = 8.0,
                               .typical = 8.0,
                               .low = 3.0,
                               .high = 15.0,
                               .least = 0.0,
                               .most = 45.0,
                               .source = "assumed: standard deviation of a mirrored ray's direction; brushed metal, "
                                         "lacquer",
                               .only_if = {"finish", "rough"}}},
               .choices = {{"finish", ChoiceKind::variant, {"smooth", "rough"}, "smooth"},
                           {"wall", ChoiceKind::mesh, {}, "the mesh with the largest upright faces"}},
               .reach = Reach::geometry,
               .acts_on = ActsOn::zone_sensors,
               .in_analog = "nothing: the power that comes by a mirror isn't followed"},
      .alter = alter_wall_reflection,
      .draw = draw_wall_reflection};
}

// dual_polarity: two elements of opposite sign, an amplifier with a pass band, a threshold: what a real detector has in
// place of "something changed".

/// Where the physics is: pir::PolarityFilter.
void alter_dual_polarity(StudyInForce& study, const EffectSpec& effect) {
  study.sensing.dual_polarity = {effect.parameters.at("threshold"), effect.parameters.at("high_pass_hz"),
                                 effect.parameters.at("low_pass_hz")};
}

Effect dual_polarity() {
  return {
      .info = {.name = "dual_polarity",
               .family = Family::electronics,
               .stage = "detector",
               .summary = "Zones count with their element's sign; a sensor triggers while their band-passed sum is "
                          "beyond a threshold.",
               .fingerprint =
                   "beams count one by one, so most cells change; slow motion is lost, and motion across both signs "
                   "at once; above a threshold of 1 most of everything",
               .confused_with = {"missed_triggers", "arm_motion", "pulse_stretching"},
               .parameters = {{.name = "threshold",
                               .unit = "zones",
                               .off = 0.0,
                               .typical = 0.8,
                               .low = 0.2,
                               .high = 1.5,
                               .least = 0.0,
                               .most = 100.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: the step that one zone makes is 1"},
                              {.name = "high_pass_hz",
                               .unit = "Hz",
                               .role = Role::detail,
                               .off = 0.3,
                               .typical = 0.3,
                               .low = 0.1,
                               .high = 0.6,
                               .least = 0.001,
                               .most = 10.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: usual PIR amplifiers begin to pass at 0.1-0.6 Hz"},
                              {.name = "low_pass_hz",
                               .unit = "Hz",
                               .role = Role::detail,
                               .off = 7.0,
                               .typical = 7.0,
                               .low = 4.0,
                               .high = 12.0,
                               .least = 0.1,
                               .most = 100.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: and end at 5-10 Hz"}},
               .reach = Reach::geometry,
               .acts_on = ActsOn::zone_sensors,
               .in_analog = "nothing: an analog sensor has two elements, a band and a threshold as it is"},
      .alter = alter_dual_polarity};
}

}  // namespace

std::vector<Effect> lens_effects() {
  return {thermal_contrast(), range_scale(), soft_zone_edges(), blind_field(), wall_reflection(), dual_polarity()};
}

}  // namespace pirsim::effects
