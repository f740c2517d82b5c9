#include "sim/analog_state.hpp"

#include "sim/model.hpp"

namespace pirsim::sim {

AnalogState::AnalogState(const Model& model, std::uint32_t run) {
  if (!model.analog()) return;
  const auto& sensors = model.analog()->sensors();
  powers_.resize(sensors.size(), 0);
  for (std::uint32_t i = 0; i < sensors.size(); ++i) {
    detectors_.emplace_back();
    if (!sensors[i]) continue;
    detectors_.back() = sensors[i]->detector.start(0.0, {model.script().seed, run, i, Purpose::detector_noise});
  }
}

void AnalogState::tick(const AnalogModel& model, std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t i = 0; i < detectors_.size(); ++i) {
    if (!detectors_[i]) continue;
    const double power_w = static_cast<double>(powers_[i]) * watts_per_step;
    model.sensors()[i]->detector.advance(*detectors_[i], power_w);
    triggers[i] = pir::Detector::on(*detectors_[i]) ? 1 : 0;
  }
}

}  // namespace pirsim::sim
