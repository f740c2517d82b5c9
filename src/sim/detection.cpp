#include "sim/detection.hpp"

#include <algorithm>

namespace pirsim::sim {

Detector::Detector(const SensorArray& array)
    : array_(&array),
      edges_(array.channels(), array.n_levels(), array.soft_edges(), array.ticks_per_window(), array.tick_s()),
      polarity_(array.polarity()),
      outputs_(array.n_sensors()),
      analog_(array.analog() != nullptr ? array.n_sensors() : 0) {}

void Detector::begin_run(std::uint64_t seed, std::uint32_t run, const Exposure& rest) {
  edges_.begin_run(seed, run, rest.channels);
  if (polarity_) polarity_->begin_run(rest.sums);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (array_->zone_outputs()[i]) outputs_[i].emplace();
  }
  for (std::uint32_t i = 0; i < analog_.size(); ++i) {
    const AnalogModel& model = *array_->analog();
    const auto& sensor = model.sensors()[i];
    if (!sensor) continue;
    analog_[i] = sensor->detector.start(model.watts(i, rest.powers), {seed, run, i, Purpose::detector_noise});
  }
}

void Detector::tick(const Exposure& before, const Exposure& after, std::span<std::uint8_t> triggers) noexcept {
  tick_zones(before, after, triggers);
  advance_analog(after, triggers);
}

void Detector::tick_unchanged(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept {
  tick_zones_unchanged(exposure, triggers);
  advance_analog(exposure, triggers);
}

void Detector::tick_zones(const Exposure& before, const Exposure& after, std::span<std::uint8_t> triggers) noexcept {
  std::ranges::fill(triggers, std::uint8_t{0});
  if (polarity_) {
    polarity_->tick(after.sums, triggers);
  } else {
    edges_.tick(before.channels, after.channels, triggers);
  }
  switch_outputs(triggers);
}

void Detector::tick_zones_unchanged(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept {
  std::ranges::fill(triggers, std::uint8_t{0});
  if (polarity_) {
    polarity_->tick(exposure.sums, triggers);
  } else {
    edges_.tick_unchanged(exposure.channels, triggers);
  }
  switch_outputs(triggers);
}

void Detector::switch_outputs(std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (!outputs_[i]) continue;
    array_->zone_outputs()[i]->advance_to(*outputs_[i], triggers[i] != 0 ? 1 : 0);
    triggers[i] = outputs_[i]->on ? 1 : 0;
  }
}

void Detector::advance_analog(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t i = 0; i < analog_.size(); ++i) {
    if (!analog_[i]) continue;
    const AnalogModel& model = *array_->analog();
    model.sensors()[i]->detector.advance(*analog_[i], model.watts(i, exposure.powers));
    triggers[i] = pir::AnalogCircuit::on(*analog_[i]) ? 1 : 0;
  }
}

bool Detector::is_at_rest(const Exposure& exposure) const {
  if (is_memoryless()) return true;
  if (!polarity_ && !edges_.is_at_rest()) return false;
  Detector next(*this);
  std::vector<std::uint8_t> triggers(array_->n_sensors());
  next.tick_unchanged(exposure, triggers);
  const auto off = [](std::uint8_t trigger) { return trigger == 0; };
  return next.polarity_ == polarity_ && next.outputs_ == outputs_ && next.analog_ == analog_ &&
         std::ranges::all_of(triggers, off);
}

bool Detector::is_memoryless() const noexcept {
  const bool no_output =
      std::ranges::none_of(array_->zone_outputs(), [](const auto& output) { return output.has_value(); });
  return !polarity_ && no_output && analog_.empty() && array_->n_levels() == 1;
}

namespace {

pir::WindowReader in_step(std::size_t n_sensors, std::int32_t ticks_per_window) {
  return {std::vector<std::int32_t>(n_sensors, 0), ticks_per_window};
}

}  // namespace

Logger::Logger(const effects::Pipeline& stages, const SensingSpec& sensing, std::size_t n_sensors)
    : stages_(stages),
      kind_(sensing.reader),
      ticks_per_window_(sensing.ticks_per_window),
      n_sensors_(n_sensors),
      reader_(in_step(n_sensors, ticks_per_window_)) {}

void Logger::begin_run(std::uint64_t seed, std::uint32_t run) {
  stages_.begin_run(seed, run);
  tick_ = heard_ = 0;
  reader_ = kind_ == Reader::in_step
                ? in_step(n_sensors_, ticks_per_window_)
                : pir::WindowReader(pir::drawn_leads(n_sensors_, ticks_per_window_, seed, run), ticks_per_window_);
}

void Logger::complete(Sample& row) noexcept {
  row.bits.assign(reader_.readings().begin(), reader_.readings().end());
  stages_.apply(row);
}

}  // namespace pirsim::sim
