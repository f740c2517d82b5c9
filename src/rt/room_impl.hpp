// What is behind a Room, for the tracers and the renderer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rt/device.hpp"
#include "rt/room.hpp"

namespace pirsim::rt {

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
