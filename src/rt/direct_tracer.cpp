#include "rt/direct_tracer.hpp"

#include <bit>

namespace pirsim::rt {

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
