#include "rt/ray_search.hpp"

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <numeric>
#include <type_traits>

namespace pirsim::rt {
namespace {

/// By bytes, so that 0 and -0 count as different and no number as itself.
bool is_same(const PosedShape& a, const PosedShape& b) noexcept {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&b](const auto& solid) {
        using Solid = std::remove_cvref_t<decltype(solid)>;
        static_assert(std::is_trivially_copyable_v<Solid>);
        return std::memcmp(&solid, std::get_if<Solid>(&b), sizeof solid) == 0;
      },
      a);
}

/// For solids that have no test of many rays at a time. distances: (packet_size), or null.
PacketHits enter_one_by_one(const RayPacket& packet, const PosedShape& solid, float* distances) noexcept {
  unsigned int hits = 0;
  for (unsigned int i = 0; i < packet_size; ++i) {
    const Ray ray{Vec3f(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]),
                  Vec3f(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i])};
    const auto distance = entry_distance(ray, solid, packet.range[i]);
    if (!distance) continue;
    hits |= 1U << i;
    if (distances != nullptr) distances[i] = *distance;
  }
  return static_cast<PacketHits>(hits);
}

}  // namespace

RaySearch::RaySearch(const RayBundle& clipped, const RayKernel& kernel)
    : kernel_(kernel),
      packets_(packet_of_rays(clipped)),
      cones_(cones_around(packets_)),
      all_(packets_.size()),
      near_person_(packets_.size()),
      near_solid_(packets_.size()),
      hits_(packets_.size()) {
  std::iota(all_.begin(), all_.end(), 0U);
  for (const Ray& ray : clipped.rays) farthest_m_ = std::max(farthest_m_, glm::length(ray.origin));
  near_person_cones_.reserve(cones_.size());
}

void RaySearch::set_ranges(std::span<const float> range) noexcept {
  for (RayPacket& packet : packets_) {
    for (std::size_t i = 0; i < packet_size; ++i) {
      const bool is_missing = packet.range[i] < 0.0F;
      if (!is_missing) packet.range[i] = range[packet.ray[i]];
    }
  }
}

void RaySearch::follow(std::span<const PosedShape> solids, std::vector<FollowedSolid>& followed) {
  followed.resize(solids.size());
  moved_.clear();
  left_.clear();
  for (std::size_t i = 0; i < solids.size(); ++i) {
    FollowedSolid& one = followed[i];
    if (one.solid && is_same(*one.solid, solids[i])) continue;
    one.solid = solids[i];
    moved_.push_back(static_cast<std::uint32_t>(i));
    if (!one.near.cover(solids[i])) left_.push_back(static_cast<std::uint32_t>(i));
  }
  if (!left_.empty()) gather(solids, followed);
}

/// A millimetre, and far above single precision's rounding wherever the ray starts.
float RaySearch::slack_m(const PosedShape& solid) const noexcept {
  const BoundingSphere sphere = bounding_sphere(solid);
  return 1e-3F + 1e-5F * (farthest_m_ + glm::length(sphere.centre) + sphere.radius);
}

void RaySearch::gather(std::span<const PosedShape> solids, std::vector<FollowedSolid>& followed) {
  grown_.clear();
  spheres_.clear();
  for (const std::uint32_t i : left_) {
    grown_.push_back(followed[i].near.begin(solids[i], slack_m(solids[i])));
    spheres_.push_back(bounding_sphere(grown_.back()));
  }
  const std::size_t n = kernel_.cull(cones_.data(), cones_.size(), bounding_sphere(spheres_), near_person_.data());
  pick(cones_, near_person_.data(), n, near_person_cones_);
  for (std::size_t k = 0; k < left_.size(); ++k) gather_one(grown_[k], spheres_[k], followed[left_[k]].near);
}

void RaySearch::gather_one(const PosedShape& grown, const BoundingSphere& sphere, NearRays& near) {
  const std::size_t n = kernel_.cull(near_person_cones_.data(), near_person_cones_.size(), sphere, near_solid_.data());
  for (std::size_t k = 0; k < n; ++k) near_solid_[k] = near_person_[near_solid_[k]];
  intersect(grown, sphere, packets_, {near_solid_.data(), n});
  for (std::size_t k = 0; k < n; ++k) near.add(packets_[near_solid_[k]], hits_[k]);
  near.end();
}

void RaySearch::intersect(const PosedShape& solid, const BoundingSphere& around, std::span<const RayPacket> packets,
                          std::span<const std::uint32_t> picked) noexcept {
  const auto n = picked.size();
  if (const auto* sphere = std::get_if<PosedSphere>(&solid)) {
    kernel_.intersect_sphere(packets.data(), picked.data(), n, *sphere, around, hits_.data());
  } else if (const auto* capsule = std::get_if<PosedCapsule>(&solid)) {
    kernel_.intersect_capsule(packets.data(), picked.data(), n, *capsule, around, hits_.data());
  } else if (const auto* box = std::get_if<PosedBox>(&solid)) {
    kernel_.intersect_box(packets.data(), picked.data(), n, *box, around, hits_.data());
  } else {
    for (std::size_t k = 0; k < n; ++k) hits_[k] = enter_one_by_one(packets[picked[k]], solid, nullptr);
  }
}

std::span<const PacketHits> RaySearch::hits(const FollowedSolid& followed) {
  const std::span<const RayPacket> packets = followed.near.packets();
  if (packets.empty()) return {};
  intersect(*followed.solid, bounding_sphere(*followed.solid), packets, {all_.data(), packets.size()});
  return {hits_.data(), packets.size()};
}

void RaySearch::enter(const FollowedSolid& followed, std::span<PacketHits> hits, std::span<float> distances) const {
  const std::span<const RayPacket> packets = followed.near.packets();
  const std::size_t n = packets.size();
  if (n == 0) return;
  const PosedShape& solid = *followed.solid;
  const BoundingSphere around = bounding_sphere(solid);
  if (const auto* sphere = std::get_if<PosedSphere>(&solid)) {
    kernel_.enter_sphere(packets.data(), all_.data(), n, *sphere, around, hits.data(), distances.data());
  } else if (const auto* capsule = std::get_if<PosedCapsule>(&solid)) {
    kernel_.enter_capsule(packets.data(), all_.data(), n, *capsule, around, hits.data(), distances.data());
  } else if (const auto* box = std::get_if<PosedBox>(&solid)) {
    kernel_.enter_box(packets.data(), all_.data(), n, *box, around, hits.data(), distances.data());
  } else {
    for (std::size_t k = 0; k < n; ++k) {
      hits[k] = enter_one_by_one(packets[k], solid, distances.data() + k * packet_size);
    }
  }
}

}  // namespace pirsim::rt
