// What people of natural style do with their bodies, as data: acts with amplitude, duration, frequency and source.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "engine/body/motion.hpp"
#include "engine/study/study_in_force.hpp"
#include "pirsim/random.hpp"
#include "pirsim/script.hpp"

namespace pirsim::sim {

/// What an act is to those who count them. All but tasks have rates of their own; tasks fill what is left.
enum class ActKind { shift, fidget, touch, look, task };
inline constexpr std::size_t n_habits = 4;  ///< kinds before tasks

/// One movement of one channel, to a target drawn between the bounds: relative to where the channel rests, or, of an
/// act that stays, to where it is at home.
struct Stroke {
  enum class Side { as_drawn, either };  ///< either: as often mirrored
  body::Channel channel;
  double low, high;  ///< metres, radians or shares
  Side side = Side::as_drawn;
};

/// Strokes that begin together, repeated so many times with targets of their own.
struct Act {
  enum class After { returns, stays };
  const char* name;
  double weight;  ///< how often, relative to the others of its kind
  std::span<const Stroke> strokes;
  double stroke_s;
  int fewest, most;  ///< repeats
  After after;
  const char* source;

  /// From the first stroke to the end of the way back.
  [[nodiscard]] constexpr double mean_s() const noexcept {
    return stroke_s * (0.5 * (fewest + most) + (after == After::returns ? 1.0 : 0.0));
  }
};

/// Where a channel is while nothing moves, if not at 0.
struct Hold {
  body::Channel channel;
  double value;
};

/// Still periods are log-normal up to the longest.
struct StillPeriods {
  double mean_s;         ///< were there no longest
  double goes_on = 0.0;  ///< probability that after an act another one follows at once: bouts
  double longest_s = std::numeric_limits<double>::infinity();

  [[nodiscard]] double length_s(Stream& stream) const noexcept;
  /// What is left of the period that one meets at a random moment of stillness.
  [[nodiscard]] double rest_s(Stream& stream) const noexcept;
  [[nodiscard]] double cut_mean_s() const noexcept;
  /// Of somebody who moves so many times as often; the longest stays.
  [[nodiscard]] StillPeriods at_rate(double rate) const noexcept { return {mean_s / rate, goes_on, longest_s}; }
};

/// Acts of a kind, and how often the mean person carries out one of them.
struct Habit {
  std::span<const Act> acts;
  double per_s = 0.0;
};

/// All that somebody does in one situation. Habits may be empty, tasks not.
struct Repertoire {
  std::array<Habit, n_habits> habits;  ///< in the order of ActKind
  std::span<const Act> tasks;
  std::span<const Hold> holds;
  StillPeriods still;

  [[nodiscard]] std::span<const Act> acts(ActKind kind) const noexcept {
    return kind == ActKind::task ? tasks : habits[static_cast<std::size_t>(kind)].acts;
  }
};

enum class Bearing { seated, standing, walking, lying };
enum class Talk { none, listens, speaks };
[[nodiscard]] const Repertoire& repertoire(Bearing bearing, std::optional<Activity> activity, Talk talk) noexcept;

// How people of natural style move beside their choreography: stillness and small acts by turns, and breathing.

/// What a person has to do with who speaks.
struct Attention {
  Talk talk = Talk::none;
  double towards = 0.0;      ///< of a listener: the turn of the head that looks at who speaks, radians to the left
  std::size_t n_others = 0;  ///< in the conversation
};

/// A value; draws from a stream of its own.
class NaturalMotion {
 public:
  NaturalMotion(std::uint64_t seed, std::uint32_t run, std::uint32_t person, int tick_rate_hz);

  /// Metres per second, this person's in this run: normal about the script's, cut at two standard deviations.
  [[nodiscard]] double pace(double scripted_m_s) const noexcept;
  /// This person's rate of all acts but tasks relative to the mean person's.
  [[nodiscard]] double liveliness() const noexcept { return liveliness_; }
  /// Before the first tick of somebody who has stood there all along: in the middle of a breath, and of the activity.
  void settle(body::Motion& motion, std::optional<Activity> activity) const;
  /// One tick of somebody who sits, stands or walks, before the body moves. activity: as the script says.
  void tick(body::Motion& motion, std::optional<Activity> activity, const Attention& attention);

  /// The act under way, if there is one.
  [[nodiscard]] const Act* act() const noexcept { return act_; }
  /// Acts begun so far, by kind.
  [[nodiscard]] std::int64_t begun(ActKind kind) const noexcept { return begun_[static_cast<std::size_t>(kind)]; }

 private:
  /// What the person is in the middle of; a change of it ends whatever was under way.
  struct Situation {
    Bearing bearing = Bearing::standing;
    std::optional<Activity> activity;
    bool operator==(const Situation&) const = default;
  };
  enum class Phase { still, moving, returning };

  void enter(body::Motion& motion, const Situation& situation);
  void attend(const Attention& attention);
  void begin_act();
  void stroke(body::Motion& motion);
  /// The seconds that it takes.
  double return_to_rest(body::Motion& motion);
  void be_still();
  void breathe(body::Motion& motion) const;
  void wait(double seconds);
  /// Between two acts on average, from beginning to beginning; and what is stillness of it.
  struct Cycle {
    double mean_s, still_s;
  };
  [[nodiscard]] Cycle cycle() const;
  [[nodiscard]] ActKind draw_kind();
  [[nodiscard]] double rate() const noexcept { return liveliness_ * company_; }
  [[nodiscard]] StillPeriods still() const noexcept { return repertoire().still.at_rate(rate()); }
  [[nodiscard]] double& rest_of(body::Channel channel) { return rest_[static_cast<std::size_t>(channel)]; }
  [[nodiscard]] const Repertoire& repertoire() const noexcept {
    return sim::repertoire(situation_->bearing, situation_->activity, talk_);
  }

  Stream stream_;
  int tick_rate_hz_ = 50;
  double liveliness_ = 1.0;  ///< of the person, on this day
  double company_ = 1.0;     ///< how much more those who listen move the more they are
  double pace_ = 0.0;        ///< standard normal
  double breath_hz_ = 0.25;
  double breath_phase_ = 0.0;
  std::optional<Situation> situation_;  ///< none on the way onto or off a seat
  Talk talk_ = Talk::none;
  /// Of each channel: where it belongs in this situation, and where it rests since the last shift.
  std::array<double, body::n_channels> home_{}, rest_{};
  Phase phase_ = Phase::still;
  const Act* act_ = nullptr;
  int repeats_left_ = 0;
  std::int64_t tick_ = 0;
  std::int64_t next_ = 0;  ///< tick at which the next stroke, way back or stillness begins
  std::array<std::int64_t, n_habits + 1> begun_{};
};

// Movements of somebody seated that no script asks for: what effects say about how people move.

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
