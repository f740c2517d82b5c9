// Which rays are worth testing against a solid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/rt/room.hpp"
#include "model/schema/door_leaf.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::rt {

// Which groups of rays can't hit any solid? A cone around each group's rays against a sphere around each solid.

/// BoundingSphere around a solid.
struct BoundingSphere {
  Vec3f centre{0.0F};
  float radius = 0.0F;
};
[[nodiscard]] BoundingSphere bounding_sphere(const PosedShape& shape) noexcept;
/// BoundingSphere around spheres; at least one.
[[nodiscard]] BoundingSphere bounding_sphere(std::span<const BoundingSphere> spheres) noexcept;

/// All points that rays from `apex` within `half_angle` of `axis` reach up to `length` metres.
struct ViewCone {
  Vec3f apex{0.0F};
  Vec3f axis{0.0F, 0.0F, -1.0F};
  float cosine = -1.0F;  ///< of the half-angle
  float sine = 0.0F;
  float length = 0.0F;
};

/// Around rays that start in one point; range: (n of `rays`).
[[nodiscard]] ViewCone cone_around(std::span<const Ray> rays, std::span<const float> range);
/// One cone a cluster (n_clusters) or a zone (n_zones). A group whose rays don't share one origin gets a cone that
/// touches everything.
[[nodiscard]] std::vector<ViewCone> cluster_cones(const RayBundle& bundle);
[[nodiscard]] std::vector<ViewCone> zone_cones(const RayBundle& bundle);

/// False only if no ray of the cone can hit anything inside the sphere, or inside any of them; true may be wrong.
[[nodiscard]] bool may_touch(const ViewCone& cone, const BoundingSphere& sphere) noexcept;
[[nodiscard]] bool may_touch_any(const ViewCone& cone, std::span<const BoundingSphere> spheres) noexcept;

// The rays of a bundle in packets of sixteen that lie close together, and a cone around each packet; both laid out in
// columns for the ray kernels.

inline constexpr std::size_t packet_size = 16;
using Column = float[packet_size];

/// Rays that are missing to a full packet have a negative range and hit nothing.
struct alignas(64) RayPacket {
  Column origin_x, origin_y, origin_z;
  Column direction_x, direction_y, direction_z;
  Column range;
  std::uint32_t zone[packet_size];  ///< that the ray belongs to
  std::uint32_t ray[packet_size];   ///< its index in the bundle
};

/// Cones, sixteen at a time; nothing touches those that are missing to a full block.
struct alignas(64) ConeBlock {
  Column apex_x, apex_y, apex_z;
  Column axis_x, axis_y, axis_z;
  Column cosine, sine, length;
};

/// Sorts each sensor's rays by direction into packets.
[[nodiscard]] std::vector<RayPacket> packet_of_rays(const RayBundle& bundle);
/// Cone i, counted through the blocks, is around packet i.
[[nodiscard]] std::vector<ConeBlock> cones_around(const std::vector<RayPacket>& packets);
/// Picks cones by their indices; `picked` is overwritten and has room for them.
void pick(const std::vector<ConeBlock>& cones, const std::uint32_t* indices, std::size_t n,
          std::vector<ConeBlock>& picked);

// The few rays that a solid can hit before it has moved by more than a margin.

/// The solid with all that is within `margin_m` of it: of a box, more at its edges; of a mesh, of the box around it.
[[nodiscard]] PosedShape grown(const PosedShape& solid, float margin_m) noexcept;

/// At least as far as any point of the solid has moved between the two; infinite for solids that aren't the same.
[[nodiscard]] float displacement_m(const PosedShape& from, const PosedShape& to) noexcept;

/// Rays that pass a solid closely, in packets. As long as the solid stays within the margin it can hit no other ray: a
/// part that moves at most v can't reach a ray at distance d before d / v.
class NearRays {
 public:
  /// Room for so many packets, so that gathering allocates nothing.
  explicit NearRays(std::size_t n_packets) { packets_.reserve(n_packets); }

  /// Are these all rays that the solid can hit where it is now?
  [[nodiscard]] bool cover(const PosedShape& solid) noexcept;
  /// Forgets the rays. Those that hit the returned solid are to be added; slack_m: what rounding may be worth.
  [[nodiscard]] PosedShape begin(const PosedShape& solid, float slack_m) noexcept;
  /// rays: bit i for the packet's ray i.
  void add(const RayPacket& packet, unsigned int rays);
  void end() noexcept;
  [[nodiscard]] std::span<const RayPacket> packets() const noexcept { return packets_; }

