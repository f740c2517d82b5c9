// What is the same for all who rehearse among the same solids.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/body/ground.hpp"
#include "engine/body/skeleton.hpp"
#include "engine/rt/room.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/study/study_in_force.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::sim {

class Grounds {
 public:
  explicit Grounds(const SceneSpec& scene) : scene_(scene) {}

  std::map<std::pair<double, std::string>, bool> open_doors;  ///< does one lead to the floor? By clearance and name
  std::map<std::array<double, 3>, bool> open_places;          ///< can one get there? By clearance and place

  struct Near {
    double away_m = std::numeric_limits<double>::infinity();
    std::uint32_t mesh = 0;
  };
  /// The solid thing that is nearest to the place, of those that walkers go round.
  [[nodiscard]] Near nearest_solid(const Vec2& place) {
    const double floor_y = scene_.floor.height_m();
    if (!solids_) solids_ = body::footprints(scene_.meshes, floor_y + body::solid_from_m, floor_y + body::solid_to_m);
    Near nearest;
    for (const body::Footprint& solid : *solids_) {
      if (body::distance_bound(place, place, solid) >= nearest.away_m) continue;
      if (const double away_m = body::distance(place, solid); away_m < nearest.away_m) nearest = {away_m, solid.mesh};
    }
    return nearest;
  }

 private:
  const SceneSpec& scene_;
  std::optional<std::vector<body::Footprint>> solids_;
};

// From where one person gets onto what there is to sit or lie on.

/// Height of the table top in front of a seat, or none: what lies under a point half an arm's length ahead.
[[nodiscard]] std::optional<double> table_height(const SeatSpec& seat, double floor_y, const rt::Room& room);

/// Looks for places to stand. Refers to all that it is made from.
class PlaceAccess {
 public:
  using CanGoTo = std::function<bool(const Vec2&)>;  ///< from where the person is
  PlaceAccess(const SceneSpec& scene, const rt::Room& room, const PersonModel& person, Grounds& grounds,
              CanGoTo can_go_to)
      : scene_(scene), room_(room), person_(person), grounds_(grounds), can_go_to_(std::move(can_go_to)) {}

  /// As near to the free fall into the seat as the furniture allows. In this order: right before it; before furniture
  /// that is deeper than a chair, from where the pelvis slides back; up to a metre behind it; up to a metre beside it;
  /// before furniture that is deeper than thighs are long, with the pelvis nearer to the edge than the seat's point.
  [[nodiscard]] std::optional<SeatPlan> plan_of(const SeatSpec& seat) const;
  /// Of a seat of a fit height, over the floor, without a plan.
  [[nodiscard]] std::string why_no_place(const SeatSpec& seat) const;
  static constexpr const char* no_place =
      "no path leads to a free place to stand right before it, or up to a metre behind or beside it";

  /// From the side whose edge is nearer, or from the foot, if somebody stands there whose calves touch the edge.
  [[nodiscard]] std::optional<LyingPlan> plan_to_lie(const PlaceSpec& place) const;
  /// Of a place to lie without a plan.
  [[nodiscard]] std::string why_no_edge(const PlaceSpec& place) const;

 private:
  [[nodiscard]] body::SeatPlace edge_of(const PlaceSpec& place, double heading, double out_m) const;
  [[nodiscard]] bool find_place_before(const Frame& seat, SeatPlan& plan) const;
  [[nodiscard]] bool find_place_behind(const Frame& seat, SeatPlan& plan, double farthest_m) const;
  [[nodiscard]] bool is_open_before(const Frame& seat, double ahead_m) const;
  [[nodiscard]] bool has_room_behind(const Frame& seat, const Vec2& facing, double back_m, double half_depth_m) const;

  const SceneSpec& scene_;
  const rt::Room& room_;
  const PersonModel& person_;
  Grounds& grounds_;
  CanGoTo can_go_to_;
};

// Resolves what the people of a script do against the scene, and finds out whether they can do it. People walk through
// their actions in thought, one after the other, each as if alone in the room.

/// Throws Error(input) with every unknown name and impossible order at once, then Error(infeasible) for the first
/// places that can't be reached. study: all but its trials; trials: with all effects, which may have added people at
/// the end. Who is larger than the script says gets through where the person of the script does, turning sideways if
/// need be. like: a study whose floors are shared where they are the same, or null.
[[nodiscard]] std::vector<TrialModel> plan_people(const CompiledStudy& study, const std::vector<TrialInForce>& trials,
                                                  const CompiledStudy* like);

// Where people stand who come in through an entrance.

/// Where they stop who only come in.
[[nodiscard]] inline Vec2 inside_of(const EntranceSpec& door, const body::Humanoid& humanoid) {
  return floor_point(door.world_from_entrance * Vec3(0, 0, -2.0 * humanoid.clearance_radius_m()));
}

// What can be said about a script's actions without moving anybody.

/// Throws Error(input) with all faults: unknown seats and entrances (with the nearest name), actions before the
/// person is there, work without a seat, times that run backwards.
void check_actions(const SceneSpec& scene, const std::vector<TrialInForce>& trials);

// What two studies have in common, decided from what their specs say, not from how they came to differ.

/// Whether two scenes have the same surfaces: rays end alike in both.
[[nodiscard]] bool same_meshes(const SceneSpec& a, const SceneSpec& b);
/// Whether two scenes have the same floor, entrances and solid meshes: one can walk alike in both.
[[nodiscard]] bool same_ground(const SceneSpec& a, const SceneSpec& b);
/// Would the people of `like` be planned and move the same in `study`, whose trials with all effects these are?
[[nodiscard]] bool same_people(const CompiledStudy& like, const CompiledStudy& study,
                               const std::vector<TrialInForce>& trials);

}  // namespace pirsim::sim
