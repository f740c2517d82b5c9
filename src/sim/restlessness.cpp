#include "sim/restlessness.hpp"

#include <algorithm>
#include <cmath>

#include "pirsim/geometry.hpp"
#include "sim/natural_acts.hpp"

namespace pirsim::sim {
namespace {

constexpr double bout_s = 20.0;  // assumed (10-60): swinging and stillness take turns in stretches of this length
}  // namespace

Restlessness::Restlessness(const PersonChanges& changes, std::uint64_t seed, std::uint32_t run, std::uint32_t person,
                           double tick_s)
    : fidgeting_(changes.fidgeting),
      arms_(changes.uneven_arms),
      tick_s_(tick_s),
      acts_(changes.fidgeting.rate_per_s > 0.0 || changes.uneven_arms.spread > 0.0 ||
            changes.uneven_arms.pause_share > 0.0 || changes.trunk_sway.amplitude_deg > 0.0 ||
            changes.chair_swing.amplitude_deg > 0.0),
      fidget_stream_({seed, run, person, Purpose::fidgeting}),
      arms_stream_({seed, run, person, Purpose::uneven_arms}),
      trunk_{changes.trunk_sway, body::Channel::trunk_lean, Stream({seed, run, person, Purpose::trunk_sway})},
      chair_{changes.chair_swing, body::Channel::chair_turn, Stream({seed, run, person, Purpose::chair_swing})} {}

std::int64_t Restlessness::ticks(double seconds) const noexcept {
  return std::max<std::int64_t>(1, std::llround(seconds / tick_s_));
}

void Restlessness::tick(body::Motion& motion, const action::Work* work) {
  fidget(motion);
  swing(trunk_, motion);
  swing(chair_, motion);
  if (work != nullptr) swing_arms(motion, *work);
}

void Restlessness::leave_seat() noexcept {
  trunk_.middle.reset();
  chair_.middle.reset();
}

void Restlessness::fidget(body::Motion& motion) {
  if (fidgeting_.rate_per_s <= 0.0) return;
  if (fidgeting_.timing == FidgetTiming::independent) {
    if (fidget_stream_.uniform() >= -std::expm1(-fidgeting_.rate_per_s * tick_s_)) return;
  } else {
    if (--ticks_to_fidget_ > 0) return;
    const bool first = ticks_to_fidget_ < 0;
    // Nobody sits down just after a fidget: else the first of the long pauses would come too late.
    const StillPeriods between_fidgets{1.0 / fidgeting_.rate_per_s};
    const double z = fidget_stream_.normal();
    ticks_to_fidget_ = ticks(first ? between_fidgets.rest_s(z, fidget_stream_.uniform()) : between_fidgets.length_s(z));
    if (first) return;
  }
  const double way = 2.0 * fidget_stream_.uniform() - 1.0;
  if (fidget_stream_.index(2) == 0) {
    motion.adjust(body::Channel::trunk_tilt, radians(fidgeting_.tilt_deg) * way, body::fidget_s);
  } else {
    motion.adjust(body::Channel::head_turn, radians(fidgeting_.turn_deg) * way, body::fidget_s);
  }
}

void Restlessness::swing(Swing& swing, body::Motion& motion) const {
  if (swing.spec.amplitude_deg <= 0.0) return;
  if (!swing.middle) swing.middle = motion.target(swing.channel);
  if (--swing.ticks_to_turn > 0) return;
  const double half_s = 0.5 * swing.spec.period_s;
  swing.ticks_to_turn = ticks(half_s);
  if (swing.turns_left-- == 0) {
    swing.turns_left = std::llround(bout_s / half_s);
    swing.swings = swing.stream.uniform() < swing.spec.share;
  }
  const double amplitude = swing.swings ? radians(swing.spec.amplitude_deg) : 0.0;
  motion.adjust(swing.channel, *swing.middle + swing.side * amplitude, half_s);
  swing.side = -swing.side;
}

void Restlessness::swing_arms(body::Motion& motion, const action::Work& work) {
  if (arms_.spread <= 0.0 && arms_.pause_share <= 0.0) return;
  if (--ticks_to_swing_ > 0) return;
  // Of mean 1 both, so that neither the amplitude nor the period is another on average.
  const auto factor = [&] {
    return std::exp(arms_.spread * arms_stream_.normal() - 0.5 * arms_.spread * arms_.spread);
  };
  const double amplitude_m = work.arm_amplitude_m * factor(), period_s = work.arm_period_s * factor();
  const bool pauses = arms_stream_.uniform() < arms_.pause_share;
  motion.work({pauses ? 0.0 : amplitude_m, period_s});
  ticks_to_swing_ = ticks(period_s);
}

}  // namespace pirsim::sim
