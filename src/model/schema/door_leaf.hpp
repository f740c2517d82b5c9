// The leaf of a door: where it is at each step of its turn, and what of the floor it sweeps.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim {

/// A leaf turns evenly, a step a tick: 0 is shut.
using LeafStep = std::uint16_t;

class DoorLeaf {
 public:
  DoorLeaf(const DoorSpec& door, double tick_s);

  [[nodiscard]] LeafStep open_step() const noexcept { return open_step_; }
  [[nodiscard]] LeafStep rest_step() const noexcept { return rest_step_; }  ///< as the door stands before a run
  [[nodiscard]] bool rests(LeafStep step) const noexcept { return step == 0 || step == open_step_; }
  /// The leaf itself, a box in its own frame, and where that is.
  [[nodiscard]] Box box() const noexcept { return {0.5 * Vec3(door_.width_m, door_.height_m, door_.thickness_m)}; }
  [[nodiscard]] Frame frame_at(LeafStep step) const noexcept;
  [[nodiscard]] PosedBox at(LeafStep step) const noexcept { return std::get<PosedBox>(place(box(), frame_at(step))); }
  /// A box around all of these.
  [[nodiscard]] PosedBox swept() const noexcept;
  /// The open leaf as walkers see it, called as the door is.
  [[nodiscard]] TriMesh open_mesh() const;

  /// What it sweeps, seen from above, a closed polygon: the hinge, then the end of the leaf from shut to open.
  [[nodiscard]] std::vector<Vec2> sweep() const;

  [[nodiscard]] Vec2 threshold() const noexcept { return floor_point(door_.world_from_door.origin); }
  /// No part of the leaf is ever farther from the threshold's middle.
  [[nodiscard]] double reach_m() const noexcept { return 1.5 * door_.width_m + door_.thickness_m; }
  /// Between a point of the floor and what the leaf sweeps; 0 inside.
  [[nodiscard]] double distance_to_sweep_m(const Vec2& point) const noexcept;
  /// Both before the wall in which the door is, or both behind it.
  [[nodiscard]] bool on_one_side(const Vec2& a, const Vec2& b) const noexcept;
  /// Does the straight way from a to b lead through the opening?
  [[nodiscard]] bool leads_through(const Vec2& a, const Vec2& b) const noexcept;

 private:
  [[nodiscard]] double angle(LeafStep step) const noexcept;
  /// Its own frame, turned about the hinge; open: radians.
  [[nodiscard]] Frame frame_turned(double open) const noexcept;
  /// From the hinge: along the shut leaf, and to the side to which it opens.
  [[nodiscard]] Vec2 from_hinge(const Vec2& point) const noexcept;

  DoorSpec door_;
  Vec2 hinge_{0.0}, along_{0.0}, inward_{0.0};  ///< on the floor; directions of the shut leaf and of its first way
  Vec2 open_end_{0.0};                          ///< of the leaf, from the hinge
  LeafStep open_step_ = 1, rest_step_ = 0;
};

/// (n_doors)
[[nodiscard]] std::vector<DoorLeaf> leaves_of(const SceneSpec& scene, double tick_s);
/// (n_doors) as they stand before a run.
[[nodiscard]] std::vector<LeafStep> rest_steps(const std::vector<DoorLeaf>& leaves);

}  // namespace pirsim
