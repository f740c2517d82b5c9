// What is behind a Room, for the tracers and the renderer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pirsim/rt/room.hpp"
#include "rt/device.hpp"

namespace pirsim::rt {

/// One mesh in single precision, as Embree gets it.
struct RoomMesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Flags and quality of every scene that holds the room's triangles: the same everywhere, so that a ray's first hit
/// has the same bits everywhere.
inline constexpr RTCSceneFlags room_scene_flags = RTC_SCENE_FLAG_ROBUST;

struct Room::Impl {
  Device device;
  std::vector<RoomMesh> meshes;
  SceneHandle scene;

  /// Adds the room's triangles; mesh i becomes geometry i.
  void attach_to(RTCScene target) const;
  [[nodiscard]] std::uint32_t n_meshes() const noexcept { return static_cast<std::uint32_t>(meshes.size()); }
};

}  // namespace pirsim::rt
