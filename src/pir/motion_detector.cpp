#include "pir/motion_detector.hpp"

#include <bit>

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

}  // namespace pirsim::pir
