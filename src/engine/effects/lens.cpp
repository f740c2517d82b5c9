#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/effects/kit.hpp"
#include "model/geom/shapes.hpp"
#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

// What happens to infrared before it becomes a signal: lens, element, surfaces that mirror.
// Assumed: a signal falls with the square of the distance and rises with the contrast of temperature.
// Method: ranges of clusters are scaled, or a field of the sensing in force is set, which src/pir carries out.
// Sources: Panasonic's data sheet of the EKMC series for the rated contrast; else assumed.

namespace pirsim::effects {
namespace {

// thermal_contrast: a rated distance holds at the rated contrast of temperature; signals fall with the square of the
// distance.

constexpr double rated_k =
    4.0;  // data sheet of the EKMC series: detection distance at 4 K between target and background

/// Of PIR sensors: what a beam reaches depends on no temperature.
void scale_ranges(SceneSpec& scene, double scale) {
  for (auto& [id, model] : scene.sensor_models) {
    if (model.response == Response::beam) continue;
    for (ClusterSpec& cluster : model.clusters) cluster.range_m *= scale;
  }
}

void alter_thermal_contrast(StudyInForce& study, const EffectSpec& effect) {
  scale_ranges(study.scene, std::sqrt(effect.parameters.at("delta_t_k") / rated_k));
}

Effect thermal_contrast() {
  return {.info = {.name = "thermal_contrast",
                   .family = Family::optics,
                   .stage = "optics",
                   .summary = "People differ from the background by another temperature than the rated 4 K.",
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
                                   .source = "Panasonic data sheet EKMC: rated at 4 K; range assumed: warm clothes in "
                                             "a warm room to bare skin in a cool one; the sign doesn't matter"}},
                   .reach = Reach::geometry,
                   .in_analog = "another gain, as range_scale; `ambient_c` and `warmth` set temperatures"},
          .alter = alter_thermal_contrast};
}

// range_scale: a lens reaches further than its data sheet promises, or less far.

void alter_range_scale(StudyInForce& study, const EffectSpec& effect) {
  scale_ranges(study.scene, effect.parameters.at("scale"));
}

Effect range_scale() {
  return {.info = {.name = "range_scale",
                   .family = Family::optics,
                   .stage = "optics",
                   .summary = "All rated detection distances are wrong by one factor.",
                   .fingerprint = "only seats near the end of a range change",
                   .confused_with = {"thermal_contrast", "body_size"},
                   .parameters = {factor("scale", 0.5, 1.8, 0.8,
                                         "assumed: a data sheet promises a least distance, a lens ages")},
                   .reach = Reach::geometry,
                   .in_analog = "a gain that just detects the rated target at `scale` times the rated distance; "
                                "another threshold looks the same"},
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
               .summary = "Zones have blurred edges. By `rule`, motion is a change across an edge that is drawn anew "
                          "for each window and channel, a change of the covered share, or, by chance, what is swept.",
               .fingerprint = "silent and low cells rise several-fold, high cells don't; single seconds with motion; a "
                              "still person never triggers",
               .confused_with = {"fidgeting", "false_triggers", "seat_scatter"},
               .parameters = {told_as("blur (standard deviation)",
                                      logarithmic(strength(
                                          "sigma_deg", "deg", 0.8, 0.2, 2.0, 5.0,
                                          "assumed: from a moulded lens's few tenths of a degree to a defocused one"))),
                              detail("threshold", "", 0.5, 0.3, 0.7, 0.0, 1.0, "assumed: share of a zone",
                                     {"rule", "covered_area"})},
               .choices = {{"rule", ChoiceKind::variant, {"drawn_edge", "covered_area", "swept_area"}, "drawn edges"}},
               .reach = Reach::geometry,
               .in_analog = "adds to the lens's `blur_deg` (root sum of squares) and leaves the gain; `rule` and "
                            "`threshold` mean nothing"},
      .alter = alter_soft_zone_edges,
      .draw = draw_soft_zone_edges};
}

// blind_field: dirt, a cable or a shelf close by makes a part of a lens blind.

void alter_blind_field(StudyInForce& study, const EffectSpec& effect) {
  study.sensing.blind_fields.push_back(
      {sensors_of(effect, study.scene), effect.parameters.at("share"), effect.parameters.at("side_deg")});
}

