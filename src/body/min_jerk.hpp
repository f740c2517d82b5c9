// A scalar that moves to targets as people's limbs do, tick by tick.
#pragma once

#include <array>

namespace pirsim::body {

/// Minimum-jerk motion (a quintic in time) from the present value, velocity and acceleration to rest at a target.
/// Can be sent elsewhere at any tick; after the last tick the value is the target itself, bit for bit, whatever
/// came before. Ref: [FlashHogan1985].
class MinJerk {
 public:
  MinJerk() = default;
  explicit MinJerk(double resting_value) noexcept : target_(resting_value) { coefficients_[0] = resting_value; }

  /// Arrives after `ticks` ticks, or earlier where going on at the present speed would lead beyond the target.
  void move_to(double target, int ticks) noexcept;
  // Most are at rest at most ticks, and each person has sixteen.
  void advance() noexcept {
    if (!settled() && ++tick_ == ticks_) *this = MinJerk(target_);
  }
  [[nodiscard]] double value() const noexcept { return settled() ? target_ : moving_value(); }
  [[nodiscard]] double target() const noexcept { return target_; }
  [[nodiscard]] bool settled() const noexcept { return tick_ == ticks_; }
  bool operator==(const MinJerk&) const = default;

 private:
  [[nodiscard]] double moving_value() const noexcept;
  [[nodiscard]] double derivative(int order) const noexcept;  ///< per tick^order

  std::array<double, 6> coefficients_{};  ///< of tau^k, tau = tick/ticks
  double target_ = 0.0;
  int tick_ = 0;
  int ticks_ = 0;  ///< 0: at rest
};

}  // namespace pirsim::body
