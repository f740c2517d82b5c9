// How a pedestrian comes up to doors: they wait before what a leaf sweeps until it is open.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "sim/pedestrian.hpp"

namespace pirsim::sim {
namespace {

constexpr double look_ahead_m = 1.2;  ///< as for others
constexpr double way_step_m = 0.05;
constexpr double unlimited_m = std::numeric_limits<double>::infinity();

}  // namespace

/// Whoever stands nearer than the usual already comes no nearer; who stands in the way of the leaf doesn't set out.
Pedestrian::WayToDoor Pedestrian::way_to_door(const DoorsSeen& doors, std::size_t door) const {
  const DoorLeaf& leaf = doors.leaves[door];
  const LeafStep step = doors.steps[door];
  const double farthest_m = look_ahead_m + leaf.reach_m() + Doors::hold_m;
  const bool is_always_open = leaf.rest_step() == leaf.open_step();
  if (is_always_open || glm::distance(motion_.position(), leaf.threshold()) > farthest_m + leaf.reach_m())
    return {unlimited_m, std::nullopt};
  constexpr double rounding_m = 1e-3;
  const double away_m = leaf.distance_to_sweep_m(motion_.position());
  const double keep_m = std::min(Doors::hold_m, away_m - rounding_m);
  bool leads_through = false;
  double enters_m = farthest_m, through_m = farthest_m;
  Vec2 here = route_->position(walked_m_);
  const double end_m = std::min(farthest_m, route_->length_m() - walked_m_ + way_step_m);
  for (double ahead_m = 0.0; ahead_m < end_m && !leads_through; ahead_m += way_step_m) {
    const double off_m = leaf.distance_to_sweep_m(here);
    const bool is_outside = off_m >= keep_m;
    if (is_outside && enters_m < farthest_m) break;  // past it
    if (off_m > keep_m + 2.0 * way_step_m) {         // comes no nearer than this on a way so long
      ahead_m += way_step_m * (std::floor((off_m - keep_m) / way_step_m) - 1.0);
      here = route_->position(walked_m_ + ahead_m + way_step_m);
      continue;
    }
    if (!is_outside) enters_m = std::min(enters_m, std::max(0.0, ahead_m - way_step_m));
    const Vec2 next = route_->position(walked_m_ + ahead_m + way_step_m);
    leads_through = leaf.leads_through(here, next);
    if (leads_through) through_m = ahead_m;
    here = next;
  }
  const std::optional<double> through = leads_through ? std::optional(through_m) : std::nullopt;
  if (step == leaf.open_step()) return {unlimited_m, through};
  if (away_m < Doors::clear_m) return {leads_through ? 0.0 : unlimited_m, through};
  return {enters_m < farthest_m && (leads_through || step != 0) ? enters_m : unlimited_m, through};
}

/// They want the door that they go through next; once it is open, one behind it that stops them before they are
/// through, as a front door beside that of the bathroom does.
double Pedestrian::free_way_to_doors(const DoorsSeen& doors) {
  double free_m = unlimited_m, nearest_m = unlimited_m, stops_m = unlimited_m;
  if (!route_) return free_m;
  std::optional<std::size_t> stopping;
  for (std::size_t i = 0; i < doors.leaves.size(); ++i) {
    const WayToDoor way = way_to_door(doors, i);
    free_m = std::min(free_m, way.free_m);
    if (!way.through_m) continue;
    if (way.free_m < stops_m) stops_m = way.free_m, stopping = i;
    if (*way.through_m < nearest_m) nearest_m = *way.through_m, wanted_door_ = i;
  }
  if (!stopping || stops_m >= nearest_m) return free_m;
  if (doors.steps[*wanted_door_] == doors.leaves[*wanted_door_].open_step()) wanted_door_ = stopping;
  return free_m;
}

}  // namespace pirsim::sim
