// What whoever runs many runs of one study hands from run to run.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "sim/zone_cache.hpp"

namespace pirsim::sim {

/// As many caches as there were runs at a time. Safe to use from any thread; study and pool outlive what is borrowed.
class ZoneCachePool {
 public:
  explicit ZoneCachePool(const CompiledStudy& study) : study_(study) {}

  /// Comes back, with what it remembers, when the last pointer to it goes.
  [[nodiscard]] std::shared_ptr<ZoneCache> borrow() {
    std::unique_ptr<ZoneCache> cache = take();
    if (!cache) cache = std::make_unique<ZoneCache>(study_);
    return {cache.release(), [this](ZoneCache* used) { put_back(std::unique_ptr<ZoneCache>(used)); }};
  }

 private:
  std::unique_ptr<ZoneCache> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return nullptr;
    std::unique_ptr<ZoneCache> cache = std::move(idle_.back());
    idle_.pop_back();
    return cache;
  }
  void put_back(std::unique_ptr<ZoneCache> cache) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(cache));
  }

  const CompiledStudy& study_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<ZoneCache>> idle_;
};

}  // namespace pirsim::sim
