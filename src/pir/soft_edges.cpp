#include "pir/soft_edges.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "pirsim/geometry.hpp"

namespace pirsim::pir {
namespace {

constexpr double high_pass_hz = 0.3;          // assumed (0.1-0.5): corner of a common amplifier, as in dual_polarity
constexpr double no_difference = 1.0 / 64.0;  // of a zone; a filter that is so near has settled

}  // namespace

SoftEdges::SoftEdges(const Channels& detector, std::size_t n_levels, const SoftEdgesSpec& spec, int ticks_per_window,
                     double tick_s)
    : detector_(&detector),
      spec_(spec),
      n_levels_(n_levels),
      ticks_per_window_(ticks_per_window),
      n_words_(ZoneSet(detector.n_channels()).words().size()),
      watched_(detector.sensor_masks().begin(), detector.sensor_masks().end()),
      changed_(detector.n_channels()),
      forgets_(-std::expm1(-2.0 * pi * high_pass_hz * tick_s)),
      usual_(detector.n_channels() / n_levels, 0.0) {
  channels_begin_.push_back(0);
  for (std::size_t sensor = 0; sensor < detector.n_sensors(); ++sensor) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < n_words_; ++i)
      n += static_cast<std::size_t>(std::popcount(watched_[sensor * n_words_ + i]));
    channels_begin_.push_back(channels_begin_.back() + n);
  }
}

void SoftEdges::begin_run(std::uint64_t seed, std::uint32_t run, const ZoneSet& rest) {
  const Purpose purpose = spec_.rule == EdgeRule::swept_area ? Purpose::swept_area : Purpose::zone_edge;
  streams_.clear();
  ticks_left_ = 0;
  for (std::uint32_t sensor = 0; sensor + 1 < channels_begin_.size(); ++sensor)
    streams_.emplace_back(StreamKey{seed, run, sensor, purpose});
  for (std::size_t sensor = 0; sensor < streams_.size(); ++sensor) {
    const std::size_t first = channels_begin_[sensor] / n_levels_, n = channels_begin_[sensor + 1] / n_levels_ - first;
    for (std::size_t i = 0; i < n; ++i)
      usual_[first + i] = static_cast<double>(n_active(rest, sensor, i)) / static_cast<double>(n_levels_);
  }
  settled_ = true;
}

void SoftEdges::tick_levels(const ZoneSet& before, const ZoneSet& after, std::span<std::uint8_t> bits) noexcept {
  switch (spec_.rule) {
    case EdgeRule::drawn_edge:
      draw_edges();
      return detector_->mark(before.words(), after.words(), watched_, bits);
    case EdgeRule::covered_area:
      settled_ = settled_ && before == after;
      return filter(after, bits);
    case EdgeRule::swept_area:
      return notice_swept(before, after, bits);
  }
}

void SoftEdges::tick_unchanged(const ZoneSet& channels, std::span<std::uint8_t> bits) noexcept {
  if (n_levels_ == 1) return;
  if (spec_.rule == EdgeRule::drawn_edge) draw_edges();
  if (spec_.rule == EdgeRule::covered_area) filter(channels, bits);
}

bool SoftEdges::is_at_rest() const noexcept {
  return n_levels_ == 1 || spec_.rule == EdgeRule::swept_area || (spec_.rule == EdgeRule::covered_area && settled_);
}

int SoftEdges::n_active(const ZoneSet& channels, std::size_t sensor, std::size_t channel) const noexcept {
  const std::size_t begin = channels_begin_[sensor], n = (channels_begin_[sensor + 1] - begin) / n_levels_;
  int active = 0;
  for (std::size_t level = 0; level < n_levels_; ++level) {
    const std::size_t place = begin + level * n + channel;
    active += channels.test(place) ? 1 : 0;
  }
  return active;
}

void SoftEdges::draw_edges() noexcept {
  if (ticks_left_ > 0) {
    --ticks_left_;
    return;
  }
  ticks_left_ = ticks_per_window_ - 1;
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

void SoftEdges::filter(const ZoneSet& channels, std::span<std::uint8_t> bits) noexcept {
  if (settled_) return;
  settled_ = true;
  for (std::size_t sensor = 0; sensor < streams_.size(); ++sensor) {
    const std::size_t first = channels_begin_[sensor] / n_levels_, n = channels_begin_[sensor + 1] / n_levels_ - first;
    for (std::size_t i = 0; i < n; ++i) {
      const double share = static_cast<double>(n_active(channels, sensor, i)) / static_cast<double>(n_levels_);
      double& usual = usual_[first + i];
      if (std::abs(share - usual) > spec_.threshold) bits[sensor] = 1;
      usual += forgets_ * (share - usual);
      if (std::abs(share - usual) < no_difference) usual = share;
      settled_ = settled_ && usual == share;
    }
  }
}

void SoftEdges::notice_swept(const ZoneSet& before, const ZoneSet& after, std::span<std::uint8_t> bits) noexcept {
  if (before == after) return;
  for (std::size_t i = 0; i < n_words_; ++i) changed_.words()[i] = before.words()[i] ^ after.words()[i];
  for (std::size_t sensor = 0; sensor < streams_.size(); ++sensor) {
    const std::size_t n = (channels_begin_[sensor + 1] - channels_begin_[sensor]) / n_levels_;
    double missed = 1.0;
    for (std::size_t i = 0; i < n; ++i)
      missed *= 1.0 - static_cast<double>(n_active(changed_, sensor, i)) / static_cast<double>(n_levels_);
    if (missed < 1.0 && streams_[sensor].uniform() >= missed) bits[sensor] = 1;
  }
}

}  // namespace pirsim::pir
