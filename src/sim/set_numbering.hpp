// Numbers sets of zones in the order in which they come, each once.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/rays.hpp"

namespace pirsim::sim {

class SetNumbering {
 public:
  /// Number 0 is the empty set.
  explicit SetNumbering(std::size_t n_zones) : buckets_(fewest_buckets, 0) { (void)number(ZoneSet(n_zones)); }

  std::uint32_t number(const ZoneSet& set) {
    std::size_t bucket = bucket_of(set);
    if (buckets_[bucket] != 0) return buckets_[bucket] - 1;
    sets_.push_back(set);
    buckets_[bucket] = static_cast<std::uint32_t>(sets_.size());
    if (2 * sets_.size() > buckets_.size()) spread();
    return static_cast<std::uint32_t>(sets_.size() - 1);
  }
  [[nodiscard]] std::vector<ZoneSet>& sets() noexcept { return sets_; }

 private:
  static constexpr std::size_t fewest_buckets = 1024;

  [[nodiscard]] std::size_t bucket_of(const ZoneSet& set) const noexcept {
    ZoneSet::Word hash = 0;
    for (const ZoneSet::Word word : set.words()) {
      hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32U;
    }
    std::size_t bucket = hash % buckets_.size();
    while (buckets_[bucket] != 0 && sets_[buckets_[bucket] - 1] != set) bucket = (bucket + 1) % buckets_.size();
    return bucket;
  }
  void spread() {
    buckets_.assign(2 * buckets_.size(), 0);
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      buckets_[bucket_of(sets_[i])] = static_cast<std::uint32_t>(i + 1);
    }
  }

  std::vector<std::uint32_t> buckets_;  ///< 1 + number, probed one after the other
  std::vector<ZoneSet> sets_;
};

}  // namespace pirsim::sim
