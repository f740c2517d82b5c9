// What all sensors see of all people at a tick, with the memory that makes it fast.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "pirsim/rays.hpp"
#include "rt/tracer.hpp"
#include "sim/actor.hpp"
#include "sim/compiled_study.hpp"
#include "sim/posture_memory.hpp"
#include "sim/power_meter.hpp"
#include "sim/solids.hpp"

namespace pirsim::sim {

/// Belongs to one thread at a time and to one study; what it has seen before changes no result.
class ZoneCache {
 public:
  explicit ZoneCache(const CompiledStudy& study);
  /// exposure: of the study's array, overwritten.
  void look(const std::vector<Actor>& actors, Exposure& exposure);

 private:
  void look_at_each(const std::vector<Actor>& actors, Exposure& exposure);
  void look_at_all(const std::vector<Actor>& actors, ZoneSet& zones);
  std::span<const ZoneSet::Word> row_of(std::size_t person, const Actor& actor);

  const SensorArray& array_;
  TracerKind kind_;
  std::unique_ptr<rt::Tracer> tracer_;
  PostureMemory memory_;
  std::unique_ptr<PowerMeter> power_meter_;
  // Scratch.
  std::vector<Mannequin> mannequins_;  ///< (n_people)
  std::vector<PosedShape> solids_;
  ZoneActivity activity_;
  ZoneSet person_zones_, person_channels_;
  std::vector<ZoneSet::Word> row_;  ///< words of a person's zones, then of their channels
};

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
