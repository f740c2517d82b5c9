#include "pir/motion_detector.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "pirsim/geometry.hpp"

namespace pirsim::pir {

MotionDetector::MotionDetector(const RayBundle& bundle, ChangePer change_per) : n_sensors_(bundle.n_sensors()) {
  const bool per_cluster = change_per == ChangePer::cluster;
  n_channels_ = per_cluster ? bundle.n_clusters() : bundle.n_zones();
  for (std::uint32_t sensor = 0; sensor < n_sensors_; ++sensor) {
    ZoneSet mask(n_channels_);
    for (std::uint32_t c = bundle.sensor_clusters_begin[sensor]; c < bundle.sensor_clusters_begin[sensor + 1]; ++c) {
      for (std::uint32_t z = bundle.cluster_zones_begin[c]; z < bundle.cluster_zones_begin[c + 1]; ++z) {
        channel_of_zone_.push_back(per_cluster ? c : z);
        mask.insert(channel_of_zone_.back());
      }
    }
    sensor_masks_.insert(sensor_masks_.end(), mask.words().begin(), mask.words().end());
  }
}

void MotionDetector::add_channels(const ZoneSet& zones, ZoneSet& channels) const noexcept {
  std::size_t first = 0;
  for (ZoneSet::Word word : zones.words()) {
    for (; word != 0; word &= word - 1) {
      channels.insert(channel_of_zone_[first + static_cast<std::size_t>(std::countr_zero(word))]);
    }
    first += ZoneSet::bits_per_word;
  }
}

void MotionDetector::mark(std::span<const ZoneSet::Word> before, std::span<const ZoneSet::Word> after,
                          std::span<const ZoneSet::Word> watched, std::span<std::uint8_t> bits) const noexcept {
  for (std::size_t i = 0; i < before.size(); ++i) {
    const ZoneSet::Word changed = before[i] ^ after[i];
    if (changed == 0) continue;
    for (std::size_t sensor = 0; sensor < n_sensors_; ++sensor) {
      if ((changed & watched[sensor * before.size() + i]) != 0) bits[sensor] |= 1U;
    }
  }
}

PolarityDetector::PolarityDetector(const SceneSpec& scene, const DualPolaritySpec& spec, std::size_t n_levels,
                                   double tick_s)
    : threshold_(spec.threshold),
      fast_share_(-std::expm1(-2.0 * pi * spec.low_pass_hz * tick_s)),
      slow_share_(-std::expm1(-2.0 * pi * spec.high_pass_hz * tick_s)),
      filters_(scene.sensors.size()) {
  for (std::uint32_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
    for (std::size_t level = 0; level < n_levels; ++level) {
      for (const ClusterSpec& cluster : scene.sensor_models.at(scene.sensors[sensor].model).clusters) {
        for (const ZoneSpec& zone : cluster.zones) {
          weight_.push_back(zone.polarity / static_cast<double>(n_levels));
          sensor_.push_back(sensor);
        }
      }
    }
  }
}

void PolarityDetector::begin_run(std::span<const double> rest) noexcept {
  for (std::size_t s = 0; s < filters_.size(); ++s) filters_[s] = {rest[s], rest[s]};
}

void PolarityDetector::add_up(const ZoneSet& zones, std::span<double> sums) const noexcept {
  std::ranges::fill(sums, 0.0);
  std::size_t first = 0;
  for (ZoneSet::Word word : zones.words()) {
    for (; word != 0; word &= word - 1) {
      const std::size_t zone = first + static_cast<std::size_t>(std::countr_zero(word));
      sums[sensor_[zone]] += weight_[zone];
    }
    first += ZoneSet::bits_per_word;
  }
}

void PolarityDetector::tick(std::span<const double> sums, std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t s = 0; s < filters_.size(); ++s) {
    Filter& filter = filters_[s];
    filter.fast += fast_share_ * (sums[s] - filter.fast);
    filter.slow += slow_share_ * (filter.fast - filter.slow);
    if (std::abs(filter.fast - filter.slow) > threshold_) triggers[s] = 1;
  }
}

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
