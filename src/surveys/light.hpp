// One light at one delay: whether it is on, row by row. Times are whole rows.
#pragma once

#include <cstdint>

#include "pirsim/control.hpp"

namespace pirsim::control {

/// What a light goes by in one row.
struct Cue {
  bool moved = false;      ///< as many of its sensors as have to report motion
  bool occupied = false;   ///< somebody is in its area
  bool is_open = false;    ///< its door
  bool is_behind = false;  ///< what moved began to do so behind the shut door: nobody can have left
};

/// A rule in rows.
struct SwitchRule {
  SwitchRule(const LightSpec& light, double window_s);

  std::optional<std::int64_t> switch_rows{};  ///< none: motion switches it on
  std::optional<std::int64_t> wave_rows{};    ///< in the dark, until who is there has waved; none: nobody waves
  std::int64_t grace_rows = 0, least_on_rows = 0;
  Timer timer = Timer::restarts;
};

/// A value.
class LightSwitch {
 public:
  /// The next row. delay_rows: as it is then. It is lit so many rows beyond the one with the last motion.
  void advance(const SwitchRule& rule, const Cue& cue, std::int64_t delay_rows);
  /// So many rows in the dark with nobody there, no motion and the door shut: as advance() with each.
  void rest(std::int64_t n_rows) noexcept {
    row_ += n_rows;
    waits_ = 0;
  }
  [[nodiscard]] bool is_lit() const noexcept { return lit_; }

 private:
  void go_on() noexcept;
  [[nodiscard]] bool goes_on(const SwitchRule& rule, const Cue& cue) noexcept;

  bool lit_ = false;
  bool latched_ = false;  ///< by motion behind a shut door
  std::int64_t row_ = 0;
  std::int64_t since_ = 0;         ///< lit since this row, or dark
  std::int64_t counted_from_ = 0;  ///< of the delay
  std::int64_t waits_ = 0;         ///< rows in which somebody was in the dark without having used the switch, or waved
  bool was_lit_ = false;           ///< ever
};

}  // namespace pirsim::control
