// A person's fixed measures: segment lengths, masses, joint limits and the thirteen solids.
#pragma once

#include <array>

#include "body/body_part.hpp"
#include "pirsim/script.hpp"

namespace pirsim::body {

/// Of the person whose widths and movements the sources give; those of others are scaled from theirs.
inline constexpr double reference_stature_m = 1.86;

/// Lengths in metres as fractions of stature. Ref: [DrillisContini1966].
struct Measures {
  double stature_m = 0.0;
  double hip_height_m = 0.0;       ///< 0.530 H, standing
  double knee_height_m = 0.0;      ///< 0.285 H
  double ankle_height_m = 0.0;     ///< 0.039 H
  double thigh_m = 0.0;            ///< hip to knee, 0.245 H
  double shank_m = 0.0;            ///< knee to ankle, 0.246 H
  double foot_length_m = 0.0;      ///< 0.152 H
  double shoulder_height_m = 0.0;  ///< 0.818 H, standing
  double shoulder_width_m = 0.0;   ///< between the shoulder joints: 0.259 H less the soft parts
  double hip_width_m = 0.0;        ///< between the hip joints: 0.191 H less the soft parts
  double upper_arm_m = 0.0;        ///< 0.186 H
  double forearm_m = 0.0;          ///< elbow to knuckles of a loosely closed hand
  double head_height_m = 0.0;      ///< 0.130 H
  double heel_m = 0.0;             ///< ankle joint to the back of the heel
  bool operator==(const Measures&) const = default;
};

class Humanoid {
 public:
  /// Throws Error(usage) for a mesh of a part that there is not.
  explicit Humanoid(const PersonSpec& person);
  [[nodiscard]] const Measures& measures() const noexcept { return measures_; }
  /// What rays are traced against: the primitives, or the person's meshes where there are any.
  [[nodiscard]] const Solids& solids() const noexcept { return solids_; }
  /// Spheres, capsules and boxes only: what kinematics reckons with, whatever the person looks like.
  [[nodiscard]] const Solids& primitives() const noexcept { return primitives_; }
  /// Ref: [Plagenhoef1983]; sums to the person's mass.
  [[nodiscard]] const std::array<double, n_parts>& masses_kg() const noexcept { return masses_kg_; }
  /// Radius of the vertical cylinder that a walking person keeps clear of obstacles, metres.
  [[nodiscard]] double clearance_radius_m() const noexcept { return clearance_radius_m_; }
  /// From a standing person's middle to the front and to the back: what they keep clear of where there is less room
  /// than for the cylinder, between a table and a wall. The feet reach farther, under the table.
  [[nodiscard]] double half_depth_m() const noexcept;
  /// From a standing person's middle to the side of the trunk: what they keep clear of in narrow places, with their
  /// arms drawn in.
  [[nodiscard]] double half_width_m() const noexcept;
  /// From a standing person's middle to the farthest point of the trunk, whichever way they face.
  [[nodiscard]] double trunk_radius_m() const noexcept;
  /// From the hip joints to the base of the neck.
  [[nodiscard]] double trunk_height_m() const noexcept;
  [[nodiscard]] double walking_speed_m_s() const noexcept { return walking_speed_m_s_; }
  /// Of a part that is a sphere or a capsule.
  [[nodiscard]] double radius_m(Part part) const noexcept;
  bool operator==(const Humanoid&) const = default;

 private:
  Measures measures_;
  Solids primitives_;
  Solids solids_;
  std::array<double, n_parts> masses_kg_{};
  double clearance_radius_m_ = 0.0;
  double walking_speed_m_s_ = 1.0;
};

}  // namespace pirsim::body
