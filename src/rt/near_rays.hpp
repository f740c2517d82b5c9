// The few rays that a solid can hit before it has moved by more than a margin.
#pragma once

#include <span>
#include <vector>

#include "pirsim/shapes.hpp"
#include "rt/ray_packets.hpp"
#include "rt/view_cones.hpp"

namespace pirsim::rt {

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

}  // namespace pirsim::rt
