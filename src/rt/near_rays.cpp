#include "rt/culling.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace pirsim::rt {
namespace {

// Gathering costs some ten times what one look at the gathered rays costs, and each doubling of the margin some more
// rays: a list should last about that long. All four tried by factors of two; none changes a bit of a result.
constexpr float least_margin_m = 0.0125F, greatest_margin_m = 0.4F;
constexpr int short_lived_ticks = 4, long_lived_ticks = 16;
constexpr float jump = 4.0F;  ///< margins: who moved that far was not looked at on the way

constexpr Column RayPacket::*ray_columns[] = {&RayPacket::origin_x,    &RayPacket::origin_y,    &RayPacket::origin_z,
                                              &RayPacket::direction_x, &RayPacket::direction_y, &RayPacket::direction_z,
                                              &RayPacket::range};

struct Grown {
  float margin_m;
  PosedShape operator()(PosedSphere sphere) const noexcept {
    sphere.radius += margin_m;
    return sphere;
  }
  PosedShape operator()(PosedCapsule capsule) const noexcept {
    capsule.radius += margin_m;
    return capsule;
  }
  PosedShape operator()(PosedBox box) const noexcept {
    box.half_extents += margin_m;
    return box;
  }
  PosedShape operator()(const PosedMesh& mesh) const noexcept { return (*this)(box_around(mesh)); }
};

void copy_ray(const RayPacket& from, std::size_t i, RayPacket& to, std::size_t k) noexcept {
  for (const auto column : ray_columns) (to.*column)[k] = (from.*column)[i];
  to.zone[k] = from.zone[i];
  to.ray[k] = from.ray[i];
}

constexpr float infinite = std::numeric_limits<float>::infinity();

struct Displacement {
  float operator()(const PosedSphere& a, const PosedSphere& b) const noexcept {
    return a.radius == b.radius ? glm::distance(a.centre, b.centre) : infinite;
  }
  /// Every point of a capsule is as far between the spheres at its ends as before.
  float operator()(const PosedCapsule& a, const PosedCapsule& b) const noexcept {
    return a.radius == b.radius ? std::max(glm::distance(a.a, b.a), glm::distance(a.b, b.b)) : infinite;
  }
  float operator()(const PosedBox& a, const PosedBox& b) const noexcept {
    if (a.half_extents != b.half_extents) return infinite;
    float moved = glm::distance(a.centre, b.centre);
    for (int i = 0; i < 3; ++i) moved += a.half_extents[i] * glm::distance(a.axes[i], b.axes[i]);
    return moved;
  }
  float operator()(const PosedMesh& a, const PosedMesh& b) const noexcept {
    return a.surface != nullptr && a.surface == b.surface ? (*this)(box_around(a), box_around(b)) : infinite;
  }
  template <typename A, typename B>
  float operator()(const A&, const B&) const noexcept {
    return infinite;
  }
};

}  // namespace

PosedShape grown(const PosedShape& solid, float margin_m) noexcept { return std::visit(Grown{margin_m}, solid); }

float displacement_m(const PosedShape& from, const PosedShape& to) noexcept {
  return std::visit(Displacement{}, from, to);
}

bool NearRays::cover(const PosedShape& solid) noexcept {
  // Written so that a place that is no number is never covered.
  if (!(displacement_m(around_, solid) <= margin_m_)) return false;
  ++n_ticks_;
  return true;
}

PosedShape NearRays::begin(const PosedShape& solid, float slack_m) noexcept {
  const bool has_jumped = !(displacement_m(around_, solid) < jump * margin_m_);
  if (!has_jumped && n_ticks_ < short_lived_ticks) margin_m_ = std::min(2.0F * margin_m_, greatest_margin_m);
  if (!has_jumped && n_ticks_ > long_lived_ticks) margin_m_ = std::max(0.5F * margin_m_, least_margin_m);
  around_ = solid;
  n_ticks_ = 0;
  packets_.clear();
  n_in_last_ = packet_size;
  return grown(solid, margin_m_ + slack_m);
}

void NearRays::add(const RayPacket& packet, unsigned int rays) {
  for (; rays != 0; rays &= rays - 1) {
    if (n_in_last_ == packet_size) {
      packets_.emplace_back();
      n_in_last_ = 0;
    }
    copy_ray(packet, static_cast<std::size_t>(std::countr_zero(rays)), packets_.back(), n_in_last_++);
  }
}

void NearRays::end() noexcept {
  for (; n_in_last_ < packet_size; ++n_in_last_) {
    copy_ray(packets_.back(), 0, packets_.back(), n_in_last_);
    packets_.back().range[n_in_last_] = -1.0F;
  }
}

}  // namespace pirsim::rt