 private:
  PosedShape around_ = PosedMesh{};  ///< the solid when the rays were gathered
  float margin_m_ = 0.05F;           ///< how far it may move from there
  int n_ticks_ = 0;                  ///< for how long these rays have sufficed
  std::vector<RayPacket> packets_;
  std::size_t n_in_last_ = packet_size;  ///< rays of the last packet
};

// Where the leaves of doors cut rays.

/// Of one bundle of rays, cut at the room, which it outlives. Where leaves that rest cut them is worked out once; a
/// leaf that moves is asked about anew, of the rays that pass it at all. Immutable, shared by threads.
class LeafCuts {
 public:
  LeafCuts(const RayBundle& clipped, const std::vector<DoorLeaf>& leaves);

  [[nodiscard]] const std::vector<DoorLeaf>& leaves() const noexcept { return *leaves_; }
  /// steps: (n_doors); range: overwritten, (n_rays).
  void cut(std::span<const LeafStep> steps, std::vector<float>& range) const;

 private:
  using Cut = std::pair<std::uint32_t, float>;  ///< a ray, and how far it goes
  struct Door {
    std::vector<std::uint32_t> near;  ///< rays that the leaf may cut
    std::vector<Cut> shut, open;
  };
  [[nodiscard]] std::vector<Cut> cuts_by(const PosedBox& leaf, const std::vector<std::uint32_t>& near) const;

  const RayBundle* clipped_;
  const std::vector<DoorLeaf>* leaves_;
  std::vector<Door> doors_;  ///< (n_doors)
};

// Which zones see a person at this tick, and what does each ray hit first? Several tracers answer, all with the same
// bits.

[[nodiscard]] std::string_view name(TracerKind kind) noexcept;

/// A person and one of their solids.
struct SolidId {
  std::uint16_t person = 0xFFFFU;
  std::uint16_t solid = 0xFFFFU;
  auto operator<=>(const SolidId&) const = default;
};
inline constexpr SolidId no_solid{};

/// A person's solids as they are from now on. None: they are gone.
struct Moved {
  std::size_t person = 0;
  std::span<const PosedShape> solids;
  /// (n_solids) those of equal number are as one: which of them a ray hits makes no difference. A solid keeps its
  /// number until it is gone.
  std::span<const std::uint8_t> surfaces;
};

/// A ray of the bundle, and what it hit and hits before all other solids and the room.
struct FirstHitChange {
  std::uint32_t ray = 0;
  SolidId before, after;
};

/// Scratch memory of one thread; not shared.
class Tracer {
 public:
  virtual ~Tracer() = default;
  /// Adds the zones that see one person of several; what is kept from tick to tick is kept by `person`. solids:
  /// surfaces of meshes outlive the tracer.
  virtual void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) = 0;
  /// Takes people to where they are now, each at most once; who isn't named stays as they are. Tells of which rays that
  /// changes the surface that they hit first, in any order: where a ray enters two solids at once, the lower person and
  /// index. What changes within a surface may be told or not. changes: overwritten. Nobody is there at first.
  virtual void follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes) = 0;
  /// (n_rays) what each ray hits first since then, or no_solid.
  [[nodiscard]] virtual std::vector<SolidId> first_hits() const = 0;
  /// From now on the leaves of doors stand so; at first as before a run. steps: (n_doors). Nobody is followed then:
  /// take them away first.
  virtual void turn_leaves(std::span<const LeafStep> steps) = 0;
  /// May whoever asks remember the answers? The slow tracers are there to be compared with: they look at every tick.
  [[nodiscard]] virtual bool may_be_remembered() const noexcept { return false; }
};

/// What a tracer works on; all of it outlives the tracer.
struct TracerSetup {
  const Room* room = nullptr;
  const RayBundle* rated = nullptr;    ///< ranges as rated
  const RayBundle* clipped = nullptr;  ///< the same rays cut at the room
  const LeafCuts* cuts = nullptr;      ///< of `clipped`; null: there are no doors
};
/// "avx512f", "avx2" or "baseline": what the direct tracer uses on this processor. Changes no bit.
[[nodiscard]] std::string_view direct_instruction_set() noexcept;
[[nodiscard]] std::unique_ptr<Tracer> make_tracer(TracerKind kind, const TracerSetup& setup);

// The tracers' makers.

[[nodiscard]] std::unique_ptr<Tracer> make_reference_tracer(const TracerSetup& setup);
[[nodiscard]] std::unique_ptr<Tracer> make_embree_tracer(const TracerSetup& setup);
[[nodiscard]] std::unique_ptr<Tracer> make_direct_tracer(const TracerSetup& setup);

}  // namespace pirsim::rt
