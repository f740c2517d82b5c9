// What motion is: what the sensors' electronics make of what their optics show them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pir/analog_detector.hpp"
#include "pir/motion_detector.hpp"
#include "sim/sensor_array.hpp"

namespace pirsim::sim {

/// The detectors of all sensors of an array, each as its response asks: a change of a channel, the pair of opposite
/// polarity, or the analog chain. Runs, recordings, coverage studies and walk tests all decide by tick(). A value; the
/// array outlives it.
class Detector {
 public:
  explicit Detector(const SensorArray& array);

  /// Forgets everything: before the run, `rest` has stood for long. All randomness follows from seed and run.
  void begin_run(std::uint64_t seed, std::uint32_t run, const Exposure& rest);
  /// From one tick to the next. triggers: (n_sensors) set to 1 where a sensor triggers at the later one, else to 0.
  void tick(const Exposure& before, const Exposure& after, std::span<std::uint8_t> triggers) noexcept;
  /// tick() where nothing that is seen changes.
  void tick_unchanged(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept;
  /// Would tick_unchanged() leave everything as it is, without a trigger?
  [[nodiscard]] bool is_at_rest(const Exposure& exposure) const;
  /// Whether a tick's triggers follow from its two exposures alone, in any run.
  [[nodiscard]] bool is_memoryless() const noexcept;

  /// (n_sensors) at the last tick; nothing for a sensor that answers by its zones. Empty without analog sensors.
  [[nodiscard]] const std::vector<std::optional<pir::AnalogDetector::State>>& analog() const noexcept {
    return analog_;
  }

 private:
  void advance_analog(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept;

  const SensorArray* array_;
  pir::EdgeDraw edge_draw_;
  std::optional<pir::PolarityDetector> polarity_;
  std::vector<std::optional<pir::AnalogDetector::State>> analog_;
};

}  // namespace pirsim::sim
