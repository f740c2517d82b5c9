// Embree's objects as owning handles, and its faults as ours.
#pragma once

#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>

#include "pirsim/shapes.hpp"
#include "rt/embree_compat.hpp"

namespace pirsim::rt {

struct Releaser {
  void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const noexcept { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Releaser>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser>;
using GeometryHandle = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Releaser>;

/// The instruction set that every device is held to, whatever the processor offers: it decides the bits of a hit
/// distance (docs/adr/0002-embree-pinned.md).
inline constexpr std::string_view pinned_instruction_set = "sse4.2";

/// All of these throw Error(internal) when Embree refuses.
[[nodiscard]] Device make_device();
[[nodiscard]] SceneHandle make_scene(RTCDevice device, RTCSceneFlags flags);
[[nodiscard]] GeometryHandle make_geometry(RTCDevice device, RTCGeometryType type);
/// Builds the scene's hierarchy.
void commit(RTCDevice device, RTCScene scene);
/// Throws if Embree has refused something on this thread since the last call; `doing` says what was asked.
void check(RTCDevice device, std::string_view doing);

/// Seen by every ray: set on everything, since the default differs between Embree 3 and 4.
inline constexpr unsigned int everything_mask = 0xFFFFFFFFU;
inline constexpr float unlimited = std::numeric_limits<float>::infinity();

[[nodiscard]] inline RTCRay embree_ray(const Ray& ray, float t_max) noexcept {
  RTCRay result{};
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tfar = t_max;
  result.mask = everything_mask;
  return result;
}
[[nodiscard]] inline Ray pirsim_ray(const RTCRay& ray) noexcept {
  return {Vec3f(ray.org_x, ray.org_y, ray.org_z), Vec3f(ray.dir_x, ray.dir_y, ray.dir_z)};
}
[[nodiscard]] inline RTCRayHit embree_ray_hit(const Ray& ray, float t_max) noexcept {
  RTCRayHit result{};
  result.ray = embree_ray(ray, t_max);
  result.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  result.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return result;
}

}  // namespace pirsim::rt
