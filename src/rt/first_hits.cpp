#include "rt/first_hits.hpp"

#include <bit>
#include <utility>

namespace pirsim::rt {

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

}  // namespace pirsim::rt
