// From zone activity to motion, on bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/script.hpp"

namespace pirsim::pir {

/// A sensor sees motion where the activity of one of its channels changes from one tick to the next. A channel is a
/// beam's zone, or a cluster of them, which is active where any of its zones is.
class MotionDetector {
 public:
  MotionDetector(const RayBundle& bundle, ChangePer change_per);

  [[nodiscard]] std::size_t n_zones() const noexcept { return channel_of_zone_.size(); }
  [[nodiscard]] std::size_t n_channels() const noexcept { return n_channels_; }
  [[nodiscard]] std::size_t n_sensors() const noexcept { return n_sensors_; }
  /// Adds the channels that are active with these zones.
  void add_channels(const ZoneSet& zones, ZoneSet& channels) const noexcept;
  /// bits[s] |= 1 where a channel of sensor s differs. before, after: of n_channels, as words; bits: (n_sensors).
  void mark(std::span<const ZoneSet::Word> before, std::span<const ZoneSet::Word> after,
            std::span<std::uint8_t> bits) const noexcept {
    mark(before, after, sensor_masks_, bits);
  }
  /// The same where only some channels are watched. watched: (n_sensors x words of a channel set).
  void mark(std::span<const ZoneSet::Word> before, std::span<const ZoneSet::Word> after,
            std::span<const ZoneSet::Word> watched, std::span<std::uint8_t> bits) const noexcept;
  /// Every sensor's channels: (n_sensors x words of a channel set).
  [[nodiscard]] std::span<const ZoneSet::Word> sensor_masks() const noexcept { return sensor_masks_; }

 private:
  std::size_t n_channels_ = 0;
  std::size_t n_sensors_ = 0;
  std::vector<std::uint32_t> channel_of_zone_;
  std::vector<ZoneSet::Word> sensor_masks_;  ///< (n_sensors x words of a channel set)
};

}  // namespace pirsim::pir
