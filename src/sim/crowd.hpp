// Who is where: all people of one run, carrying out their scripts among each other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "pirsim/random.hpp"
#include "sim/actor.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// Turns of speech among whoever takes part. A value; draws from a stream of its own.
class Conversation {
 public:
  /// number: which of the conversations of a run.
  Conversation(std::uint64_t seed, std::uint32_t run, std::uint32_t number)
      : stream_({seed, run, number, Purpose::conversation}) {}

  /// Of these people, who speaks at this tick; nobody where fewer than two are. participants: ascending.
  [[nodiscard]] std::optional<std::uint32_t> speaker(std::span<const std::uint32_t> participants, std::int64_t tick,
                                                     int tick_rate_hz);

 private:
  Stream stream_;
  std::optional<std::uint32_t> speaker_;
  std::int64_t until_ = 0;
};

/// A value. Belongs to the study that it was made for, which outlives it.
class Crowd {
 public:
  /// The moment before the first tick.
  Crowd(const CompiledStudy& study, std::uint32_t run);

  /// To this tick (1, 2, ...), from the one before.
  void advance(const CompiledStudy& study, std::int64_t tick);

  [[nodiscard]] const std::vector<Actor>& actors() const noexcept { return actors_; }
  [[nodiscard]] const Doors& doors() const noexcept { return doors_; }
  /// Indices (into the scene's seats) of the seats from which somebody rose in the step to this tick.
  [[nodiscard]] const std::vector<std::size_t>& seats_left() const noexcept { return seats_left_; }
  /// Up to this tick nobody comes, and nothing of anybody changes; the present one (`tick`) if somebody is there.
  [[nodiscard]] std::int64_t away_until(const CompiledStudy& study, std::int64_t tick) const;
  /// What the first person does: the rows' phase.
  [[nodiscard]] std::string_view phase() const noexcept;
  /// Every subject has carried out all actions.
  [[nodiscard]] bool done() const noexcept;

 private:
  void advance_among_others(const CompiledStudy& study, std::int64_t tick);
  void note_seats_left(const CompiledStudy& study);
  void turn_leaves(const CompiledStudy& study, std::int64_t tick);
  void let_speak(const CompiledStudy& study, std::int64_t tick);

  std::vector<Actor> actors_;
  std::vector<Presence> in_scene_;    ///< as they are now, in the order of the script; empty where there is one actor
  std::vector<std::uint8_t> seated_;  ///< (n_actors) 1 while seated
  std::vector<std::size_t> seats_left_;
  std::vector<Conversation> conversations_;  ///< one of each area, one in a scene without areas
  Doors doors_;
  std::vector<std::optional<Vec2>> places_;  ///< (n_actors) at the last tick, in scenes with doors
  std::vector<std::uint32_t> participants_;  ///< scratch
  std::vector<std::uint32_t> together_;      ///< scratch
  std::vector<DoorUser> door_users_;         ///< scratch
};

}  // namespace pirsim::sim
