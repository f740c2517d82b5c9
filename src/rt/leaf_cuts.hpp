// Where the leaves of doors cut rays.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pirsim/rays.hpp"
#include "schema/door_leaf.hpp"

namespace pirsim::rt {

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

}  // namespace pirsim::rt
