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
#include "sim/posture_memory.hpp"
#include "sim/solids.hpp"

namespace pirsim::sim {

/// Part of the power of one sensor, as far as one zone and one person's part bring it.
struct PowerShare {
  std::uint32_t ray = 0;
  std::uint32_t person = 0;  ///< index of the actor
  body::Part part = body::Part::pelvis;
  PowerSteps power = 0;
};

/// The power that each analog sensor receives. Belongs to one thread at a time and to one array, which has analog();
/// what it has measured before changes no result.
class PowerMeter {
 public:
  PowerMeter(const SensorArray& array, TracerKind kind);
  /// powers: (n_receivers) overwritten.
  void measure(const std::vector<Actor>& actors, std::span<PowerSteps> powers);
  /// The same of one body alone. solids: (n_parts) as append_solids() gives them.
  void measure(std::span<const PosedShape> solids, const BodyRadiance& radiance, std::span<PowerSteps> powers);
  /// Ray by ray, without memory.
  void explain(const std::vector<Actor>& actors, std::vector<PowerShare>& shares);

 private:
  struct Figure {
    std::uint32_t person = 0;
    const body::Humanoid* humanoid = nullptr;
    body::Outline outline;
  };

  [[nodiscard]] static bool is_same(const Figure& a, const Figure& b) noexcept;
  void trace(const std::vector<Actor>& actors);
  /// What was traced last.
  void add_up(std::span<PowerSteps> powers) const;

  const PowerModel& power_;
  std::unique_ptr<rt::Tracer> tracer_;
  PostureMemory memory_;            ///< of who is alone
  std::vector<Figure> before_;      ///< several people, the last time that there were any
  std::vector<PowerSteps> powers_;  ///< (n_receivers) then
  // Scratch.
  std::vector<Figure> now_;
  std::vector<Mannequin> mannequins_;  ///< (n_people)
  std::vector<PosedShape> solids_;
  std::vector<const BodyRadiance*> radiances_;  ///< (n_people in the scene)
  std::vector<rt::FirstHit> hits_;
  std::vector<PostureMemory::Word> row_;
};

/// Belongs to one thread at a time and to one array; what it has seen before changes no result.
class Observer {
 public:
  Observer(const SensorArray& array, TracerKind kind);
  /// exposure: of the array, overwritten.
  void look(const std::vector<Actor>& actors, Exposure& exposure);
  /// The same of one body alone, in any posture. solids: (n_parts) as append_solids() gives them.
  void look(std::span<const PosedShape> solids, const BodyRadiance& radiance, Exposure& exposure);

 private:
  std::span<const ZoneSet::Word> row_of(std::size_t person, const Actor& actor);

  const SensorArray& array_;
  std::unique_ptr<rt::Tracer> tracer_;
  PostureMemory memory_;
  std::unique_ptr<PowerMeter> power_meter_;  ///< null: no sensor is analog
  // Scratch.
  std::vector<Mannequin> mannequins_;  ///< (n_people)
  ZoneSet person_zones_, person_channels_;
  std::vector<ZoneSet::Word> row_;  ///< words of a person's zones, then of their channels
};

/// As many observers as there were runs at a time. Safe to use from any thread; study and pool outlive what is
/// borrowed.
class ObserverPool {
 public:
  explicit ObserverPool(const CompiledStudy& study) : study_(study) {}

  /// Comes back, with what it remembers, when the last pointer to it goes.
  [[nodiscard]] std::shared_ptr<Observer> borrow() {
    std::unique_ptr<Observer> observer = take();
    if (!observer) observer = std::make_unique<Observer>(study_.array(), study_.tracer());
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
  std::mutex mutex_;
  std::vector<std::unique_ptr<Observer>> idle_;
};

}  // namespace pirsim::sim
