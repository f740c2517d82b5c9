// Embree 3 and 4 under one name. The only place that asks which of them it is.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/rt/room.hpp"
#include "pirsim/shapes.hpp"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace pirsim::rt {

#if RTC_VERSION_MAJOR >= 4

using QueryContext = RTCRayQueryContext;
inline void initialise(QueryContext& context) noexcept { rtcInitRayQueryContext(&context); }

inline void closest_hit(RTCScene scene, QueryContext& context, RTCRayHit& ray) noexcept {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
inline void any_hit(RTCScene scene, QueryContext& context, RTCRay& ray) noexcept {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}

#else

using QueryContext = RTCIntersectContext;
inline void initialise(QueryContext& context) noexcept { rtcInitIntersectContext(&context); }

inline void closest_hit(RTCScene scene, QueryContext& context, RTCRayHit& ray) noexcept {
  rtcIntersect1(scene, &context, &ray);
}
inline void any_hit(RTCScene scene, QueryContext& context, RTCRay& ray) noexcept {
  rtcOccluded1(scene, &context, &ray);
}

#endif

// Embree's objects as owning handles, and its faults as ours.

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

// What is behind a Room, for the tracers and the renderer.

/// One mesh in single precision, as it is traced.
struct RoomMesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Flags of every scene that holds the room's triangles.
inline constexpr RTCSceneFlags room_scene_flags = RTC_SCENE_FLAG_ROBUST;

struct Room::Impl {
  Device device;
  std::vector<RoomMesh> meshes;
  SceneHandle scene;

  /// Adds the room's triangles; mesh i becomes geometry i, each triangle a primitive of it.
  void attach_to(RTCScene target) const;
  [[nodiscard]] std::uint32_t n_meshes() const noexcept { return static_cast<std::uint32_t>(meshes.size()); }
};

/// The ray that a callback was asked about, and how far it reaches.
[[nodiscard]] Ray ray_of(const RTCIntersectFunctionNArguments& arguments) noexcept;
/// Takes the hit if it is nearer than what the query has, or as near and of a lower index: what a query finds
/// doesn't depend on the order in which Embree offers primitives, and in a tie a wall (lower index) hides a solid.
void offer_hit(const RTCIntersectFunctionNArguments& arguments, float distance, const Vec3f& normal) noexcept;

}  // namespace pirsim::rt
