// Points, rotations and rigid frames. The world frame is glTF's: right-handed, metres, +Y up, floor in XZ.
// Everything that looks or faces somewhere (sensors, seats, people) does so along its local -Z, with +Y up and
// +X to its right.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace pirsim {

using Vec2 = glm::dvec2;  ///< (x, z) on the floor, metres
using Vec3 = glm::dvec3;  ///< metres, or a unit direction
using Quat = glm::dquat;  ///< unit rotation
using Vec3f = glm::vec3;  ///< single precision: what rays are traced in

/// Rigid motion; `world_from_seat * p_seat` is a point in the world. No scale.
struct Frame {
  Quat rotation{1.0, 0.0, 0.0, 0.0};
  Vec3 origin{0.0};

  [[nodiscard]] Vec3 operator*(const Vec3& point) const { return rotation * point + origin; }
  [[nodiscard]] Frame operator*(const Frame& inner) const {
    return {glm::normalize(rotation * inner.rotation), rotation * inner.origin + origin};
  }
  [[nodiscard]] Vec3 forward() const { return rotation * Vec3(0, 0, -1); }
  [[nodiscard]] Vec3 up() const { return rotation * Vec3(0, 1, 0); }
  [[nodiscard]] Vec3 right() const { return rotation * Vec3(1, 0, 0); }
  bool operator==(const Frame&) const = default;
};

[[nodiscard]] inline Frame inverse(const Frame& a_from_b) {
  const Quat rotation = glm::conjugate(a_from_b.rotation);
  return {rotation, rotation * -a_from_b.origin};
}

/// Heading: radians about +Y, 0 facing -Z, positive turning left (counter-clockwise seen from above).
[[nodiscard]] inline Quat rotation_from_heading(double heading) { return glm::angleAxis(heading, Vec3(0, 1, 0)); }
[[nodiscard]] inline double heading_of(const Vec2& direction_xz) {
  return std::atan2(-direction_xz.x, -direction_xz.y);
}
[[nodiscard]] inline double heading_of(const Frame& frame) {
  const Vec3 forward = frame.forward();
  return heading_of(Vec2(forward.x, forward.z));
}
/// Unit (x, z) of a heading.
[[nodiscard]] inline Vec2 direction_of(double heading) { return {-std::sin(heading), -std::cos(heading)}; }

[[nodiscard]] inline Vec2 floor_point(const Vec3& p) { return {p.x, p.z}; }

}  // namespace pirsim
