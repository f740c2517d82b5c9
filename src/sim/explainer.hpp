// Why does an analog sensor's signal stand where it does?
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "pir/analog_circuit.hpp"
#include "pirsim/sample.hpp"
#include "sim/observer.hpp"
#include "sim/run_state.hpp"

namespace pirsim::sim {

/// Follows one run tick by tick. Gives every zone and body part an element and amplifier of its own: they are linear.
class Explainer {
 public:
  explicit Explainer(const CompiledStudy& study);
  /// Before the first step_tick(): whoever is there has been there for long and shares in no signal until they move.
  void settle(const RunState& state);
  /// After each step_tick(), from the first on; appends one row an analog sensor.
  void explain(const RunState& state, std::vector<TraceRow>& rows);

 private:
  /// Zone of the bundle, person, part.
  using Source = std::tuple<std::uint32_t, std::uint32_t, body::Part>;
  struct Share {
    pir::AnalogFilter::Sections sections{};
    double before_w = 0.0, now_w = 0.0;
  };

  void advance();
  [[nodiscard]] double watts(const PowerShare& share) const;

  const CompiledStudy& study_;
  PowerMeter meter_;
  std::vector<std::optional<pir::AnalogFilter>> filters_;  ///< (n_sensors) without noise
  std::vector<std::uint32_t> sensor_of_zone_, zone_of_ray_;
  std::map<Source, Share> shares_;  ///< of all that ever brought power
  std::vector<PowerShare> met_;     ///< scratch
};

}  // namespace pirsim::sim
