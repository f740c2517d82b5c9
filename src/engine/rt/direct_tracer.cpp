#include "engine/rt/direct_tracer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include "engine/rt/tracer.hpp"

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

FirstHits::FirstHits(std::size_t n_rays, RaySearch& search)
    : search_(search), chains_(n_rays, none), is_shared_(n_rays, 0), first_(n_rays), is_touched_(n_rays, 0) {}

void FirstHits::follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes) {
  for (const auto& [index, solids, surfaces] : moved) {
    if (people_.size() <= index) people_.resize(index + 1);
    Person& person = people_[index];
    for (std::size_t i = solids.size(); i < person.lanes.size(); ++i) forget(person.lanes[i]);
    search_.follow(solids, person.solids);
    person.lanes.resize(solids.size());
    person.surfaces.assign(surfaces.begin(), surfaces.end());
    for (const std::uint32_t i : search_.gathered()) {
      Lanes& lanes = person.lanes[i];
      forget(lanes);
      const std::size_t n = person.solids[i].near.packets().size();
      lanes.hits.assign(n, 0);
      lanes.hits_before.resize(n);
      lanes.distances.resize(n * packet_size);
      lanes.nodes.resize(n * packet_size);
    }
    for (const std::uint32_t i : search_.moved()) {
      move({static_cast<std::uint16_t>(index), static_cast<std::uint16_t>(i)});
    }
  }
  changes.clear();
  for (const std::uint32_t ray : touched_) {
    is_touched_[ray] = 0;
    const SolidId first = is_shared_[ray] != 0 ? first_of(chains_[ray]) : nodes_[chains_[ray]].solid;
    if (first != first_[ray]) changes.push_back({ray, std::exchange(first_[ray], first), first});
  }
  touched_.clear();
}

void FirstHits::move(SolidId id) {
  Lanes& lanes = people_[id.person].lanes[id.solid];
  const FollowedSolid& followed = people_[id.person].solids[id.solid];
  std::swap(lanes.hits, lanes.hits_before);
  search_.enter(followed, lanes.hits, lanes.distances);
  const std::span<const RayPacket> packets = followed.near.packets();
  for (std::size_t k = 0; k < packets.size(); ++k) {
    const unsigned int now = lanes.hits[k], before = lanes.hits_before[k];
    const auto lane_of = [k](unsigned int bits) {
      return static_cast<std::uint32_t>(k * packet_size) + static_cast<std::uint32_t>(std::countr_zero(bits));
    };
    for (unsigned int gone = before & ~now; gone != 0; gone &= gone - 1) remove(lanes.nodes[lane_of(gone)]);
    for (unsigned int stay = now & before; stay != 0; stay &= stay - 1) {
      const std::uint32_t ray = packets[k].ray[std::countr_zero(stay)];
      if (is_shared_[ray] != 0) look_again(ray);
    }
    for (unsigned int come = now & ~before; come != 0; come &= come - 1) {
      insert(packets[k].ray[std::countr_zero(come)], id, lane_of(come), lanes);
    }
  }
}

void FirstHits::forget(Lanes& lanes) {
  for (std::size_t k = 0; k < lanes.hits.size(); ++k) {
    for (unsigned int hits = lanes.hits[k]; hits != 0; hits &= hits - 1) {
      remove(lanes.nodes[k * packet_size + static_cast<std::size_t>(std::countr_zero(hits))]);
    }
    lanes.hits[k] = 0;
  }
}

void FirstHits::insert(std::uint32_t ray, SolidId solid, std::uint32_t lane, Lanes& lanes) {
  if (unused_.empty()) {
    unused_.push_back(static_cast<std::uint32_t>(nodes_.size()));
    nodes_.emplace_back();
  }
  const std::uint32_t node = unused_.back();
  unused_.pop_back();
  nodes_[node] = {ray, chains_[ray], solid, people_[solid.person].surfaces[solid.solid], lane & 0xFFFFFFU};
  chains_[ray] = node;
  lanes.nodes[lane] = node;
  touch(ray);
}

void FirstHits::remove(std::uint32_t node) {
  const std::uint32_t ray = nodes_[node].ray;
  std::uint32_t* link = &chains_[ray];
  while (*link != node) link = &nodes_[*link].next;
  *link = nodes_[node].next;
  unused_.push_back(node);
  touch(ray);
}

void FirstHits::touch(std::uint32_t ray) {
  bool is_shared = false;
  const Node& first = nodes_[chains_[ray]];
  for (std::uint32_t other = first.next; other != none && !is_shared; other = nodes_[other].next) {
    is_shared = nodes_[other].solid.person != first.solid.person || nodes_[other].surface != first.surface;
  }
  is_shared_[ray] = is_shared ? 1 : 0;
  look_again(ray);
}

void FirstHits::look_again(std::uint32_t ray) {
  if (std::exchange(is_touched_[ray], std::uint8_t{1}) == 0) touched_.push_back(ray);
}

std::vector<SolidId> FirstHits::first_hits() const {
  std::vector<SolidId> first;
  for (const std::uint32_t chain : chains_) first.push_back(first_of(chain));
  return first;
}

SolidId FirstHits::first_of(std::uint32_t chain) const noexcept {
  const Node* first = &nodes_[chain];
  if (first->next == none) return first->solid;
  float nearest = distance(*first);
  for (std::uint32_t other = first->next; other != none; other = nodes_[other].next) {
    const float reach = distance(nodes_[other]);
    if (reach > nearest || (reach == nearest && nodes_[other].solid > first->solid)) continue;
    nearest = reach;
    first = &nodes_[other];
  }
  return first->solid;
}

DirectTracer::DirectTracer(const TracerSetup& setup, const RayKernel& kernel)
    : search_(*setup.clipped, kernel), first_hits_(setup.clipped->rays.size(), search_), cuts_(setup.cuts) {
  if (cuts_ != nullptr) turn_leaves(rest_steps(cuts_->leaves()));
}

void DirectTracer::add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) {
  if (people_.size() <= person) people_.resize(person + 1);
  Person& seen = people_[person];
  search_.follow(solids, seen.solids);
  constexpr std::size_t usual_parts = 32;  // room for them; more is allocated when it is needed
  while (seen.zones.size() < solids.size()) seen.zones.emplace_back().reserve(usual_parts);
  for (const std::uint32_t i : search_.moved()) find_zones(seen.solids[i], seen.zones[i]);
  for (std::size_t i = 0; i < solids.size(); ++i) zones.add(seen.zones[i]);
}

void DirectTracer::turn_leaves(std::span<const LeafStep> steps) {
  cuts_->cut(steps, range_);
  search_.set_ranges(range_);
  for (Person& person : people_) person.solids.clear();
}

void DirectTracer::find_zones(const FollowedSolid& solid, ZoneParts& zones) {
  zones.clear();
  const std::span<const PacketHits> found = search_.hits(solid);
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (unsigned int hits = found[k]; hits != 0; hits &= hits - 1) {
      const std::uint32_t zone = solid.near.packets()[k].zone[std::countr_zero(hits)];
      const std::size_t at = zone / ZoneSet::bits_per_word;
      if (zones.empty() || zones.back().at != at) zones.push_back({at, 0});
      zones.back().word |= ZoneSet::Word{1} << (zone % ZoneSet::bits_per_word);
    }
  }
}

std::unique_ptr<Tracer> make_direct_tracer(const TracerSetup& setup) { return std::make_unique<DirectTracer>(setup); }

}  // namespace pirsim::rt
