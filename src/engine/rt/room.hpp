// The static part of a scene as an Embree ray scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "pirsim/geometry.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::rt {

struct RoomHit {
  float distance = 0.0F;   ///< metres along the ray
  Vec3f normal{0.0F};      ///< unit, facing the ray's origin
  std::uint32_t mesh = 0;  ///< index into the meshes given to the Room
};

/// Walls, table and furniture. Immutable and safe to share between threads.
class Room {
 public:
  /// Throws Error(internal) when Embree refuses. An empty list is a room without walls.
  explicit Room(std::span<const TriMesh> meshes);
  ~Room();
  Room(Room&&) noexcept;
  Room& operator=(Room&&) noexcept;

  [[nodiscard]] std::size_t n_meshes() const noexcept;
  [[nodiscard]] std::optional<RoomHit> first_hit(const Ray& ray, float t_max) const noexcept;
  /// Cuts every ray's range at the first thing in its way.
  void clip(RayBundle& bundle) const noexcept;

  struct Impl;
  [[nodiscard]] const Impl& impl() const noexcept { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// "3.13.5" and "sse4.2" (what Embree is held to, docs/adr/0002-embree-pinned.md), for manifests and --version.
[[nodiscard]] std::string embree_version();
[[nodiscard]] std::string instruction_set();

}  // namespace pirsim::rt
