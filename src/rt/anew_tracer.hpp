// What the slow tracers have in common: they keep where everybody is, and look at all of it at each call.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "rt/tracer.hpp"

namespace pirsim::rt {

class AnewTracer : public Tracer {
 public:
  explicit AnewTracer(std::size_t n_rays) : first_(n_rays), now_(n_rays) {}

  void follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes) final {
    for (const auto& [person, solids, surfaces] : moved) {
      if (people_.size() <= person) people_.resize(person + 1);
      people_[person].assign(solids.begin(), solids.end());
    }
    solids_.clear();
    ids_.clear();
    for (std::size_t person = 0; person < people_.size(); ++person) {
      for (std::size_t i = 0; i < people_[person].size(); ++i) {
        solids_.push_back(people_[person][i]);
        ids_.push_back({static_cast<std::uint16_t>(person), static_cast<std::uint16_t>(i)});
      }
    }
    now_.assign(now_.size(), no_solid);
    find_first(solids_, hits_);
    for (const auto& [ray, solid] : hits_) now_[ray] = ids_[solid];
    changes.clear();
    for (std::uint32_t ray = 0; ray < now_.size(); ++ray) {
      if (now_[ray] != first_[ray]) changes.push_back({ray, first_[ray], now_[ray]});
    }
    std::swap(first_, now_);
  }
  [[nodiscard]] std::vector<SolidId> first_hits() const final { return first_; }

 protected:
  /// A ray, and the index of the solid that it hits before all others and the room.
  struct FirstHit {
    std::uint32_t ray = 0;
    std::uint32_t solid = 0;
  };
  /// One entry a ray that hits a solid within its range; `hits` is overwritten.
  virtual void find_first(std::span<const PosedShape> solids, std::vector<FirstHit>& hits) = 0;

 private:
  std::vector<std::vector<PosedShape>> people_;
  std::vector<PosedShape> solids_;  ///< of all of them
  std::vector<SolidId> ids_;        ///< (n_solids)
  std::vector<FirstHit> hits_;
  std::vector<SolidId> first_, now_;  ///< (n_rays)
};

}  // namespace pirsim::rt
