// What each ray hits first of people who move, followed from one posture to the next.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt/ray_search.hpp"
#include "rt/tracer.hpp"

namespace pirsim::rt {

/// Keeps of every ray all solids that it hits. As a part moves, most of its rays stay on it and hit nothing else: of
/// them nothing is to be done.
class FirstHits {
 public:
  FirstHits(std::size_t n_rays, RaySearch& search);

  /// As Tracer::follow().
  void follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes);
  [[nodiscard]] std::vector<SolidId> first_hits() const;

 private:
  /// A solid that a ray hits; `next` leads to another.
  struct Node {
    std::uint32_t ray = 0;
    std::uint32_t next = 0;
    SolidId solid;
    std::uint32_t surface : 8 = 0;
    std::uint32_t lane : 24 = 0;  ///< in the solid's arrays
  };
  static constexpr std::uint32_t none = 0;  ///< no node: the first is never used

  /// The rays near a solid, packet by packet.
  struct Lanes {
    std::vector<PacketHits> hits, hits_before;
    std::vector<float> distances;      ///< (n_packets x packet_size) metres, of rays that hit
    std::vector<std::uint32_t> nodes;  ///< (n_packets x packet_size) of rays that hit
  };
  struct Person {
    std::vector<FollowedSolid> solids;
    std::vector<Lanes> lanes;  ///< (n_solids)
    std::vector<std::uint8_t> surfaces;
  };

  void move(SolidId id);
  void forget(Lanes& lanes);
  void insert(std::uint32_t ray, SolidId solid, std::uint32_t lane, Lanes& lanes);
  void remove(std::uint32_t node);
  /// Another set of solids is on the ray.
  void touch(std::uint32_t ray);
  void look_again(std::uint32_t ray);
  [[nodiscard]] float distance(const Node& node) const noexcept {
    return people_[node.solid.person].lanes[node.solid.solid].distances[node.lane];
  }
  [[nodiscard]] SolidId first_of(std::uint32_t chain) const noexcept;

  RaySearch& search_;
  std::vector<Person> people_;
  std::vector<std::uint32_t> chains_;    ///< (n_rays) nodes
  std::vector<std::uint8_t> is_shared_;  ///< (n_rays) 1: it hits several surfaces
  std::vector<SolidId> first_;           ///< (n_rays) of the surface that each ray hits first
  std::vector<Node> nodes_{1};
  std::vector<std::uint32_t> unused_;     ///< nodes
  std::vector<std::uint32_t> touched_;    ///< rays whose first hit may have changed
  std::vector<std::uint8_t> is_touched_;  ///< (n_rays)
};

}  // namespace pirsim::rt