Effect blind_field() {
  return {.info = {.name = "blind_field",
                   .family = Family::optics,
                   .stage = "optics",
                   .summary = "A part of a lens's field is blind, from its rim inwards.",
                   .fingerprint = "one sensor falls silent for the seats on one side of it and keeps the others",
                   .confused_with = {"dead_sensor", "missing_occluder", "sensor_yaw", "sensor_tilt"},
                   .parameters =
                       {told_as("blind share", strength("share", "", 0.4, 0.15, 0.8, 1.0, "assumed: of the rays")),
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
               .summary = "A glossy wall mirrors rays, which go on as far as the weakened signal allows; a rough wall "
                          "scatters them.",
               .fingerprint = "ghost zones: sensors see seats that they don't face",
               .confused_with = {"second_person", "false_triggers", "range_scale"},
               .parameters =
                   {told_as(
                        "mirrored share",
                        strength("coefficient", "", 0.5, 0.1, 0.95, 1.0,
                                 "assumed: share of the power at 10 um; glass mirrors a tenth, bare metal nearly all")),
                    detail("scatter_deg", "deg", 8.0, 3.0, 15.0, 0.0, 45.0,
                           "assumed: standard deviation of a mirrored ray's direction; brushed metal, "
                           "lacquer",
                           {"finish", "rough"})},
               .choices = {{"finish", ChoiceKind::variant, {"smooth", "rough"}, "smooth"},
                           {"wall", ChoiceKind::mesh, {}, "the mesh with the largest upright faces"}},
               .reach = Reach::geometry,
               .acts_on = ActsOn::zone_sensors,
               .in_analog = "nothing: mirrored power isn't traced"},
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
               .summary = "Zones count with the sign of their element; a sensor triggers while their band-passed sum "
                          "is beyond a threshold.",
               .fingerprint =
                   "beams count one by one, so most cells change; slow motion is lost, and motion across both signs "
                   "at once; above a threshold of 1 most of everything",
               .confused_with = {"missed_triggers", "arm_motion", "pulse_stretching"},
               .parameters = {logarithmic(strength("threshold", "zones", 0.8, 0.2, 1.5, 100.0,
                                                   "assumed: the step that one zone makes is 1")),
                              logarithmic(detail("high_pass_hz", "Hz", 0.3, 0.1, 0.6, 0.001, 10.0,
                                                 "assumed: usual PIR amplifiers begin to pass at 0.1-0.6 Hz")),
                              logarithmic(detail("low_pass_hz", "Hz", 7.0, 4.0, 12.0, 0.1, 100.0,
                                                 "assumed: and end at 5-10 Hz"))},
               .reach = Reach::geometry,
               .acts_on = ActsOn::zone_sensors,
               .in_analog = "nothing: an analog sensor has two elements, a band and a threshold already"},
      .alter = alter_dual_polarity};
}

}  // namespace

std::vector<Effect> lens_effects() {
  return {thermal_contrast(), range_scale(), soft_zone_edges(), blind_field(), wall_reflection(), dual_polarity()};
}

// How a sensor hangs: turned, tilted, higher or lower than drawn.
// Assumed: somebody mounted it by eye, and not inside a wall.
// Method: the frames of the sensors in force are turned and moved before rays are made. Sources: no measurement.

