// What one person does in the course of a run, as it is put together.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "pirsim/script.hpp"

namespace pirsim::sim {

inline constexpr double until_next_s = 24.0 * 3600.0;  ///< of an action that only the next one ends

/// Actions of one person, timed in seconds of the run, and never two that begin at once.
class ActionLine {
 public:
  explicit ActionLine(const ScheduleSpec& schedule) : schedule_(schedule) {}

  /// At a moment of the day, whatever goes on then.
  void at(double day_s, Action what, const char* phase = "") {
    // In whole ticks of any rate, and later than what was timed before.
    const double run_s = std::max(std::ceil(day_s - schedule_.from_h * 3600.0), last_s_ + 1.0);
    last_s_ = run_s;
    add(std::move(what), phase).at_s = run_s;
  }
  /// After what was added before.
  void then(Action what, const char* phase = "") { add(std::move(what), phase); }
  [[nodiscard]] std::vector<ScriptedAction> take() { return std::move(actions_); }

 private:
  ScriptedAction& add(Action what, const char* phase) {
    ScriptedAction& action = actions_.emplace_back();
    action.what = std::move(what);
    action.phase = phase;
    action.where = schedule_.where;
    return action;
  }

  const ScheduleSpec& schedule_;
  double last_s_ = -1.0;
  std::vector<ScriptedAction> actions_;
};

}  // namespace pirsim::sim
