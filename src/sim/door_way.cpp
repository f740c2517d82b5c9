// How a pedestrian comes up to doors: they wait before what a leaf sweeps until it is open.
#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "sim/pedestrian.hpp"

namespace pirsim::sim {
namespace {

constexpr double look_ahead_m = 1.2;  ///< as for others
constexpr double step_m = 0.05;
constexpr double unlimited_m = std::numeric_limits<double>::infinity();
constexpr double at_leaf_m =
    0.35;  ///< assumed: who is within the sweep already stops so far before the leaf (0.3-0.45)

}  // namespace

Pedestrian::WayToDoor Pedestrian::way_to_door(const DoorsSeen& doors, std::size_t door) const {
  const DoorLeaf& leaf = doors.leaves[door];
  const LeafStep step = doors.steps[door];
  const double farthest_m = look_ahead_m + leaf.reach_m() + Doors::hold_m;
  if (glm::distance(motion_.position(), leaf.threshold()) > farthest_m + leaf.reach_m())
    return {unlimited_m, std::nullopt};
  bool is_outside = false, was_outside = false, leads_through = false;
  double enters_m = farthest_m, through_m = farthest_m;
  Vec2 here = route_->position(walked_m_);
  for (double ahead_m = 0.0; ahead_m < farthest_m && !leads_through; ahead_m += step_m) {
    is_outside = leaf.distance_to_sweep_m(here) >= Doors::hold_m;
    if (is_outside && enters_m < farthest_m) break;  // past it
    if (!is_outside && was_outside) enters_m = std::min(enters_m, ahead_m - step_m);
    was_outside = was_outside || is_outside;
    const Vec2 next = route_->position(walked_m_ + ahead_m + step_m);
    leads_through = leaf.leads_through(here, next);
    if (leads_through) through_m = ahead_m;
    here = next;
  }
  const std::optional<double> through = leads_through ? std::optional(through_m) : std::nullopt;
  if (step == leaf.open_step()) return {unlimited_m, through};
  if (enters_m < farthest_m) return {leads_through || step != 0 ? enters_m : unlimited_m, through};
  return {leads_through ? through_m - at_leaf_m : unlimited_m, through};
}

double Pedestrian::free_way_to_doors(const DoorsSeen& doors) {
  double free_m = unlimited_m, nearest_m = unlimited_m;
  if (!route_) return free_m;
  for (std::size_t i = 0; i < doors.leaves.size(); ++i) {
    const WayToDoor way = way_to_door(doors, i);
    free_m = std::min(free_m, way.free_m);
    if (way.through_m.value_or(nearest_m) >= nearest_m) continue;
    nearest_m = *way.through_m;
    wanted_door_ = i;
  }
  return free_m;
}

}  // namespace pirsim::sim