namespace {

// sensor_yaw: a sensor is screwed on a little turned.

void alter_sensor_yaw(StudyInForce& study, const EffectSpec& effect) {
  const Quat yaw = rotation_from_heading(radians(effect.parameters.at("yaw_deg")));
  for_each_sensor(study, effect, [&](SensorSpec& sensor) {
    Quat& rotation = sensor.world_from_sensor.rotation;
    rotation = glm::normalize(yaw * rotation);
  });
}

Effect sensor_yaw() {
  return {.info = {.name = "sensor_yaw",
                   .family = Family::mounting,
                   .stage = "placement",
                   .summary = "Sensors look further to the left (positive, seen from above) or right than drawn.",
                   .fingerprint =
                       "cells change as the map shifts sideways: seats on one side gain what the other side loses",
                   .confused_with = {"sensor_tilt", "seat_shift"},
                   .parameters = {offset("yaw_deg", "deg", 25.0, 3.0, 180.0, "assumed: mounted by eye, or knocked")},
                   .choices = {sensor_choice()},
                   .reach = Reach::geometry},
          .alter = alter_sensor_yaw};
}

// sensor_tilt: a sensor looks further down than drawn, or less far.

void alter_sensor_tilt(StudyInForce& study, const EffectSpec& effect) {
  const Quat tilt = glm::angleAxis(-radians(effect.parameters.at("tilt_deg")), Vec3(1, 0, 0));
  for_each_sensor(study, effect, [&](SensorSpec& sensor) {
    Quat& rotation = sensor.world_from_sensor.rotation;
    rotation = glm::normalize(rotation * tilt);
  });
}

Effect sensor_tilt() {
  return {.info = {.name = "sensor_tilt",
                   .family = Family::mounting,
                   .stage = "placement",
                   .summary = "Sensors look further down (positive) or up than drawn.",
                   .fingerprint = "near and far seats change in opposite directions",
                   .confused_with = {"sensor_height", "seat_shift", "sensor_yaw"},
                   .parameters = {offset("tilt_deg", "deg", 6.0, 2.0, 90.0, "assumed: mounted by eye")},
                   .choices = {sensor_choice()},
                   .reach = Reach::geometry},
          .alter = alter_sensor_tilt};
}

// sensor_height: a sensor hangs higher or lower than drawn.

bool touches(const TriMesh& mesh, const Vec3& from, double height_m) {
  constexpr double clear_m = 0.001;  // assumed: what sees is in front of what it is screwed to
  constexpr double off_m = 1e-6;     // a sensor that is drawn on a surface may leave it
  return height_m != 0.0 && std::ranges::any_of(mesh.triangles, [&](const auto& triangle) {
           const double ways = distance_to_triangle(from, Vec3(0, height_m, 0), mesh.positions[triangle[0]],
                                                    mesh.positions[triangle[1]], mesh.positions[triangle[2]]);
           const double way_m = ways * std::abs(height_m);
           return way_m > off_m && way_m <= std::abs(height_m) + clear_m;
         });
}

/// What a sensor would have to go through, if anything: most hang just below a ceiling.
const TriMesh* in_the_way(const SceneSpec& scene, const SensorSpec& sensor, double height_m) {
  const auto mesh = std::ranges::find_if(
      scene.meshes, [&](const TriMesh& m) { return touches(m, sensor.world_from_sensor.origin, height_m); });
  return mesh == scene.meshes.end() ? nullptr : &*mesh;
}

void alter_sensor_height(StudyInForce& study, const EffectSpec& effect) {
  const double height_m = effect.parameters.at("height_m");
  for_each_sensor(study, effect, [&](SensorSpec& sensor) {
    if (const TriMesh* mesh = in_the_way(study.scene, sensor, height_m)) {
      throw Error(ErrorCode::infeasible, effect.where,
                  "sensor_height: " + sensor.id + " would hang in or behind '" + mesh->name + "'");
    }
    sensor.world_from_sensor.origin.y += height_m;
  });
}

bool has_room(const EffectSpec& effect, const SceneSpec& scene) {
  return std::ranges::none_of(sensors_of(effect, scene), [&](std::uint32_t i) {
    return in_the_way(scene, scene.sensors[i], effect.parameters.at("height_m")) != nullptr;
  });
}

/// Where there is no room above, sensors hang lower.
void draw_sensor_height(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream&) {
  if (!has_room(effect, scene)) effect.parameters.at("height_m") *= -1.0;
}

/// Halved until there is room.
void settle_sensor_height(EffectSpec& effect, const SceneSpec& scene) {
  constexpr double least_m = 1e-4;
  double& height_m = effect.parameters.at("height_m");
  while (!has_room(effect, scene)) height_m = std::abs(height_m) > least_m ? 0.5 * height_m : 0.0;
}

Effect sensor_height() {
  return {.info = {.name = "sensor_height",
                   .family = Family::mounting,
                   .stage = "placement",
                   .summary = "Sensors hang higher (positive) or lower than drawn, but not through a ceiling.",
                   .fingerprint = "as sensor_tilt",
                   .confused_with = {"sensor_tilt", "seat_shift"},
                   .parameters = {offset("height_m", "m", 0.3, -0.15, 3.0,
                                         "assumed: measured from the wrong edge; down where a ceiling is above")},
                   .choices = {sensor_choice()},
                   .reach = Reach::geometry},
          .alter = alter_sensor_height,
          .draw = draw_sensor_height,
          .settle = settle_sensor_height};
}

}  // namespace

std::vector<Effect> mounting_effects() { return {sensor_yaw(), sensor_tilt(), sensor_height()}; }

}  // namespace pirsim::effects
