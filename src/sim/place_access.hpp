// From where one person gets onto what there is to sit or lie on.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "pirsim/scene.hpp"
#include "rt/room.hpp"
#include "sim/compiled_study.hpp"
#include "sim/grounds.hpp"

namespace pirsim::sim {

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
  /// that is deeper than a chair, from where the pelvis slides back; up to a metre behind it; up to a metre beside it.
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

}  // namespace pirsim::sim
