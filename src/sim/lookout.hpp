// What all sensors see of all people at a tick, with the memory that makes it fast.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "rt/tracer.hpp"
#include "sim/actor.hpp"
#include "sim/mannequin.hpp"
#include "sim/model.hpp"
#include "sim/posture_memory.hpp"
#include "sim/power_meter.hpp"

namespace pirsim::sim {

/// Belongs to one thread at a time and to one Model; what it has seen before changes no result.
class Lookout {
 public:
  explicit Lookout(const Model& model);
  /// zones and channels (of the Model's detector) are overwritten.
  void look(const std::vector<Actor>& actors, ZoneSet& zones, ZoneSet& channels);
  /// Only if there are analog sensors; powers: (n_sensors) overwritten.
  void measure(const std::vector<Actor>& actors, std::span<PowerSteps> powers) {
    power_meter_->measure(actors, powers);
  }

 private:
  void look_at_all(const std::vector<Actor>& actors, ZoneSet& zones, ZoneSet& channels);
  std::span<const ZoneSet::Word> row_of(std::size_t person, const Actor& actor);

  const pir::MotionDetector& detector_;
  rt::TracerKind kind_;
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

}  // namespace pirsim::sim
