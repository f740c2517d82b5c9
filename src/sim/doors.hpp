// The doors of one run: which leaves stand open, who opens them, and when they are shut again.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pirsim/random.hpp"
#include "schema/door_leaf.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// What walkers see of doors.
struct DoorsSeen {
  std::span<const DoorLeaf> leaves;      ///< (n_doors)
  std::span<const LeafStep> steps;       ///< (n_doors)
  std::span<const std::uint8_t> barred;  ///< (n_doors) 1: would open but for somebody in its way
};

/// What doors know of somebody.
struct DoorUser {
  Vec2 before{0.0}, now{0.0};                                  ///< at the last tick and at this one
  Vec2 knees{0.0};                                             ///< of who sits; `now` of others
  enum class Gait { stands, walks, led } gait = Gait::stands;  ///< led: along a way that is given, through anything
  std::optional<std::size_t> wants;                            ///< door that they wait for, or go through next
  enum class Place { floor, doorway } place = Place::floor;    ///< of who wants one
};

/// A value. A leaf turns while nobody is in its way, so it pushes nobody; who wants to go through waits before what it
/// sweeps until it is open, and whoever stands in its way steps back.
class Doors {
 public:
  static constexpr double hold_m =
      0.6;  ///< assumed: kept from what a leaf sweeps by who waits: an arm that swings (0.5-0.7)

  static constexpr double clear_m =
      0.38;  ///< assumed: kept between a leaf that turns and who stands, less than who waits keeps (0.3-0.45)

  /// As they stand before a run.
  Doors(const CompiledStudy& study, std::uint32_t run);

  /// To this tick, after everybody has moved to it.
  void advance(const CompiledStudy& study, std::int64_t tick, std::span<const DoorUser> users);

  [[nodiscard]] std::span<const LeafStep> steps() const noexcept { return steps_; }
  [[nodiscard]] DoorsSeen seen(const CompiledStudy& study) const noexcept {
    return {study.array().leaves(), steps_, barred_};
  }
  /// Up to this tick nothing changes if nobody comes.
  [[nodiscard]] std::int64_t still_until(const CompiledStudy& study, std::int64_t tick) const noexcept;

 private:
  enum class Goal { open, shut };
  struct Door {
    Goal goal = Goal::shut;
    bool shut_behind = false;     ///< as soon as nobody is in the way
    std::int64_t open_until = 0;  ///< tick at which it is shut otherwise
    std::optional<std::int64_t> wanted_since = {};
    Stream habit;
  };
  void advance_one(const CompiledStudy& study, std::size_t door, std::int64_t tick, std::span<const DoorUser> users);
  void note_pass(const CompiledStudy& study, std::size_t door, std::int64_t tick);
  [[nodiscard]] bool is_clear(const DoorLeaf& leaf, std::size_t door, std::span<const DoorUser> users) const;

  std::vector<LeafStep> steps_;       ///< (n_doors)
  std::vector<std::uint8_t> barred_;  ///< (n_doors) see DoorsSeen
  std::vector<Door> doors_;           ///< (n_doors)
};

}  // namespace pirsim::sim
