#include "rt/direct_tracer.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/geometric.hpp>
#include <numeric>
#include <type_traits>

#include "rt/device.hpp"

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

/// For solids that have no test of many rays at a time.
PacketHits enter_one_by_one(const RayPacket& packet, const PosedShape& solid, float* distances) noexcept {
  unsigned int hits = 0;
  for (unsigned int i = 0; i < packet_size; ++i) {
    const Ray ray{Vec3f(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]),
                  Vec3f(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i])};
    const auto distance = entry_distance(ray, solid, packet.range[i]);
    if (!distance) continue;
    hits |= 1U << i;
    distances[i] = *distance;
  }
  return static_cast<PacketHits>(hits);
}

}  // namespace

DirectTracer::DirectTracer(const TracerSetup& setup, const RayKernel& kernel)
    : kernel_(kernel),
      n_words_(ZoneSet(setup.clipped->n_zones()).words().size()),
      packets_(packet_of_rays(*setup.clipped)),
      cones_(cones_around(packets_)),
      near_person_(packets_.size()),
      near_solid_(packets_.size()),
      hits_(packets_.size()),
      all_(packets_.size()),
      distances_(packets_.size() * packet_size),
      nearest_(setup.clipped->rays.size(), unlimited),
      first_hit_(setup.clipped->rays.size()) {
  std::iota(all_.begin(), all_.end(), 0U);
  for (const Ray& ray : setup.clipped->rays) farthest_m_ = std::max(farthest_m_, glm::length(ray.origin));
  near_person_cones_.reserve(cones_.size());
}

void DirectTracer::find_moved(std::span<const PosedShape> solids, Memory& memory) {
  memory.slots.resize(solids.size());
  moved_.clear();
  left_.clear();
  for (std::size_t i = 0; i < solids.size(); ++i) {
    Slot& slot = memory.slots[i];
    if (slot.solid && is_same(*slot.solid, solids[i])) continue;
    slot.solid = solids[i];
    moved_.push_back(static_cast<std::uint32_t>(i));
    if (!slot.near.cover(solids[i])) left_.push_back(static_cast<std::uint32_t>(i));
  }
}

void DirectTracer::add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) {
  if (people_.size() <= person) people_.resize(person + 1);
  Memory& memory = people_[person];
  find_moved(solids, memory);
  memory.hits.resize(solids.size() * n_words_);
  if (!left_.empty()) gather(solids, memory);
  for (const std::uint32_t i : moved_) find_zones(solids[i], memory.slots[i].near, &memory.hits[i * n_words_]);
  for (std::size_t i = 0; i < solids.size(); ++i) zones.add({&memory.hits[i * n_words_], n_words_});
}

/// A millimetre, and far above single precision's rounding wherever the ray starts.
float DirectTracer::slack_m(const PosedShape& solid) const noexcept {
  const BoundingSphere sphere = bounding_sphere(solid);
  return 1e-3F + 1e-5F * (farthest_m_ + glm::length(sphere.centre) + sphere.radius);
}

void DirectTracer::gather(std::span<const PosedShape> solids, Memory& memory) {
  grown_.clear();
  spheres_.clear();
  for (const std::uint32_t i : left_) {
    grown_.push_back(memory.slots[i].near.begin(solids[i], slack_m(solids[i])));
    spheres_.push_back(bounding_sphere(grown_.back()));
  }
  const std::size_t n = kernel_.cull(cones_.data(), cones_.size(), bounding_sphere(spheres_), near_person_.data());
  pick(cones_, near_person_.data(), n, near_person_cones_);
  for (std::size_t k = 0; k < left_.size(); ++k) {
    gather_one(grown_[k], spheres_[k], memory.slots[left_[k]].near);
  }
}

void DirectTracer::gather_one(const PosedShape& grown, const BoundingSphere& sphere, NearRays& near) {
  const std::size_t n = kernel_.cull(near_person_cones_.data(), near_person_cones_.size(), sphere, near_solid_.data());
  for (std::size_t k = 0; k < n; ++k) near_solid_[k] = near_person_[near_solid_[k]];
  intersect(grown, sphere, packets_, {near_solid_.data(), n});
  for (std::size_t k = 0; k < n; ++k) near.add(packets_[near_solid_[k]], hits_[k]);
  near.end();
}

