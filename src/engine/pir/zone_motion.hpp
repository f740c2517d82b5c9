// Detectors without a circuit: active zones to triggers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/pir/analog_circuit.hpp"
#include "engine/study/study_in_force.hpp"
#include "pirsim/random.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "pirsim/sensor.hpp"

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

// Zones whose sensitivity falls off smoothly: what counts as motion there.

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

// What each response keeps of a sensor's circuit: the comparator's counting, holding and blind time.

/// Behind zones, the signal is outside the window at the ticks at which a zone changes; which side it would be on isn't
/// known, so that pulses of any sign count. None if the output is on at just the ticks at which the signal is outside,
/// and behind a beam.
[[nodiscard]] std::optional<Comparator> output_of(const DetectorSpec& spec, Response response, double tick_s);

// Who asks the sensors, once a window, whether they have seen motion.

/// Latches each sensor's triggers and reads and clears the latch once a window; a reader that isn't in step with the
/// rows reads each sensor some ticks before a row ends, so that what comes later shows in the next row.
/// [Stefansson2021] says no more of its reader than that it "measures movement roughly once per second".
class WindowReader {
 public:
  /// lead_ticks: (n_sensors) ticks before the end of a row at which a sensor is read, each in [0, ticks_per_window).
  WindowReader(std::vector<std::int32_t> lead_ticks, std::int32_t ticks_per_window);

  /// One tick more has ended; triggers: (n_sensors), not 0 where the output was on.
  void advance(std::span<const std::uint8_t> triggers) noexcept;
  /// (n_sensors) what was read last: 1 for motion, at first 0.
  [[nodiscard]] std::span<const std::uint8_t> readings() const noexcept { return readings_; }
  /// Neither latched nor read any motion: whole windows without triggers leave it as it is.
  [[nodiscard]] bool is_at_rest() const noexcept;
  bool operator==(const WindowReader&) const = default;

 private:
  std::int32_t ticks_per_window_;
  std::vector<std::int32_t> ticks_left_;  ///< (n_sensors) until the sensor is read
  std::vector<std::uint8_t> latches_, readings_;
};

/// For each sensor a lead of its own, each equally likely, drawn for this run.
[[nodiscard]] std::vector<std::int32_t> drawn_leads(std::size_t n_sensors, std::int32_t ticks_per_window,
                                                    std::uint64_t seed, std::uint32_t run);

}  // namespace pirsim::pir
