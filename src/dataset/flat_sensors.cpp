#include <algorithm>
#include <array>
#include <cmath>

#include "dataset/flat_furnish.hpp"
#include "dataset/flat_names.hpp"

namespace pirsim::dataset {
namespace {

constexpr double sensor_off_wall_m = 0.05;
constexpr double above_doorway_m = 0.1;    // 0.05-0.2
constexpr double doorway_tilt_deg = 75.0;  // 60-85: the strip before the door, not the room behind

Quat looking(const Vec2& direction, double tilt_rad) {
  return rotation_from_heading(heading_of(direction)) * glm::angleAxis(-tilt_rad, Vec3(1, 0, 0));
}

SensorSpec& add_sensor(const FlatSpec& spec, SensorsAt at, Mount mount, const std::string& name, Stream& stream,
                       SceneSpec& scene) {
  SensorSpec& sensor = scene.sensors.emplace_back();
  sensor.id = name;
  sensor.model = one_of(models_of(spec, at, mount), stream);
  return sensor;
}

/// Whether something as high as the sensor hides the corner: a wardrobe.
bool is_behind_furniture(const Vec2& corner, const std::vector<Rectangle>& tall) {
  constexpr double near_m = 0.3;
  return std::ranges::any_of(tall, [&](const Rectangle& r) {
    return overlap(r, {corner - Vec2(near_m), corner + Vec2(near_m)});
  });
}

/// Of meshes that aren't walls.
std::vector<Rectangle> tall_furniture(const SceneSpec& scene, double height_m) {
  std::vector<Rectangle> tall;
  for (const TriMesh& mesh : scene.meshes) {
    Rectangle r{Vec2(1e9), Vec2(-1e9)};
    double top = 0.0;
    for (const Vec3& p : mesh.positions) {
      r = {{std::min(r.lower.x, p.x), std::min(r.lower.y, p.z)}, {std::max(r.upper.x, p.x), std::max(r.upper.y, p.z)}};
      top = std::max(top, p.y);
    }
    constexpr double short_of_ceiling_m = 0.1;
    if (top > 1.5 && top < height_m - short_of_ceiling_m) tall.push_back(r);
  }
  return tall;
}

}  // namespace

const std::vector<std::string>& models_of(const FlatSpec& spec, SensorsAt at, Mount mount) {
  static const std::vector<std::string> ceiling{"EKMC1601111"}, corner{"EKMC1604111"}, doorway{"AMN33111"};
  if (!spec.models.empty()) return spec.models;
  if (at == SensorsAt::doorways) return doorway;
  return mount == Mount::ceiling ? ceiling : corner;
}

void hang_in_rooms(const FlatSpec& spec, const FlatPlan& plan, double height_m, Stream& stream, SceneSpec& scene) {
  const Mount mount = one_of(spec.mounts, stream);
  const std::vector<Rectangle> tall = tall_furniture(scene, height_m);
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    SensorSpec& sensor = add_sensor(spec, SensorsAt::rooms, mount, room_sensor_name(plan.rooms[i].id), stream, scene);
    sensor.area = plan.rooms[i].id;
    const Rectangle r = plan.clear_floor(i);
    const Vec2 centre = 0.5 * (r.lower + r.upper);
    if (mount == Mount::ceiling) {
      const double turn = radians(5.0 * stream.index(72));
      sensor.world_from_sensor = {rotation_from_heading(turn) * glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0)),
                                  Vec3(centre.x, height_m - 0.01, centre.y)};
      continue;
    }
    const double high = std::min(draw_length(spec.sensor_height_m, stream), height_m - sensor_off_wall_m);
    const double tilt = radians(std::round(draw(spec.sensor_tilt_deg, stream)));
    Vec2 corner{0.0};
    for (std::uint32_t k = 0, first = stream.index(4); k < 4; ++k) {
      const std::uint32_t which = (first + k) % 4;
      corner = {(which & 1) != 0 ? r.upper.x - sensor_off_wall_m : r.lower.x + sensor_off_wall_m,
                (which & 2) != 0 ? r.upper.y - sensor_off_wall_m : r.lower.y + sensor_off_wall_m};
      if (!is_behind_furniture(corner, tall)) break;
    }
    sensor.world_from_sensor = {looking(centre - corner, tilt), Vec3(corner.x, high, corner.y)};
  }
}

void hang_at_doorways(const FlatSpec& spec, const FlatPlan& plan, Stream& stream, SceneSpec& scene) {
  for (const Doorway& door : plan.doorways) {
    const std::string name = doorway_sensor_name(door.from ? plan.rooms[door.into].id : front_door_name);
    SensorSpec& sensor = add_sensor(spec, SensorsAt::doorways, Mount::wall, name, stream, scene);
    // Nobody hangs one outside of the front door.
    const Vec2 towards = door.from ? -door.direction : door.direction;
    sensor.area = plan.rooms[door.from.value_or(door.into)].id;
    const Vec2 place = door.middle + ((door.from ? 0.5 * flat_wall_m : 0.0) + sensor_off_wall_m) * towards;
    sensor.world_from_sensor = {looking(towards, radians(doorway_tilt_deg)),
                                Vec3(place.x, doorway_height_m + above_doorway_m, place.y)};
  }
}

}  // namespace pirsim::dataset
