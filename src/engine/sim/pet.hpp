// How pets move: they rest, roam in bouts and get onto furniture.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/body/gait.hpp"
#include "engine/body/motion.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/pedestrian.hpp"
#include "pirsim/random.hpp"

namespace pirsim::sim {

/// None where the floor has no place for it. A cat gets onto seats, beds and places for pets, a dog onto these alone.
[[nodiscard]] std::optional<Haunts> haunts_of(const PetSpec& pet, const SceneSpec& scene,
                                              const body::WalkableFloor& floor);

/// A value; all its randomness comes from one stream keyed by (seed, run, person).
class Pet {
 public:
  /// Lies somewhere.
  Pet(const CompiledStudy& study, std::uint32_t run, std::uint32_t person);
  /// From tick now to the next.
  void advance(const CompiledStudy& study, std::int64_t now, const Others& people, const DoorsSeen& doors);
  [[nodiscard]] body::Outline outline() const noexcept;

 private:
  enum class Doing { lies, stands, walks, jumps };

  [[nodiscard]] double drawn_around(double mean) noexcept;  ///< exponential
  [[nodiscard]] std::int64_t drawn_rest_ends(const CompiledStudy& study, std::int64_t now);
  [[nodiscard]] std::optional<Vec2> drawn_place(const CompiledStudy& study);
  void stand_until(std::int64_t tick) noexcept;
  void lie_down(const CompiledStudy& study, std::int64_t now);
  void set_out(const CompiledStudy& study, std::int64_t now, const Others& people, const DoorsSeen& doors);
  [[nodiscard]] bool go_to(const Vec2& place, const DoorsSeen& doors);
  void turn_to(double heading, double tick_s) noexcept;
  void walk(const CompiledStudy& study, std::int64_t now, const Others& people, const DoorsSeen& doors);
  void jump(const Vec3& to) noexcept;
  void fly(const CompiledStudy& study, std::int64_t now);

  const PersonModel* me_;
  std::uint32_t run_;
  Stream stream_;
  Doing doing_ = Doing::lies;
  body::Placement at_;
  double height_m_ = 0.0;   ///< y of what it stands on
  double lies_ = 1.0;       ///< 0 standing, 1 lying
  double strided_m_ = 0.0;  ///< walked in all
  double swing_ = 0.0;      ///< 0 paws beneath the body, 1 as far apart as they get
  std::int64_t until_ = 0;  ///< tick at which it stops lying or standing
  int ways_left_ = 0;       ///< of this bout
  body::Route route_;
  double walked_m_ = 0.0;
  const Perch* perch_ = nullptr;  ///< that it is on, or is on its way to
  bool is_up_ = false;            ///< on the perch
  // Of a jump.
  Vec3 from_{0.0}, to_{0.0};
  double share_ = 0.0;  ///< of its time
};

}  // namespace pirsim::sim
