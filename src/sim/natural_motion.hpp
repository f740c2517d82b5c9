// What people of natural style do beside their choreography: stillness and small movements by turns, and breathing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "body/motion.hpp"
#include "pirsim/random.hpp"
#include "pirsim/script.hpp"

namespace pirsim::sim {

/// What a small movement is, for those who count them.
enum class ActKind { shift, fidget, task };

/// One movement of one channel: to a target drawn between the bounds, to either side if `either_side`.
struct Stroke {
  enum class Side { as_drawn, either };
  body::Channel channel;
  double low, high;  ///< metres or radians
  Side side = Side::as_drawn;
};

/// A small movement as data: strokes that begin together, repeated, each time with targets of their own.
struct Act {
  enum class After { returns, stays };
  const char* name;
  ActKind kind;
  std::span<const Stroke> strokes;
  double stroke_s;
  int fewest, most;  ///< repeats
  After after;
  const char* source;
};

/// All small movements that belong to an activity: its tasks, and the shifts and fidgets of every sitter.
[[nodiscard]] std::vector<Act> acts_of(Activity activity);

/// What a sitter has to do with who speaks in a meeting.
struct Attention {
  enum class Talk { none, listens, speaks } talk = Talk::none;
  double towards = 0.0;  ///< of a listener: the turn of the head that looks at who speaks, radians to the left
};

/// A value; draws from a stream of its own.
class NaturalMotion {
 public:
  NaturalMotion(std::uint64_t seed, std::uint32_t run, std::uint32_t person, int tick_rate_hz);

  /// Metres per second, this person's in this run: normal about the script's, cut at two standard deviations.
  [[nodiscard]] double pace(double scripted_m_s) const noexcept;
  /// One tick of somebody who sits or stands or walks; activity: of a sitter at work.
  void tick(body::Motion& motion, std::optional<Activity> activity, const Attention& attention);

  /// The act under way, if there is one.
  [[nodiscard]] const Act* act() const noexcept { return act_; }
  /// Acts begun so far, by kind.
  [[nodiscard]] std::int64_t begun(ActKind kind) const noexcept { return begun_[static_cast<std::size_t>(kind)]; }

 private:
  void begin_act(std::optional<Activity> activity, Attention::Talk talk);
  void stroke(body::Motion& motion);
  void end_act(body::Motion& motion);
  void be_still();
  void breathe(body::Motion& motion) const;
  [[nodiscard]] const Act& draw(std::span<const Act> acts);

  Stream stream_;
  int tick_rate_hz_ = 50;
  double liveliness_ = 1.0;  ///< rate relative to the mean person's
  double pace_ = 0.0;        ///< standard normal
  double breath_phase_ = 0.0;
  const Act* act_ = nullptr;
  int repeats_left_ = 0;
  std::int64_t tick_ = 0;
  std::int64_t next_ = 0;  ///< tick at which the next stroke or act begins
  std::int64_t begun_[3] = {};
};

}  // namespace pirsim::sim
