// A sitter of natural style without a room, and an observer who sees joints and nothing else.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/body/motion.hpp"
#include "engine/sim/natural_motion.hpp"

namespace pirsim::body::test {

inline constexpr int tick_rate_hz = 50;

/// The joints, but for breathing.
inline std::array<double, 14> joints(const Motion& motion) {
  const Outline o = motion.outline();
  return {
      o.pelvis.heading,  o.pelvis.position.x, o.pelvis.position.y, o.spine_tilt,   o.spine_lean,   o.head_turn,
      o.reach,           o.hand_ahead_m[0],   o.hand_ahead_m[1],   o.hand_up_m[0], o.hand_up_m[1], o.hand_to_head[0],
      o.hand_to_head[1], o.hand_offset_m};
}

inline bool differ(const std::array<double, 14>& a, const std::array<double, 14>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) > 1e-9) return true;
  }
  return false;
}

/// An observer who sees joints and nothing else.
class SitterObserver {
 public:
  void see(const Motion& motion) {
    const auto now = joints(motion);
    const bool moves = last_ && differ(now, *last_);
    if (moves && still_ticks_ > 0) still_s_.push_back(still_ticks_ * 1.0 / tick_rate_hz);
    still_ticks_ = moves ? 0 : still_ticks_ + 1;
    constexpr int a_moment = 15;
    if (still_ticks_ == a_moment) note_rest(now);
    last_ = now;
  }
  /// Periods in which no joint moved, seconds.
  [[nodiscard]] const std::vector<double>& still_s() const { return still_s_; }
  /// How often trunk or chair came to rest elsewhere than before.
  [[nodiscard]] int shifts() const { return shifts_; }

 private:
  void note_rest(const std::array<double, 14>& now) {
    const std::array<double, 3> trunk{now[0], now[3], now[4]};
    if (rested_)
      shifts_ += std::abs(trunk[0] - rest_[0]) + std::abs(trunk[1] - rest_[1]) + std::abs(trunk[2] - rest_[2]) > 1e-6;
    rest_ = trunk;
    rested_ = true;
  }
  std::optional<std::array<double, 14>> last_;
  std::array<double, 3> rest_{};
  bool rested_ = false;
  int still_ticks_ = 0, shifts_ = 0;
  std::vector<double> still_s_;
};

/// Somebody of natural style on a seat that faces -Z, at a table, from the moment on when they sit.
struct Sitter {
  Sitter(std::uint32_t person, const Humanoid& humanoid, const SeatPlace& seat)
      : motion(
            humanoid,
            Vec2(seat.world_from_seat.origin.x, seat.world_from_seat.origin.z) - 0.6 * direction_of(seat.approach_turn),
            seat.approach_turn, 0.0, 1.0 / tick_rate_hz),
        natural(11, 0, person, tick_rate_hz) {
    motion.sit_down(seat);
    while (motion.stage() != Stage::seated) tick(std::nullopt);
    motion.work({0.0, 3.0});
  }
  void tick(std::optional<Activity> activity, const sim::Attention& attention = {}) {
    natural.tick(motion, activity, attention);
    motion.advance();
  }
  Motion motion;
  sim::NaturalMotion natural;
};

}  // namespace pirsim::body::test
