#include "pir/zone_motion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "pirsim/geometry.hpp"

namespace pirsim::pir {

Channels::Channels(const RayBundle& bundle, ChangePer change_per) : n_sensors_(bundle.n_sensors()) {
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

void Channels::add_channels(const ZoneSet& zones, ZoneSet& channels) const noexcept {
  std::size_t first = 0;
  for (ZoneSet::Word word : zones.words()) {
    for (; word != 0; word &= word - 1) {
      channels.insert(channel_of_zone_[first + static_cast<std::size_t>(std::countr_zero(word))]);
    }
    first += ZoneSet::bits_per_word;
  }
}

void Channels::mark(std::span<const ZoneSet::Word> before, std::span<const ZoneSet::Word> after,
                    std::span<const ZoneSet::Word> watched, std::span<std::uint8_t> bits) const noexcept {
  for (std::size_t i = 0; i < before.size(); ++i) {
    const ZoneSet::Word changed = before[i] ^ after[i];
    if (changed == 0) continue;
    for (std::size_t sensor = 0; sensor < n_sensors_; ++sensor) {
      if ((changed & watched[sensor * before.size() + i]) != 0) bits[sensor] |= 1U;
    }
  }
}

PolarityFilter::PolarityFilter(const SceneSpec& scene, const DualPolaritySpec& spec, std::size_t n_levels,
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

void PolarityFilter::begin_run(std::span<const double> rest) noexcept {
  for (std::size_t s = 0; s < filters_.size(); ++s) filters_[s] = {rest[s], rest[s]};
}

void PolarityFilter::add_up(const ZoneSet& zones, std::span<double> sums) const noexcept {
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

void PolarityFilter::tick(std::span<const double> sums, std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t s = 0; s < filters_.size(); ++s) {
    Filter& filter = filters_[s];
    filter.fast += fast_share_ * (sums[s] - filter.fast);
    filter.slow += slow_share_ * (filter.fast - filter.slow);
    if (std::abs(filter.fast - filter.slow) > threshold_) triggers[s] = 1;
  }
}

}  // namespace pirsim::pir
