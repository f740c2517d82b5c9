#include "pir/edge_draw.hpp"

#include <algorithm>
#include <bit>

namespace pirsim::pir {

EdgeDraw::EdgeDraw(const MotionDetector& detector, std::size_t n_levels, int ticks_per_window)
    : n_levels_(n_levels),
      ticks_per_window_(ticks_per_window),
      n_words_(ZoneSet(detector.n_channels()).words().size()),
      watched_(detector.sensor_masks().begin(), detector.sensor_masks().end()) {
  channels_begin_.push_back(0);
  for (std::size_t sensor = 0; sensor < detector.n_sensors(); ++sensor) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < n_words_; ++i)
      n += static_cast<std::size_t>(std::popcount(watched_[sensor * n_words_ + i]));
    channels_begin_.push_back(channels_begin_.back() + n);
  }
}

void EdgeDraw::begin_run(std::uint64_t seed, std::uint32_t run) {
  streams_.clear();
  ticks_left_ = 0;
  for (std::uint32_t sensor = 0; sensor + 1 < channels_begin_.size(); ++sensor) {
    streams_.emplace_back(StreamKey{seed, run, sensor, Purpose::zone_edge});
  }
}

void EdgeDraw::tick() noexcept {
  if (n_levels_ == 1) return;
  if (ticks_left_ == 0) {
    ticks_left_ = ticks_per_window_;
    draw();
  }
  --ticks_left_;
}

void EdgeDraw::draw() noexcept {
  std::ranges::fill(watched_, ZoneSet::Word{0});
  for (std::size_t sensor = 0; sensor < streams_.size(); ++sensor) {
    const std::size_t begin = channels_begin_[sensor], n = (channels_begin_[sensor + 1] - begin) / n_levels_;
    ZoneSet::Word* watched = &watched_[sensor * n_words_];
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t level = streams_[sensor].index(static_cast<std::uint32_t>(n_levels_));
      const std::size_t channel = begin + level * n + i;
      watched[channel / ZoneSet::bits_per_word] |= ZoneSet::Word{1} << (channel % ZoneSet::bits_per_word);
    }
  }
}

}  // namespace pirsim::pir