void DirectTracer::find_zones(const PosedShape& solid, const NearRays& near, ZoneSet::Word* zones) {
  std::fill_n(zones, n_words_, ZoneSet::Word{0});
  const std::span<const RayPacket> packets = near.packets();
  if (packets.empty()) return;
  intersect(solid, bounding_sphere(solid), packets, {all_.data(), packets.size()});
  for (std::size_t k = 0; k < packets.size(); ++k) {
    for (unsigned int hits = hits_[k]; hits != 0; hits &= hits - 1) {
      const std::uint32_t zone = packets[k].zone[std::countr_zero(hits)];
      zones[zone / ZoneSet::bits_per_word] |= ZoneSet::Word{1} << (zone % ZoneSet::bits_per_word);
    }
  }
}

void DirectTracer::intersect(const PosedShape& solid, const BoundingSphere& around, std::span<const RayPacket> packets,
                             std::span<const std::uint32_t> picked) noexcept {
  const auto n = picked.size();
  if (const auto* sphere = std::get_if<PosedSphere>(&solid)) {
    kernel_.intersect_sphere(packets.data(), picked.data(), n, *sphere, around, hits_.data());
  } else if (const auto* capsule = std::get_if<PosedCapsule>(&solid)) {
    kernel_.intersect_capsule(packets.data(), picked.data(), n, *capsule, around, hits_.data());
  } else if (const auto* box = std::get_if<PosedBox>(&solid)) {
    kernel_.intersect_box(packets.data(), picked.data(), n, *box, around, hits_.data());
  } else {
    for (std::size_t k = 0; k < n; ++k) hits_[k] = enter_one_by_one(packets[picked[k]], solid, distances_.data());
  }
}

void DirectTracer::enter(const PosedShape& solid, const NearRays& near, std::vector<Entry>& entries) {
  entries.clear();
  const std::span<const RayPacket> packets = near.packets();
  if (packets.empty()) return;
  const BoundingSphere around = bounding_sphere(solid);
  const std::size_t n = packets.size();
  float* const distances = distances_.data();
  if (const auto* sphere = std::get_if<PosedSphere>(&solid)) {
    kernel_.enter_sphere(packets.data(), all_.data(), n, *sphere, around, hits_.data(), distances);
  } else if (const auto* capsule = std::get_if<PosedCapsule>(&solid)) {
    kernel_.enter_capsule(packets.data(), all_.data(), n, *capsule, around, hits_.data(), distances);
  } else if (const auto* box = std::get_if<PosedBox>(&solid)) {
    kernel_.enter_box(packets.data(), all_.data(), n, *box, around, hits_.data(), distances);
  } else {
    for (std::size_t k = 0; k < n; ++k) hits_[k] = enter_one_by_one(packets[k], solid, distances + k * packet_size);
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (unsigned int hits = hits_[k]; hits != 0; hits &= hits - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(hits));
      entries.push_back({packets[k].ray[i], distances[k * packet_size + i]});
    }
  }
}

void DirectTracer::find_first(std::span<const PosedShape> solids, std::vector<FirstHit>& hits) {
  find_moved(solids, everybody_);
  if (entries_.size() < solids.size()) entries_.resize(solids.size());
  if (!left_.empty()) gather(solids, everybody_);
  for (const std::uint32_t i : moved_) enter(solids[i], everybody_.slots[i].near, entries_[i]);
  hit_rays_.clear();
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    for (const auto& [ray, distance] : entries_[i]) {
      if (distance >= nearest_[ray]) continue;  // in a tie the lower index stays
      if (nearest_[ray] == unlimited) hit_rays_.push_back(ray);
      nearest_[ray] = distance;
      first_hit_[ray] = i;
    }
  }
  hits.clear();
  for (const std::uint32_t ray : hit_rays_) {
    hits.push_back({ray, first_hit_[ray]});
    nearest_[ray] = unlimited;
  }
}

std::unique_ptr<Tracer> make_direct_tracer(const TracerSetup& setup) { return std::make_unique<DirectTracer>(setup); }

}  // namespace pirsim::rt
