#include "sim/natural_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pirsim/geometry.hpp"

namespace pirsim::sim {
namespace {

using body::Channel;
using body::Stage;
using Side = Stroke::Side;
using After = Act::After;

constexpr double degree = pi / 180.0;

// Shifts and fidgets of seated office workers, a second. Ref: [ApplErgon2024]: 9 and 13 in 15 minutes.
constexpr double shift_rate = 9.0 / 900.0;
constexpr double fidget_rate = 13.0 / 900.0;
// Still periods follow a power law over two decades. Ref: [Nakamura2007], whose cumulative exponent is near 0.9; the
// ends of the law are assumed (shortest 0.5-2 s, longest 300-1200 s).
constexpr double still_exponent = 0.9;
constexpr double shortest_still_s = 1.0;
constexpr double longest_still_s = 600.0;
constexpr double goes_on = 0.4;                // assumed (0.2-0.6): another act follows at once
constexpr double mean_act_s = 2.5;             // of the acts below; with it shares of kinds follow from rates
constexpr double liveliness_sd = 0.4;          // assumed (0.3-0.6): of the logarithm of a person's rate
constexpr double pace_sd_m_s = 0.2;            // Ref: [Weidmann1993]: 0.26 in the open
constexpr double breath_hz = 0.25;             // 0.2-0.3 at rest
constexpr double breath_tilt = 0.25 * degree;  // assumed (0.1-0.5 degrees): 2.4 mm at the shoulders
constexpr int breath_levels = 2;  // to either side: a posture changes ten times a breath instead of 200 times

constexpr const char* assumed = "assumed: from watching people at desks (amplitudes tried by half and twice)";

// Shifts: the body comes to rest in another posture.
constexpr std::array lean{Stroke{Channel::trunk_tilt, -10 * degree, 14 * degree}};
constexpr std::array shift_on_chair{Stroke{Channel::trunk_lean, 2 * degree, 7 * degree, Side::either},
                                    Stroke{Channel::trunk_tilt, -6 * degree, 8 * degree}};
constexpr std::array turn_chair{Stroke{Channel::chair_turn, 4 * degree, 18 * degree, Side::either}};
constexpr std::array all_shifts{
    Act{"lean", ActKind::shift, lean, 1.4, 1, 1, After::stays, assumed},
    Act{"shift on the chair", ActKind::shift, shift_on_chair, 1.0, 1, 1, After::stays, assumed},
    Act{"turn the chair", ActKind::shift, turn_chair, 1.5, 1, 1, After::stays, assumed}};

constexpr std::array look{Stroke{Channel::head_turn, 15 * degree, 50 * degree, Side::either}};
constexpr std::array sway{Stroke{Channel::trunk_tilt, 1 * degree, 4 * degree, Side::either}};
constexpr std::array touch_face{Stroke{Channel::right_hand_up, 0.22, 0.30},
                                Stroke{Channel::right_hand_ahead, -0.12, -0.08}};
constexpr std::array all_fidgets{
    Act{"look round", ActKind::fidget, look, 0.7, 1, 2, After::returns, assumed},
    Act{"sway", ActKind::fidget, sway, 0.6, 1, 3, After::returns, assumed},
    Act{"touch the face", ActKind::fidget, touch_face, 0.9, 1, 1, After::returns, assumed}};

constexpr std::array type{Stroke{Channel::left_hand_ahead, -0.025, 0.025},
                          Stroke{Channel::right_hand_ahead, -0.025, 0.025}};
constexpr std::array mouse{Stroke{Channel::right_hand_ahead, -0.05, 0.05}};
constexpr std::array reach{Stroke{Channel::right_hand_ahead, 0.08, 0.12},
                           Stroke{Channel::trunk_tilt, 2 * degree, 8 * degree}};
constexpr std::array typing_tasks{Act{"type", ActKind::task, type, 0.3, 3, 14, After::returns, assumed},
                                  Act{"use the mouse", ActKind::task, mouse, 0.5, 2, 6, After::returns, assumed},
                                  Act{"type", ActKind::task, type, 0.3, 3, 14, After::returns, assumed},
                                  Act{"reach for something", ActKind::task, reach, 1.0, 1, 1, After::returns, assumed}};

constexpr std::array turn_page{Stroke{Channel::right_hand_up, 0.03, 0.07},
                               Stroke{Channel::right_hand_ahead, -0.10, 0.04}};
constexpr std::array nod{Stroke{Channel::trunk_tilt, 0.5 * degree, 2 * degree}};
constexpr std::array glance{Stroke{Channel::head_turn, 4 * degree, 12 * degree, Side::either}};
constexpr std::array reading_tasks{Act{"turn a page", ActKind::task, turn_page, 0.7, 1, 2, After::returns, assumed},
                                   Act{"follow the lines", ActKind::task, glance, 0.8, 1, 4, After::returns, assumed}};

constexpr std::array gesture{Stroke{Channel::left_hand_up, 0.04, 0.18}, Stroke{Channel::right_hand_up, 0.04, 0.18},
                             Stroke{Channel::left_hand_ahead, -0.08, 0.08},
                             Stroke{Channel::right_hand_ahead, -0.08, 0.08}};
constexpr std::array take_notes{Stroke{Channel::right_hand_ahead, -0.03, 0.03}};
constexpr std::array meeting_tasks{Act{"nod", ActKind::task, nod, 0.4, 1, 3, After::returns, assumed},
                                   Act{"take notes", ActKind::task, take_notes, 0.3, 2, 12, After::returns, assumed},
                                   Act{"glance", ActKind::task, glance, 0.6, 1, 1, After::returns, assumed}};
constexpr std::array speaking_tasks{Act{"gesture", ActKind::task, gesture, 0.5, 2, 8, After::returns, assumed}};

constexpr std::array one_hand{Stroke{Channel::right_hand_up, 0.03, 0.15},
                              Stroke{Channel::right_hand_ahead, -0.06, 0.06}};
constexpr std::array phone_tasks{
    Act{"gesture with one hand", ActKind::task, one_hand, 0.5, 1, 5, After::returns, assumed},
    Act{"look round", ActKind::task, look, 0.7, 1, 2, After::returns, assumed}};

// On the feet.
constexpr std::array shift_weight{Stroke{Channel::trunk_lean, 1 * degree, 3 * degree, Side::either}};
constexpr std::array standing_shifts{
    Act{"shift the weight", ActKind::shift, shift_weight, 1.2, 1, 1, After::stays, assumed}};

std::span<const Act> tasks(Activity activity) noexcept {
  switch (activity) {
    case Activity::typing:
      return typing_tasks;
    case Activity::reading:
      return reading_tasks;
    case Activity::meeting:
      return meeting_tasks;
    case Activity::phone:
      return phone_tasks;
  }
  return typing_tasks;
}

/// Of the truncated power law: its mean.
double mean_still_s() {
  const double ratio = longest_still_s / shortest_still_s;
  return still_exponent / (1.0 - still_exponent) * shortest_still_s * (std::pow(ratio, 1.0 - still_exponent) - 1.0) /
         (1.0 - std::pow(ratio, -still_exponent));
}

}  // namespace

std::vector<Act> acts_of(Activity activity) {
  std::vector<Act> acts;
  for (const std::span<const Act> some :
       {tasks(activity), std::span<const Act>(all_shifts), std::span<const Act>(all_fidgets)}) {
    acts.insert(acts.end(), some.begin(), some.end());
  }
  if (activity == Activity::meeting) acts.insert(acts.end(), speaking_tasks.begin(), speaking_tasks.end());
  return acts;
}

NaturalMotion::NaturalMotion(std::uint64_t seed, std::uint32_t run, std::uint32_t person, int tick_rate_hz)
    : stream_({seed, run, person, Purpose::natural_motion}), tick_rate_hz_(tick_rate_hz) {
  liveliness_ = std::exp(liveliness_sd * stream_.normal());
  breath_phase_ = stream_.uniform();
  Stream pace({seed, run, person, Purpose::pace});
  pace_ = std::clamp(pace.normal(), -2.0, 2.0);
  be_still();
}

double NaturalMotion::pace(double scripted_m_s) const noexcept {
  return std::max(0.4 * scripted_m_s, scripted_m_s + pace_sd_m_s * pace_);
}

const Act& NaturalMotion::draw(std::span<const Act> acts) {
  return acts[stream_.index(static_cast<std::uint32_t>(acts.size()))];
}

/// By inversion of the truncated power law.
void NaturalMotion::be_still() {
  act_ = nullptr;
  const double all = 1.0 - std::pow(longest_still_s / shortest_still_s, -still_exponent);
  const double seconds = shortest_still_s * std::pow(1.0 - all * stream_.uniform(), -1.0 / still_exponent);
  next_ = tick_ + std::max<std::int64_t>(1, std::llround(seconds / liveliness_ * tick_rate_hz_));
}

/// Kinds come in their published rates: an act is one of so many a second on average.
void NaturalMotion::begin_act(std::optional<Activity> activity, Attention::Talk talk) {
  static const double acts_per_s = 1.0 / ((1.0 - goes_on) * mean_still_s() + mean_act_s);
  const double kind = stream_.uniform() * acts_per_s;
  if (!activity) {
    act_ = kind < shift_rate + fidget_rate ? &draw(standing_shifts) : &all_fidgets.front();
  } else if (kind < shift_rate) {
    act_ = &draw(all_shifts);
  } else if (kind < shift_rate + fidget_rate) {
    act_ = &draw(all_fidgets);
  } else {
    act_ = &draw(talk == Attention::Talk::speaks ? std::span<const Act>(speaking_tasks) : tasks(*activity));
  }
  ++begun_[static_cast<std::size_t>(act_->kind)];
  repeats_left_ =
      act_->fewest + static_cast<int>(stream_.index(static_cast<std::uint32_t>(act_->most - act_->fewest + 1)));
}

void NaturalMotion::stroke(body::Motion& motion) {
  for (const Stroke& stroke : act_->strokes) {
    double target = stroke.low + (stroke.high - stroke.low) * stream_.uniform();
    if (stroke.side == Side::either && stream_.index(2) == 1) target = -target;
    motion.adjust(stroke.channel, target, act_->stroke_s);
  }
  --repeats_left_;
  next_ = tick_ + std::max<std::int64_t>(1, std::llround(act_->stroke_s * tick_rate_hz_));
}

void NaturalMotion::end_act(body::Motion& motion) {
  if (act_->after == After::returns) {
    for (const Stroke& stroke : act_->strokes) motion.adjust(stroke.channel, 0.0, act_->stroke_s);
  }
}

/// In steps, so that who breathes doesn't move at every tick.
void NaturalMotion::breathe(body::Motion& motion) const {
  const double breath = std::sin(2.0 * pi * (breath_phase_ + breath_hz * static_cast<double>(tick_) / tick_rate_hz_));
  motion.breathe(breath_tilt * std::round(breath * breath_levels) / breath_levels);
}

void NaturalMotion::tick(body::Motion& motion, std::optional<Activity> activity, const Attention& attention) {
  ++tick_;
  const Stage stage = motion.stage();
  if (stage == Stage::sitting_down || stage == Stage::rising) {
    if (act_ != nullptr) be_still();
    return;
  }
  breathe(motion);
  if (tick_ < next_) return;
  if (act_ == nullptr) {
    begin_act(stage == Stage::seated ? std::optional(activity.value_or(Activity::reading)) : std::nullopt,
              attention.talk);
  }
  if (repeats_left_ > 0) {
    stroke(motion);
    return;
  }
  end_act(motion);
  const double rest_s = act_->stroke_s;
  if (stream_.uniform() < goes_on) {
    act_ = nullptr;
    next_ = tick_ + std::llround(rest_s * tick_rate_hz_);
  } else {
    be_still();
    if (attention.talk == Attention::Talk::speaks) next_ = std::min(next_, tick_ + 2 * tick_rate_hz_);  // hands go on
    if (attention.talk == Attention::Talk::listens) {
      motion.adjust(Channel::head_turn, std::clamp(attention.towards, -50 * degree, 50 * degree), 0.8);
    }
  }
}

}  // namespace pirsim::sim
