// All analog sensors of a run as they are at one tick.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/analog_model.hpp"

namespace pirsim {
class Model;
}

namespace pirsim::sim {

/// A value.
class AnalogState {
 public:
  /// Everything has been still and nobody there for long.
  AnalogState(const Model& model, std::uint32_t run);

  /// (n_sensors) to be filled with what the sensors receive at the next tick.
  [[nodiscard]] std::span<PowerSteps> powers() noexcept { return powers_; }
  [[nodiscard]] std::span<const PowerSteps> powers() const noexcept { return powers_; }
  /// (n_sensors) at this tick; nothing for sensors that answer by their zones.
  [[nodiscard]] const std::vector<std::optional<pir::Detector::State>>& detectors() const noexcept {
    return detectors_;
  }
  /// Takes powers() in and writes the triggers of analog sensors; leaves the others'.
  void tick(const AnalogModel& model, std::span<std::uint8_t> triggers) noexcept;

 private:
  std::vector<PowerSteps> powers_;
  std::vector<std::optional<pir::Detector::State>> detectors_;
};

}  // namespace pirsim::sim
