// Rays near each solid (ray_search.hpp), and what is kept of them while it stands still: zones, or what they hit first.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/rays.hpp"
#include "rt/first_hits.hpp"
#include "rt/ray_search.hpp"
#include "rt/tracer.hpp"

namespace pirsim::rt {

class DirectTracer final : public Tracer {
 public:
  explicit DirectTracer(const TracerSetup& setup, const RayKernel& kernel = best_ray_kernel());
  void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) override;
  void follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes) override {
    first_hits_.follow(moved, changes);
  }
  [[nodiscard]] std::vector<SolidId> first_hits() const override { return first_hits_.first_hits(); }
  void turn_leaves(std::span<const LeafStep> steps) override;
  [[nodiscard]] bool may_be_remembered() const noexcept override { return true; }

 private:
  using ZoneParts = std::vector<ZoneSet::Part>;
  struct Person {
    std::vector<FollowedSolid> solids;
    std::vector<ZoneParts> zones;  ///< (n_solids)
  };

  void find_zones(const FollowedSolid& solid, ZoneParts& zones);

  RaySearch search_;
  std::vector<Person> people_;
  FirstHits first_hits_;
  const LeafCuts* cuts_;      ///< null: there are no doors
  std::vector<float> range_;  ///< scratch
};

}  // namespace pirsim::rt
