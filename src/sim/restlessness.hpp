// Movements of somebody seated that no script asks for: what effects say about how people move.
#pragma once

#include <cstdint>
#include <optional>

#include "body/motion.hpp"
#include "pirsim/random.hpp"
#include "pirsim/script.hpp"
#include "schema/study_in_force.hpp"

namespace pirsim::sim {

/// A value; each kind of movement draws from a stream of its own.
class Restlessness {
 public:
  Restlessness(const PersonChanges& changes, std::uint64_t seed, std::uint32_t run, std::uint32_t person,
               double tick_s);
  /// Whether any effect asks for movements.
  [[nodiscard]] bool acts() const noexcept { return acts_; }
  /// Before the body moves, at a tick at which it is seated. work: what the person is at in the paper's style, or null.
  void tick(body::Motion& motion, const action::Work* work);
  /// Another seat is turned to its own table.
  void leave_seat() noexcept;

 private:
  /// One channel that swings.
  struct Swing {
    SwingSpec spec;
    body::Channel channel;
    Stream stream;
    std::optional<double>
        middle{};  ///< where the channel is when it doesn't swing; none before the first tick on a seat
    std::int64_t ticks_to_turn = 0;
    std::int64_t turns_left = 0;  ///< of the bout
    bool swings = false;          ///< in this bout
    double side = 1.0;
  };
  void fidget(body::Motion& motion);
  void swing(Swing& swing, body::Motion& motion) const;
  void swing_arms(body::Motion& motion, const action::Work& work);
  [[nodiscard]] std::int64_t ticks(double seconds) const noexcept;

  FidgetSpec fidgeting_;
  UnevenArmsSpec arms_;
  double tick_s_;
  bool acts_;
  Stream fidget_stream_, arms_stream_;
  Swing trunk_, chair_;
  std::int64_t ticks_to_fidget_ = 0;
  std::int64_t ticks_to_swing_ = 0;  ///< of the arms
};

}  // namespace pirsim::sim
