// Zones whose sensitivity falls off smoothly: what counts as motion there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pir/zone_motion.hpp"
#include "pirsim/random.hpp"
#include "pirsim/rays.hpp"
#include "schema/study_in_force.hpp"

namespace pirsim::pir {

/// Each channel has n_levels nested copies (pir::append), which stand for a sensitivity that falls off smoothly: as
/// many are active as the covered share says. What counts as motion is a rule; somebody who stands still is none by
/// any.
/// - drawn_edge: in a window one of the copies, drawn with even odds, tells whether there was motion.
/// - covered_area: the covered share, filtered by a high pass, is beyond the threshold.
/// - swept_area: of what changes at a tick, each channel notices with a chance of the share of its copies that do.
/// With one level all are the change of that one, and nothing is drawn. A value; the detector outlives it.
class SoftEdges {
 public:
  SoftEdges(const Channels& detector, std::size_t n_levels, const SoftEdgesSpec& spec, int ticks_per_window,
            double tick_s);

  /// rest: channels that have been active for long.
  void begin_run(std::uint64_t seed, std::uint32_t run, const ZoneSet& rest);
  /// Once a tick, from the first on. bits[s] |= 1 where sensor s sees motion. before, after: channels.
  void tick(const ZoneSet& before, const ZoneSet& after, std::span<std::uint8_t> bits) noexcept {
    if (n_levels_ == 1) return detector_->mark(before.words(), after.words(), bits);
    tick_levels(before, after, bits);
  }
  /// tick() with the same channels before and after, without comparing them.
  void tick_unchanged(const ZoneSet& channels, std::span<std::uint8_t> bits) noexcept;
  /// True if tick_unchanged() would change nothing and trigger nothing.
  [[nodiscard]] bool is_at_rest() const noexcept;

 private:
  void tick_levels(const ZoneSet& before, const ZoneSet& after, std::span<std::uint8_t> bits) noexcept;
  void draw_edges() noexcept;
  void filter(const ZoneSet& channels, std::span<std::uint8_t> bits) noexcept;
  void notice_swept(const ZoneSet& before, const ZoneSet& after, std::span<std::uint8_t> bits) noexcept;
  /// Active copies among the words of a channel set.
  [[nodiscard]] int n_active(const ZoneSet& channels, std::size_t sensor, std::size_t channel) const noexcept;

  const Channels* detector_;
  SoftEdgesSpec spec_;
  std::size_t n_levels_;
  int ticks_per_window_;
  int ticks_left_ = 0;  ///< of the window
  std::size_t n_words_;
  std::vector<std::size_t> channels_begin_;  ///< (n_sensors + 1)
  std::vector<Stream> streams_;              ///< (n_sensors)
  std::vector<ZoneSet::Word> watched_;       ///< drawn_edge: (n_sensors x n_words)
  ZoneSet changed_;                          ///< swept_area: scratch
  double forgets_;             ///< covered_area: share of the difference that the high pass takes off a tick
  std::vector<double> usual_;  ///< covered_area: (n_channels / n_levels) covered share that is no news
  bool settled_ = true;        ///< covered_area: the covered shares are the usual ones
};

}  // namespace pirsim::pir
