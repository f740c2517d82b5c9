#include "control/light_switch.hpp"

#include <cmath>

namespace pirsim::control {

SwitchRule::SwitchRule(const LightSpec& light, double window_s)
    : least_on_rows(std::llround(60.0 * light.least_on_min / window_s)), timer(light.timer) {
  if (light.wave_s) wave_rows = std::llround(*light.wave_s / window_s);
  if (!light.manual) return;
  switch_rows = std::llround(light.manual->switch_s / window_s);
  grace_rows = std::llround(light.manual->grace_s / window_s);
}

void LightSwitch::go_on() noexcept {
  lit_ = was_lit_ = true;
  since_ = counted_from_ = row_;
  waits_ = 0;
}

bool LightSwitch::goes_on(const SwitchRule& rule, const Cue& cue) noexcept {
  if (!rule.switch_rows) {
    waits_ = cue.occupied && rule.wave_rows ? waits_ + 1 : 0;
    return cue.moved || (rule.wave_rows && waits_ > *rule.wave_rows);
  }
  if (cue.moved && was_lit_ && row_ - since_ <= rule.grace_rows) return true;
  waits_ = cue.occupied ? waits_ + 1 : 0;
  return waits_ > *rule.switch_rows;
}

void LightSwitch::advance(const SwitchRule& rule, const Cue& cue, std::int64_t delay_rows) {
  ++row_;
  if (cue.is_open && latched_) counted_from_ = row_;
  latched_ = !cue.is_open && (latched_ || cue.is_behind);
  if (!lit_) {
    if (goes_on(rule, cue)) go_on();
    return;
  }
  const bool is_over = row_ - counted_from_ > delay_rows;
  if (cue.moved && (rule.timer == Timer::restarts || is_over)) counted_from_ = row_;
  if (latched_ || row_ - counted_from_ <= delay_rows || row_ - since_ < rule.least_on_rows) return;
  lit_ = false;
  since_ = row_;
}

}  // namespace pirsim::control
