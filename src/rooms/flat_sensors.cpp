// Sensors of a flat: in its rooms, at its doorways, or where a plan hangs them.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "rooms/flat.hpp"
#include "rooms/flat_layout.hpp"
#include "rooms/floor_plan.hpp"
#include "rooms/recipe_fields.hpp"

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

namespace {

Frame looking_down(const Vec2& from, double turn_rad, double ceiling_m) {
  return {rotation_from_heading(turn_rad) * glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0)),
          Vec3(from.x, ceiling_m - 0.01, from.y)};
}

/// Just off the walls; which: 0 to 3, from that of least x and z on.
Vec2 corner_of(const Rectangle& r, std::uint32_t which) {
  return {(which & 1) != 0 ? r.upper.x - sensor_off_wall_m : r.lower.x + sensor_off_wall_m,
          (which & 2) != 0 ? r.upper.y - sensor_off_wall_m : r.lower.y + sensor_off_wall_m};
}
/// From the first one on, unless furniture hides it.
Vec2 free_corner(const Rectangle& r, std::uint32_t first, const std::vector<Rectangle>& tall) {
  std::uint32_t which = first;
  while (which < first + 3 && is_behind_furniture(corner_of(r, which % 4), tall)) ++which;
  return corner_of(r, which % 4);
}

void hang_in_room(const FlatSpec& spec, const FlatPlan& plan, std::size_t room, Mount mount,
                  const std::vector<Rectangle>& tall, double height_m, Stream& stream, SceneSpec& scene) {
  const std::string& area = plan.rooms[room].id;
  SensorSpec& sensor = add_sensor(spec, SensorsAt::rooms, mount, room_sensor_name(area), stream, scene);
  sensor.area = area;
  const Rectangle r = plan.clear_floor(room);
  const Vec2 centre = 0.5 * (r.lower + r.upper);
  if (mount == Mount::ceiling) {
    sensor.world_from_sensor = looking_down(centre, radians(5.0 * stream.index(72)), height_m);
    return;
  }
  const double high = std::min(draw_length(spec.sensor_height_m, stream), height_m - sensor_off_wall_m);
  const double tilt = radians(std::round(draw(spec.sensor_tilt_deg, stream)));
  const Vec2 corner = free_corner(r, stream.index(4), tall);
  sensor.world_from_sensor = {looking(centre - corner, tilt), Vec3(corner.x, high, corner.y)};
}

/// Where a plan says.
Frame hung(const PlanSensorSpec& own, const Rectangle& room, double ceiling_m) {
  const Vec2 centre = 0.5 * (room.lower + room.upper);
  const Vec2 place{own.x_m.value_or(centre.x), own.y_m ? 0.0 - *own.y_m : centre.y};
  const double turn = radians(own.turned_deg), high = std::min(own.height_m, ceiling_m - sensor_off_wall_m);
  Vec2 from{0.0}, towards{0.0};
  if (own.corner) {
    from = corner_of(room, static_cast<std::uint32_t>(*own.corner) ^ 2U);  // z points down the page
    towards = centre - from;
  } else if (own.wall) {
    const Wall wall = wall_of(room, *own.wall);
    towards = wall.inward();
    from = (runs_along_x(*own.wall) ? Vec2(place.x, wall.from.y) : Vec2(wall.from.x, place.y)) +
           sensor_off_wall_m * towards;
  } else {
    return looking_down(place, turn, ceiling_m);
  }
  return {rotation_from_heading(turn) * looking(towards, radians(own.tilt_deg)), Vec3(from.x, high, from.y)};
}

}  // namespace

void hang_in_rooms(const FlatSpec& spec, const FlatPlan& plan, double height_m, Stream& stream, SceneSpec& scene) {
  const Mount mount = one_of(spec.mounts, stream);
  const std::vector<Rectangle> tall = tall_furniture(scene, height_m);
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) hang_in_room(spec, plan, i, mount, tall, height_m, stream, scene);
}

void hang_sensors(const HomePlanSpec& own, const FlatPlan& plan, const FlatSpec& usual, Stream& stream,
                  DrawnFlat& flat) {
  SceneSpec& scene = flat.scene;
  const std::vector<Rectangle> tall = tall_furniture(scene, flat.height_m);
  for (std::size_t i = 0; i < own.rooms.size(); ++i) {
    const auto is_of_area = [&](const SensorSpec& sensor) { return sensor.area == plan.rooms[i].id; };
    if (!own.rooms[i].sensors && std::ranges::none_of(scene.sensors, is_of_area))
      hang_in_room(usual, plan, i, Mount::corner, tall, flat.height_m, stream, scene);
    for (const PlanSensorSpec& one : own.rooms[i].sensors.value_or(std::vector<PlanSensorSpec>{})) {
      const Mount mount = one.corner ? Mount::corner : one.wall ? Mount::wall : Mount::ceiling;
      SensorSpec& sensor = scene.sensors.emplace_back();
      sensor.id = one.id;
      sensor.model = one.model.empty() ? models_of(usual, SensorsAt::rooms, mount).front() : one.model;
      sensor.area = plan.rooms[i].id;
      sensor.world_from_sensor = hung(one, plan.clear_floor(i), flat.height_m);
    }
  }
}

void hang_at_doorways(const FlatSpec& spec, const FlatPlan& plan, Stream& stream, SceneSpec& scene) {
  for (const Doorway& door : plan.doorways) {
    SensorSpec& sensor =
        add_sensor(spec, SensorsAt::doorways, Mount::wall, doorway_sensor_name(door.id), stream, scene);
    // Nobody hangs one outside of the front door.
    const Vec2 towards = door.from ? -door.direction : door.direction;
    sensor.area = plan.rooms[door.from.value_or(door.into)].id;
    const Vec2 place = door.middle + ((door.from ? 0.5 * flat_wall_m : 0.0) + sensor_off_wall_m) * towards;
    sensor.world_from_sensor = {looking(towards, radians(doorway_tilt_deg)),
                                Vec3(place.x, doorway_height_m + above_doorway_m, place.y)};
  }
}

}  // namespace pirsim::dataset
