// The power that each sensor receives at a tick, with the memory that makes it fast.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "rt/tracer.hpp"
#include "sim/actor.hpp"
#include "sim/analog_model.hpp"
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

/// Belongs to one thread at a time and to one Model; what it has measured before changes no result.
class PowerMeter {
 public:
  explicit PowerMeter(const CompiledStudy& study);
  /// powers: (n_sensors) overwritten.
  void measure(const std::vector<Actor>& actors, std::span<PowerSteps> powers);
  /// Ray by ray, without memory.
  void explain(const std::vector<Actor>& actors, std::vector<PowerShare>& shares);

 private:
  void add(const std::vector<Actor>& actors, std::span<PowerSteps> powers);
  void trace(const std::vector<Actor>& actors);
  /// add() to zeros, of several people; where nobody has moved the powers are those of the last time.
  void measure_several(const std::vector<Actor>& actors, std::span<PowerSteps> powers);

  const PowerModel& power_;
  TracerKind kind_;
  std::unique_ptr<rt::Tracer> tracer_;
  PostureMemory memory_;
  struct Figure {
    std::uint32_t person = 0;
    const body::Humanoid* humanoid = nullptr;
    body::Outline outline;
  };
  std::vector<Figure> before_;      ///< several people, the last time that there were any
  std::vector<PowerSteps> powers_;  ///< (n_sensors) then
  // Scratch.
  std::vector<Figure> now_;
  std::vector<Mannequin> mannequins_;  ///< (n_people)
  std::vector<PosedShape> solids_;
  std::vector<const BodyRadiance*> radiances_;  ///< (n_people in the scene)
  std::vector<std::uint32_t> people_;           ///< likewise: indices of actors
  std::vector<rt::FirstHit> hits_;
  std::vector<PostureMemory::Word> row_;
};

}  // namespace pirsim::sim
