// Soft edges of zones: every window draws anew where each channel's edges are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pir/motion_detector.hpp"
#include "pirsim/random.hpp"
#include "pirsim/rays.hpp"

namespace pirsim::pir {

/// Which channels are watched at a tick. Each channel has n_levels nested copies (pir::append); in a window one of
/// them, drawn with even odds, tells whether there was motion. Somebody who stands still changes none of them. With one
/// level it is that one, and nothing is drawn. A value.
class EdgeDraw {
 public:
  EdgeDraw() = default;
  EdgeDraw(const MotionDetector& detector, std::size_t n_levels, int ticks_per_window);

  void begin_run(std::uint64_t seed, std::uint32_t run);
  /// Once a tick, from the first on.
  void tick() noexcept;
  /// (n_sensors x words of a channel set)
  [[nodiscard]] std::span<const ZoneSet::Word> watched() const noexcept { return watched_; }

 private:
  void draw() noexcept;

  std::size_t n_levels_ = 1;
  int ticks_per_window_ = 1;
  int ticks_left_ = 0;  ///< of the window
  std::size_t n_words_ = 0;
  std::vector<std::size_t> channels_begin_;  ///< (n_sensors + 1)
  std::vector<Stream> streams_;              ///< (n_sensors)
  std::vector<ZoneSet::Word> watched_;
};

}  // namespace pirsim::pir
