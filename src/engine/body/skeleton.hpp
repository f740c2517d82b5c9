// The thirteen solids of the humanoid (Stefansson et al. 2021, section 2.2: one sphere, three boxes, nine
// capsules), a posture of them, and how warm their surfaces are.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <optional>
#include <string_view>

#include "pirsim/geometry.hpp"
#include "pirsim/script.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::body {

inline constexpr Vec3 x_axis(1, 0, 0), y_axis(0, 1, 0), z_axis(0, 0, 1);

enum class Part : std::size_t {
  pelvis,  ///< capsule, lying from hip to hip
  torso,   ///< box: abdomen and thorax
  head,    ///< sphere
  left_upper_arm,
  right_upper_arm,  ///< capsules
  left_forearm,
  right_forearm,  ///< capsules: forearm and loosely closed hand
  left_thigh,
  right_thigh,  ///< capsules
  left_shank,
  right_shank,  ///< capsules
  left_foot,
  right_foot,  ///< boxes
};
inline constexpr std::size_t n_parts = 13;
/// The index of a part in an array that has an element a part.
[[nodiscard]] constexpr std::size_t at(Part part) noexcept { return static_cast<std::size_t>(part); }
/// "left_upper_arm" and so on, as glTF node names and messages use it.
[[nodiscard]] std::string_view name(Part part) noexcept;

/// world_from_part for every part, indexed by Part. A capsule's axis is its part's local Y.
using Posture = std::array<Frame, n_parts>;
/// The solids of one person, indexed by Part, in their part's frame.
using Solids = std::array<Shape, n_parts>;

/// Degrees Celsius, indexed by Part: of skin, of hair and clothing between skin and room, or of both where a part has
/// both. Derivation: docs/physics/analog.md. Ref: [Mehnert2000, ISO7730].
[[nodiscard]] std::array<double, n_parts> surface_temperatures_c(const WarmthSpec& warmth, double ambient_c);

// A person's fixed measures: segment lengths and the thirteen solids.

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

/// Of a cat or a dog, metres (animal.cpp).
struct AnimalMeasures {
  double axis_height_m = 0.0;  ///< of the trunk's middle, standing
  double half_trunk_m = 0.0;   ///< from its middle to where the round ends begin
  double trunk_radius_m = 0.0, head_radius_m = 0.0, leg_radius_m = 0.0;
  double leg_m = 0.0;  ///< stretched
  bool operator==(const AnimalMeasures&) const = default;
};
[[nodiscard]] AnimalMeasures measures_of(const PetSpec& pet);
/// Each is called as the part of a person that corresponds to it: forelegs are arms.
[[nodiscard]] Solids solids_of(const AnimalMeasures& animal);
/// Of a pet's coat, all over.
[[nodiscard]] double coat_c(double ambient_c) noexcept;

class Humanoid {
 public:
  /// Throws Error(usage) for a mesh of a part that there is not.
  explicit Humanoid(const PersonSpec& person);
  /// A pet has an animal's solids and postures; what else is asked of it is that of somebody as high.
  explicit Humanoid(const PetSpec& pet);
  [[nodiscard]] const Measures& measures() const noexcept { return measures_; }
  [[nodiscard]] const std::optional<AnimalMeasures>& animal() const noexcept { return animal_; }
  /// What rays are traced against: the primitives, or the person's meshes where there are any.
  [[nodiscard]] const Solids& solids() const noexcept { return solids_; }
  /// Spheres, capsules and boxes only: what kinematics reckons with, whatever the person looks like.
  [[nodiscard]] const Solids& primitives() const noexcept { return primitives_; }
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
  std::optional<AnimalMeasures> animal_;
  Solids primitives_;
  Solids solids_;
  double clearance_radius_m_ = 0.0;
  double walking_speed_m_s_ = 1.0;
};

// The joint tree: from a few quantities that decide a posture to the thirteen parts.

/// The circle on which the middle joint can lie: centre, radius (0 where the bones are stretched or folded).
struct ElbowCircle {
  Vec3 centre{0.0};
  Vec3 axis{0.0};  ///< unit, root to end
  double radius = 0.0;
};
[[nodiscard]] inline ElbowCircle elbow_circle(const Vec3& root, const Vec3& end, double upper, double lower) noexcept {
  const Vec3 way = end - root;
  const double distance = std::max(glm::length(way), 1e-9);
  const Vec3 axis = way / distance;
  const double reach = std::clamp(distance, std::abs(upper - lower) + 1e-9, upper + lower);
  const double along = (upper * upper - lower * lower + reach * reach) / (2.0 * reach);
  return {root + along * axis, axis, std::sqrt(std::max(0.0, upper * upper - along * along))};
}

/// The middle joint, bent towards `pole` (a direction that isn't parallel to root-end).
[[nodiscard]] inline Vec3 two_bone_joint(const Vec3& root, const Vec3& end, double upper, double lower,
                                         const Vec3& pole) noexcept {
  const ElbowCircle circle = elbow_circle(root, end, upper, lower);
  return circle.centre + circle.radius * glm::normalize(pole - glm::dot(pole, circle.axis) * circle.axis);
}

/// Rotation whose Y is `up` and whose X is as near to `right` as that allows. Both are unit vectors.
[[nodiscard]] Quat rotation_of(const Vec3& right, const Vec3& up);

/// Shoulder (ball) and elbow (hinge). The upper arm's frame has its origin in the shoulder and its Y towards it from
/// the elbow; the elbow bends about X, positive forward.
struct ArmPose {
  Quat torso_from_upper_arm{1.0, 0.0, 0.0, 0.0};
  double elbow_flexion = 0.0;  ///< radians
};

/// Arrays are left, right.
struct Pose {
  Frame world_from_hips;                  ///< upright unless one lies; origin midway between the hip joints
  double spine_tilt = 0.0;                ///< radians about the hips' axis, positive forward
  double spine_lean = 0.0;                ///< radians, positive to the right
  double head_turn = 0.0;                 ///< radians about the neck, positive to the left
  double chest_m = 0.0;                   ///< by which breath has moved the torso's solid forward; no joint moves
  std::array<Frame, 2> world_from_ankle;  ///< origin in the ankle joint, facing as the foot does
  std::array<ArmPose, 2> arms;
};

/// Forward kinematics for spine, head and arms, two-bone inverse kinematics for the legs (knees forward).
[[nodiscard]] Posture posture_of(const Humanoid& humanoid, const Pose& pose) noexcept;

/// Of the torso in the hips' frame.
[[nodiscard]] Quat torso_rotation(const Pose& pose) noexcept;
/// Frame of the torso with its origin midway between the hips.
[[nodiscard]] Frame world_from_torso(const Pose& pose) noexcept;
/// The neck's axis, behind the head's centre.
[[nodiscard]] double neck_behind_m(const Measures& measures) noexcept;
/// The direction along X of the left side, 0, or the right side, 1.
[[nodiscard]] constexpr double sign_of(std::size_t side) noexcept { return side == 0 ? -1.0 : 1.0; }
/// The shoulder joint in the torso's frame.
[[nodiscard]] Vec3 shoulder(const Measures& measures, std::size_t side) noexcept;
/// The arm whose elbow and hand are at these points of the torso's frame; bone lengths win over the hand's place.
[[nodiscard]] ArmPose arm_through(const Vec3& shoulder, const Vec3& elbow, const Vec3& hand) noexcept;
[[nodiscard]] ArmPose blend(const ArmPose& a, const ArmPose& b, double weight_of_b) noexcept;

}  // namespace pirsim::body
