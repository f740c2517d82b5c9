#include "rt/leaf_cuts.hpp"

#include <algorithm>

namespace pirsim::rt {

LeafCuts::LeafCuts(const RayBundle& clipped, const std::vector<DoorLeaf>& leaves)
    : clipped_(&clipped), leaves_(&leaves) {
  for (const DoorLeaf& leaf : leaves) {
    Door& door = doors_.emplace_back();
    PosedBox swept = leaf.swept();
    swept.half_extents += 1e-3F;  // metres; far more than the ray tests' rounding
    for (std::uint32_t ray = 0; ray < clipped.rays.size(); ++ray) {
      if (entry_distance(clipped.rays[ray], swept, clipped.range[ray])) door.near.push_back(ray);
    }
    door.shut = cuts_by(leaf.at(0), door.near);
    door.open = cuts_by(leaf.at(leaf.open_step()), door.near);
  }
}

std::vector<LeafCuts::Cut> LeafCuts::cuts_by(const PosedBox& leaf, const std::vector<std::uint32_t>& near) const {
  std::vector<Cut> cuts;
  for (const std::uint32_t ray : near) {
    if (const auto distance = entry_distance(clipped_->rays[ray], leaf, clipped_->range[ray]))
      cuts.emplace_back(ray, *distance);
  }
  return cuts;
}

void LeafCuts::cut(std::span<const LeafStep> steps, std::vector<float>& range) const {
  range = clipped_->range;
  const auto shorten = [&](const std::vector<Cut>& cuts) {
    for (const auto& [ray, distance] : cuts) range[ray] = std::min(range[ray], distance);
  };
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    const DoorLeaf& leaf = (*leaves_)[i];
    if (leaf.rests(steps[i])) {
      shorten(steps[i] == 0 ? doors_[i].shut : doors_[i].open);
    } else {
      shorten(cuts_by(leaf.at(steps[i]), doors_[i].near));
    }
  }
}

}  // namespace pirsim::rt
