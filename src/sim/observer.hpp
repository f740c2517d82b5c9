// What the sensors' optics show of people at a tick: the one way to look, with the memory that makes it fast.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "rt/tracer.hpp"
#include "sim/actor.hpp"
#include "sim/compiled_study.hpp"
#include "sim/leaf_numbers.hpp"
#include "sim/posture_memory.hpp"
#include "sim/power_meter.hpp"
#include "sim/solids.hpp"

namespace pirsim::sim {

/// Belongs to one thread at a time and to one array; what it has seen before changes no result.
class Observer {
 public:
  Observer(const SensorArray& array, TracerKind kind, ZonesOf whose);
  /// leaves: (n_doors) as they stand; exposure: of the array, overwritten.
  void look(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, Exposure& exposure);
  /// At zones alone, which there are.
  void look_at_zones(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, Exposure& exposure);
  /// As look(), at one body alone, in any posture, with leaves as before a run. solids: at most n_parts, as warm as the
  /// parts in their order.
  void look(std::span<const PosedShape> solids, const BodyRadiance& radiance, Exposure& exposure);

 private:
  /// Of a set of zones and of one of channels, its words counted on from those of the zones.
  using Parts = std::span<const ZoneSet::Part>;
  Parts seen_of(std::size_t person, const Actor& actor);

  const SensorArray& array_;
  std::unique_ptr<rt::Tracer> tracer_;  ///< null: no zones are wanted
  LeafNumbers leaves_;
  PostureMemory<ZoneSet::Part> memory_;
  std::unique_ptr<PowerMeter> power_meter_;  ///< null: no sensor is analog
  // Scratch.
  std::vector<Mannequin> mannequins_;  ///< (n_people)
  ZoneSet person_zones_, person_channels_;
  std::vector<ZoneSet::Part> parts_;
};

/// As many observers as there were runs at a time. Safe to use from any thread; study and pool outlive what is
/// borrowed.
class ObserverPool {
 public:
  ObserverPool(const CompiledStudy& study, ZonesOf whose) : study_(study), whose_(whose) {}

  /// Comes back, with what it remembers, when the last pointer to it goes.
  [[nodiscard]] std::shared_ptr<Observer> borrow() {
    std::unique_ptr<Observer> observer = take();
    if (!observer) observer = std::make_unique<Observer>(study_.array(), study_.tracer(), whose_);
    return {observer.release(), [this](Observer* used) { put_back(std::unique_ptr<Observer>(used)); }};
  }

 private:
  std::unique_ptr<Observer> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return nullptr;
    std::unique_ptr<Observer> observer = std::move(idle_.back());
    idle_.pop_back();
    return observer;
  }
  void put_back(std::unique_ptr<Observer> observer) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(observer));
  }

  const CompiledStudy& study_;
  ZonesOf whose_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Observer>> idle_;
};

}  // namespace pirsim::sim
