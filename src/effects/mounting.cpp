// How a sensor hangs: turned, tilted, higher or lower than drawn.
// Assumed: somebody mounted it by eye, and not inside a wall.
// Method: the frames of the sensors in force are turned and moved before rays are made. Sources: no measurement.
#include <algorithm>

#include "effects/kit.hpp"
#include "geom/triangle_surface.hpp"
#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::effects {
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
                   .parameters = {offset("yaw_deg", "deg", 8.0, 3.0, 180.0, "assumed: by eye")},
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
                   .fingerprint = "near and far seats change oppositely",
                   .confused_with = {"sensor_height", "seat_shift", "sensor_yaw"},
                   .parameters = {offset("tilt_deg", "deg", 6.0, 2.0, 90.0, "assumed: by eye")},
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
                   .summary = "Sensors hang higher (positive) or lower than drawn; not through a ceiling.",
                   .fingerprint = "near and far seats change oppositely, as with tilt",
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
