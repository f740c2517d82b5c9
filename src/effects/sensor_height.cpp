// A sensor hangs higher or lower than drawn.
#include <algorithm>

#include "effects/kit.hpp"
#include "geom/triangle_surface.hpp"
#include "pirsim/error.hpp"

namespace pirsim::effects {
namespace {

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

void alter(StudyInForce& study, const EffectSpec& effect) {
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
void draw(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream&) {
  if (!has_room(effect, scene)) effect.parameters.at("height_m") *= -1.0;
}

/// Halved until there is room.
void settle(EffectSpec& effect, const SceneSpec& scene) {
  constexpr double least_m = 1e-4;
  double& height_m = effect.parameters.at("height_m");
  while (!has_room(effect, scene)) height_m = std::abs(height_m) > least_m ? 0.5 * height_m : 0.0;
}

}  // namespace

const Effect& sensor_height() {
  static const Effect effect{
      .info = {.name = "sensor_height",
               .family = Family::mounting,
               .stage = "placement",
               .summary = "Sensors hang higher (positive) or lower than drawn; not through a ceiling.",
               .fingerprint = "near and far seats change oppositely, as with tilt",
               .confused_with = {"sensor_tilt", "seat_shift"},
               .parameters = {offset("height_m", "m", 0.3, -0.15, 3.0,
                                     "assumed: measured from the wrong edge; down where a ceiling is above")},
               .choices = {sensor_choice()},
               .reach = Reach::geometry},
      .alter = alter,
      .draw = draw,
      .settle = settle};
  return effect;
}

}  // namespace pirsim::effects
