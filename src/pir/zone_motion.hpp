// Detectors without a circuit: active zones to triggers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/random.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "schema/study_in_force.hpp"

namespace pirsim::pir {

/// A sensor sees motion where the activity of one of its channels changes from one tick to the next. A channel is a
/// beam's zone, or a cluster of them, which is active where any of its zones is.
class Channels {
 public:
  Channels(const RayBundle& bundle, ChangePer change_per);

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
  /// Marks sensors by changes of the channels that are watched alone. watched: (n_sensors x words of a channel set).
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

// The pyroelectric pair: zones of either sign, a band-pass, a threshold.

/// A sensor triggers while the filtered sum of its active zones, each with its element's sign, is beyond the threshold
/// on either side. Zones of both signs under one person cancel, slow changes leak away. A value.
class PolarityFilter {
 public:
  /// n_levels: copies of every zone (pir::append), which share its weight.
  PolarityFilter(const SceneSpec& scene, const DualPolaritySpec& spec, std::size_t n_levels, double tick_s);

  /// rest: (n_sensors) sums of the signs of zones that have been active for long.
  void begin_run(std::span<const double> rest) noexcept;
  /// sums: (n_sensors) of the signs of active zones.
  void add_up(const ZoneSet& zones, std::span<double> sums) const noexcept;
  /// One tick; sets triggers[s] (n_sensors) where sensor s triggers.
  void tick(std::span<const double> sums, std::span<std::uint8_t> triggers) noexcept;
  [[nodiscard]] std::size_t n_sensors() const noexcept { return filters_.size(); }
  bool operator==(const PolarityFilter&) const = default;

 private:
  struct Filter {
    double fast = 0.0;  ///< low-passed sum
    double slow = 0.0;  ///< what the high-pass takes off it
    bool operator==(const Filter&) const = default;
  };
  std::vector<double> weight_;         ///< (n_zones)
  std::vector<std::uint32_t> sensor_;  ///< (n_zones)
  double threshold_;
  double fast_share_, slow_share_;  ///< of the difference that is taken over in a tick
  std::vector<Filter> filters_;     ///< (n_sensors)
};

}  // namespace pirsim::pir
