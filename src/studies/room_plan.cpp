#include "studies/room_plan.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <iterator>
#include <map>
#include <numeric>
#include <tuple>

#include "geom/floor_distance.hpp"
#include "geom/mesh_section.hpp"
#include "pirsim/geometry.hpp"
#include "schema/door_leaf.hpp"

namespace pirsim::studies {
namespace {

struct MeshExtent {
  Vec3 lower{1e9}, upper{-1e9};
};

MeshExtent bounds_of(const TriMesh& mesh) {
  MeshExtent result;
  for (const Vec3& p : mesh.positions) {
    result.lower = glm::min(result.lower, p);
    result.upper = glm::max(result.upper, p);
  }
  return result;
}

/// (n_positions) of a mesh: pieces that share no corner have different numbers.
std::vector<std::size_t> pieces_of(const TriMesh& mesh) {
  std::vector<std::size_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::tuple<double, double, double>, std::size_t> at;  // corners at one place are one
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3& p = mesh.positions[i];
    parent[root(i)] = root(at.try_emplace({p.x, p.y, p.z}, i).first->second);
  }
  for (const auto& triangle : mesh.triangles) {
    parent[root(triangle[1])] = root(triangle[0]);
    parent[root(triangle[2])] = root(triangle[0]);
  }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(i);
  return parent;
}

/// Andrew's monotone chain.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::ranges::sort(points, {}, [](const Vec2& p) { return std::pair(p.x, p.y); });
  std::vector<Vec2> hull;
  const auto chain = [&](auto first, auto last) {
    const std::size_t begin = hull.size();
    for (auto p = first; p != last; ++p) {
      const auto turns_left = [&] {
        const Vec2 a = hull.back() - hull[hull.size() - 2], b = *p - hull.back();
        return a.x * b.y - a.y * b.x > 0.0;
      };
      while (hull.size() >= begin + 2 && !turns_left()) hull.pop_back();
      hull.push_back(*p);
    }
    if (!hull.empty()) hull.pop_back();
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

void add_pieces(const TriMesh& mesh, std::vector<std::vector<Vec2>>& polygons) {
  const std::vector<std::size_t> pieces = pieces_of(mesh);
  std::map<std::size_t, std::vector<Vec2>> points;
  for (std::size_t i = 0; i < pieces.size(); ++i) points[pieces[i]].push_back(floor_point(mesh.positions[i]));
  for (auto& [piece, corners] : points) {
    std::vector<Vec2> hull = convex_hull(std::move(corners));
    if (hull.size() >= 3) polygons.push_back(std::move(hull));
  }
}

void add_wall(const TriMesh& mesh, double floor_height_m, io::RoomPlan& plan) {
  constexpr double cut_m = 1.0, thickest_m = 0.6;
  MeshSection section = section_of(mesh, floor_height_m + cut_m);
  if (mean_thickness_m(section.loops) <= thickest_m) {
    if (!section.loops.empty()) plan.walls.push_back(std::move(section.loops));
  } else {  // a shell round the room
    for (std::vector<Vec2>& loop : section.loops) {
      loop.push_back(loop.front());
      plan.wall_lines.push_back(std::move(loop));
    }
  }
  std::ranges::move(section.lines, std::back_inserter(plan.wall_lines));
}

}  // namespace

MeshRole role_of(const TriMesh& mesh, double floor_height_m) {
  constexpr double wall_height_m = 2.0, floor_thickness_m = 0.05;
  const MeshExtent e = bounds_of(mesh);
  const Vec3 size = e.upper - e.lower;
  const bool is_high = e.lower.y >= floor_height_m + wall_height_m;
  if (is_high && size.y < std::min(size.x, size.z)) return MeshRole::ceiling;
  if (is_high || size.y > wall_height_m) return MeshRole::wall;
  return e.upper.y < floor_height_m + floor_thickness_m ? MeshRole::floor : MeshRole::furniture;
}

io::RoomPlan plan_of(const SceneSpec& scene) {
  io::RoomPlan plan;
  plan.outline = scene.floor.loops();
  for (const TriMesh& mesh : scene.meshes) {
    const MeshRole role = role_of(mesh, scene.floor.height_m());
    if (role == MeshRole::furniture) add_pieces(mesh, plan.furniture);
    if (role == MeshRole::wall) add_wall(mesh, scene.floor.height_m(), plan);
  }
  for (const SeatSpec& seat : scene.seats)
    plan.seats.push_back({seat.id, floor_point(seat.world_from_seat.origin), heading_of(seat.world_from_seat)});
  for (const EntranceSpec& door : scene.entrances) {
    const auto jamb = [&](double side) {
      return floor_point(door.world_from_entrance * Vec3(0.5 * side * door.width_m, 0.0, 0.0));
    };
    plan.doors.push_back({door.id, jamb(-1.0), jamb(1.0), {}});
  }
  for (const DoorSpec& door : scene.doors) {
    std::vector<Vec2> sweep = DoorLeaf(door, 1.0).sweep();
    plan.doors.push_back({door.id, sweep[0], sweep[1], std::move(sweep)});
  }
  for (const AreaSpec& area : scene.areas)
    plan.areas.push_back({area.id, roomiest_point(area.outline), area.outline.loops()});
  return plan;
}

io::RoomPlan::Marker marker_of(const SensorSpec& sensor) {
  return {sensor.id, floor_point(sensor.world_from_sensor.origin), heading_of(sensor.world_from_sensor)};
}

std::string signs_of_maps(const SceneSpec& scene) {
  const std::string signs =
      "Red triangles are sensors and white ones seats, both pointing the way they face; a name is left out where there "
      "is no room for it, then point at the seat. A green line is a door, dotted lines are furniture, black areas are "
      "walls, the solid line is the floor's edge.";
  return scene.areas.empty() ? signs : signs + " Violet dashes are the borders of named areas.";
}

}  // namespace pirsim::studies
