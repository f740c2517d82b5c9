#include "model/schema/door_leaf.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace pirsim {
namespace {

double to_segment_m(const Vec2& p, const Vec2& end) noexcept {
  const double along = std::clamp(glm::dot(p, end) / glm::dot(end, end), 0.0, 1.0);
  return glm::distance(p, along * end);
}

}  // namespace

DoorLeaf::DoorLeaf(const DoorSpec& door, double tick_s) : door_(door) {
  constexpr double most_steps = 60000.0;
  open_step_ = static_cast<LeafStep>(std::clamp(std::round(door.turn_s / tick_s), 1.0, most_steps));
  if (door.state == DoorState::open) rest_step_ = open_step_;
  // Walkers ask for distances at every step of their way.
  const double to_end = door.hinge == DoorHinge::left ? 1.0 : -1.0,
               to_side = door.opens == DoorOpens::inward ? -1.0 : 1.0;
  const auto on_floor = [&](const Vec3& local) { return floor_point(door.world_from_door * local); };
  hinge_ = on_floor({-0.5 * to_end * door.width_m, 0.0, 0.0});
  along_ = on_floor({to_end, 0.0, 0.0}) - threshold();
  inward_ = on_floor({0.0, 0.0, to_side}) - threshold();
  open_end_ = door.width_m * Vec2(std::cos(angle(open_step_)), std::sin(angle(open_step_)));
}

double DoorLeaf::angle(LeafStep step) const noexcept { return radians(door_.open_deg) * step / open_step_; }

Frame DoorLeaf::frame_at(LeafStep step) const noexcept { return frame_turned(angle(step)); }

Frame DoorLeaf::frame_turned(double open) const noexcept {
  const double from_hinge = door_.hinge == DoorHinge::left ? 1.0 : -1.0;
  const double inward = door_.opens == DoorOpens::inward ? 1.0 : -1.0;
  const Vec3 hinge(-0.5 * from_hinge * door_.width_m, 0.0, 0.0);
  const Quat turn = rotation_from_heading(from_hinge * inward * open);
  const Vec3 centre = hinge + turn * Vec3(0.5 * from_hinge * door_.width_m, 0.5 * door_.height_m, 0.0);
  return door_.world_from_door * Frame{turn, centre};
}

std::vector<Vec2> DoorLeaf::sweep() const {
  constexpr double step_deg = 7.5;
  const double to_end = door_.hinge == DoorHinge::left ? 0.5 : -0.5;
  const auto at = [&](double open_deg, double end) {
    return floor_point(frame_turned(radians(open_deg)) * Vec3(end * door_.width_m, 0.0, 0.0));
  };
  std::vector<Vec2> line{at(0.0, -to_end)};
  for (double open_deg = 0.0; open_deg < door_.open_deg; open_deg += step_deg) line.push_back(at(open_deg, to_end));
  line.push_back(at(door_.open_deg, to_end));
  return line;
}

PosedBox DoorLeaf::swept() const noexcept {
  const double side = door_.hinge == DoorHinge::left ? -0.5 : 0.5, reach = door_.width_m + door_.thickness_m;
  const Frame hinge{{1, 0, 0, 0}, {side * door_.width_m, 0.5 * door_.height_m, 0.0}};
  return std::get<PosedBox>(
      place(Box{{reach, 0.5 * door_.height_m + door_.thickness_m, reach}}, door_.world_from_door * hinge));
}

TriMesh DoorLeaf::open_mesh() const {
  TriMesh mesh;
  mesh.name = "leaf of door '" + door_.id + "'";
  const Frame frame = frame_at(open_step_);
  const Vec3 half = box().half_extents;
  for (const double x : {-half.x, half.x}) {
    for (const double y : {-half.y, half.y}) {
      for (const double z : {-half.z, half.z}) mesh.positions.push_back(frame * Vec3(x, y, z));
    }
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

Vec2 DoorLeaf::from_hinge(const Vec2& point) const noexcept {
  return {glm::dot(point - hinge_, along_), glm::dot(point - hinge_, inward_)};
}

double DoorLeaf::distance_to_sweep_m(const Vec2& point) const noexcept {
  const Vec2 p = from_hinge(point);
  const bool is_within = p.y >= 0.0 && p.x * open_end_.y >= p.y * open_end_.x;  // between shut and open
  if (is_within) return std::max(0.0, glm::length(p) - door_.width_m);
  const double to_edges_m = std::min(to_segment_m(p, {door_.width_m, 0.0}), to_segment_m(p, open_end_));
  return std::max(0.0, to_edges_m - 0.5 * door_.thickness_m);
}

bool DoorLeaf::on_one_side(const Vec2& a, const Vec2& b) const noexcept {
  return (from_hinge(a).y < 0.0) == (from_hinge(b).y < 0.0);
}

bool DoorLeaf::leads_through(const Vec2& a, const Vec2& b) const noexcept {
  const Vec2 p = from_hinge(a), q = from_hinge(b);
  if ((p.y < 0.0) == (q.y < 0.0)) return false;
  const double along = p.x + (q.x - p.x) * p.y / (p.y - q.y);
  return along >= 0.0 && along <= door_.width_m;
}

std::vector<DoorLeaf> leaves_of(const SceneSpec& scene, double tick_s) {
  std::vector<DoorLeaf> leaves;
  for (const DoorSpec& door : scene.doors) leaves.emplace_back(door, tick_s);
  return leaves;
}

std::vector<LeafStep> rest_steps(const std::vector<DoorLeaf>& leaves) {
  std::vector<LeafStep> steps;
  for (const DoorLeaf& leaf : leaves) steps.push_back(leaf.rest_step());
  return steps;
}

}  // namespace pirsim
