// How people of natural style move beside their choreography: stillness and small acts by turns, and breathing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "body/motion.hpp"
#include "pirsim/random.hpp"
#include "sim/natural_acts.hpp"

namespace pirsim::sim {

/// What a person has to do with who speaks.
struct Attention {
  Talk talk = Talk::none;
  double towards = 0.0;  ///< of a listener: the turn of the head that looks at who speaks, radians to the left
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
  [[nodiscard]] double& rest_of(body::Channel channel) { return rest_[static_cast<std::size_t>(channel)]; }
  [[nodiscard]] const Repertoire& repertoire() const noexcept {
    return sim::repertoire(situation_->bearing, situation_->activity, talk_);
  }

  Stream stream_;
  int tick_rate_hz_ = 50;
  double liveliness_ = 1.0;
  double pace_ = 0.0;  ///< standard normal
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

}  // namespace pirsim::sim
