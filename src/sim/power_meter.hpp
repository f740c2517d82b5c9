// What analog sensors receive of people, who hide one another.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rt/tracer.hpp"
#include "sim/actor.hpp"
#include "sim/leaf_numbers.hpp"
#include "sim/posture_memory.hpp"
#include "sim/sensor_array.hpp"
#include "sim/solids.hpp"

namespace pirsim::sim {

/// Part of the power of one sensor, as far as one zone and one person's part bring it.
struct PowerShare {
  std::uint32_t ray = 0;
  std::uint32_t person = 0;  ///< index of the actor
  body::Part part = body::Part::pelvis;
  PowerSteps power = 0;
};

/// (n_parts) those of equal radiance have the same number: which of them a ray hits makes no difference.
[[nodiscard]] std::array<std::uint8_t, body::n_parts> surfaces_of(const BodyRadiance& radiance) noexcept;

/// The power that each analog sensor receives. Belongs to one thread at a time and to one array, which has analog();
/// what it has measured before changes no result.
class PowerMeter {
 public:
  PowerMeter(const SensorArray& array, TracerKind kind);
  /// leaves: (n_doors) as they stand; powers: (n_receivers) overwritten.
  void measure(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, std::span<PowerSteps> powers);
  /// The same of one body alone, with leaves as before a run. solids: at most n_parts, as warm as the parts in their
  /// order.
  void measure(std::span<const PosedShape> solids, const BodyRadiance& radiance, std::span<PowerSteps> powers);
  /// Ray by ray.
  void explain(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, std::vector<PowerShare>& shares);

 private:
  /// What was followed last of a person.
  struct Figure {
    bool is_there = false;
    const body::Humanoid* humanoid = nullptr;  ///< null: of a body that isn't an actor's
    std::size_t n_solids = 0;
    BodyRadiance radiance{};
    std::array<std::uint8_t, body::n_parts> surfaces{};  ///< parts of equal radiance
    body::Outline outline;
  };

  void turn(std::span<const LeafStep> leaves);
  /// Of those in moved_ nothing stays.
  void take_away();
  /// Takes the tracer to where people are now.
  void follow(const std::vector<Actor>& actors);
  void follow(std::span<const rt::Moved> moved);
  [[nodiscard]] PowerSteps power(std::uint32_t ray, rt::SolidId solid) const noexcept {
    return solid == rt::no_solid ? 0 : power_.power(ray, figures_[solid.person].radiance[solid.solid]);
  }

  const PowerModel& power_;
  std::unique_ptr<rt::Tracer> tracer_;
  LeafNumbers leaves_;
  PostureMemory<PowerSteps> alone_;  ///< powers of postures of who was alone
  std::vector<Figure> figures_;      ///< (n_people)
  std::vector<PowerSteps> powers_;   ///< (n_receivers) of figures_
  // Scratch.
  std::vector<Mannequin> mannequins_;  ///< (n_people)
  std::vector<rt::Moved> moved_;
  std::vector<rt::FirstHitChange> changes_;
};

}  // namespace pirsim::sim
