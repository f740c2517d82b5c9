// What counts as motion: the sensors' electronics turn what their optics see into triggers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pir/analog_detector.hpp"
#include "pir/motion_detector.hpp"
#include "pir/soft_edges.hpp"
#include "sim/sensor_array.hpp"

namespace pirsim::sim {

/// The detectors of all sensors of an array, each as its response asks: a change of a channel or the pair of opposite
/// polarity, with the counting, holding and blind time that come behind them, or the analog chain. Runs, recordings,
/// coverage studies and walk tests all decide by tick(). A value; the array outlives it.
class Detector {
 public:
  explicit Detector(const SensorArray& array);

  /// Forgets everything, and settles as if `rest` had been seen for long. Seed and run fix all randomness.
  void begin_run(std::uint64_t seed, std::uint32_t run, const Exposure& rest);
  /// From one tick to the next. triggers: (n_sensors) set to 1 where a sensor triggers at the later one, else to 0.
  void tick(const Exposure& before, const Exposure& after, std::span<std::uint8_t> triggers) noexcept;
  /// tick() with the same exposure before and after, without comparing it.
  void tick_unchanged(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept;
  /// True if tick_unchanged() would change nothing and trigger nothing.
  [[nodiscard]] bool is_at_rest(const Exposure& exposure) const;
  /// Whether a tick's triggers follow from its two exposures alone, in any run.
  [[nodiscard]] bool is_memoryless() const noexcept;

  /// (n_sensors) at the last tick; nothing for a sensor that answers by its zones. Empty without analog sensors.
  [[nodiscard]] const std::vector<std::optional<pir::AnalogDetector::State>>& analog() const noexcept {
    return analog_;
  }

 private:
  /// triggers: (n_sensors) changes of zones; set to 1 where the output behind them is on.
  void switch_outputs(std::span<std::uint8_t> triggers) noexcept;
  void advance_analog(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept;

  const SensorArray* array_;
  pir::SoftEdges edges_;
  std::optional<pir::PolarityDetector> polarity_;
  std::vector<std::optional<pir::Comparator::State>> outputs_;  ///< (n_sensors) behind zones, where there is any
  std::vector<std::optional<pir::AnalogDetector::State>> analog_;
};

}  // namespace pirsim::sim
