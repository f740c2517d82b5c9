#include "engine/effects/pipeline.hpp"

#include <algorithm>
#include <cmath>

#include "engine/effects/catalogue.hpp"
#include "engine/pir/zone_motion.hpp"
#include "pirsim/response.hpp"

namespace pirsim::effects {

void Clocks::set(std::size_t n_sensors, std::uint32_t sensor, double lag_ticks, double drift) {
  clocks_.resize(n_sensors);
  clocks_[sensor] = {lag_ticks, drift};
}

bool Clocks::any_early() const noexcept {
  return std::ranges::any_of(clocks_, [](const Clock& clock) { return clock.lag_ticks < 0.0 || clock.drift < 0.0; });
}

void Clocks::begin_run() {
  for (Clock& clock : clocks_) clock.on_the_way.clear();
}

std::int64_t Clocks::logged_at(const Clock& clock, std::int64_t tick) noexcept {
  return tick + std::llround(clock.lag_ticks + clock.drift * static_cast<double>(tick));
}

void Clocks::hear(std::int64_t tick, std::span<const std::uint8_t> triggers) {
  for (std::size_t sensor = 0; sensor < clocks_.size(); ++sensor) {
    if (triggers[sensor] == 0) continue;
    const std::int64_t logged = logged_at(clocks_[sensor], tick);
    if (logged >= 1) clocks_[sensor].on_the_way.push_back(logged);
  }
}

std::int64_t Clocks::heard_by(std::int64_t tick) const noexcept {
  std::int64_t last = tick;
  for (const Clock& clock : clocks_) {
    // Rounding moves a tick by half of one, so that a slow clock may still log a little more at the same tick.
    const double exact = (static_cast<double>(tick) + 0.5 - clock.lag_ticks) / (1.0 + clock.drift);
    auto heard = static_cast<std::int64_t>(std::ceil(exact)) + 1;
    while (heard > last && logged_at(clock, heard) > tick) --heard;
    last = std::max(last, heard);
  }
  return last;
}

void Clocks::log(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t sensor = 0; sensor < clocks_.size(); ++sensor) {
    std::deque<std::int64_t>& on_the_way = clocks_[sensor].on_the_way;
    triggers[sensor] = 0;
    for (; !on_the_way.empty() && on_the_way.front() <= tick; on_the_way.pop_front()) triggers[sensor] = 1;
  }
}

Pipeline::Pipeline(std::span<const EffectSpec> effects, const StageContext& context) {
  for (const Effect* effect : catalogue()) {
    for (const EffectSpec& spec : effects) {
      if (spec.name != effect->info.name || is_off(spec)) continue;
      const EffectSpec complete = resolved(*effect, spec);
      if (effect->make_stage != nullptr) add(effect->make_stage(complete, context));
      if (effect->make_output_stage != nullptr) add_behind_output(effect->make_output_stage(complete, context));
      if (effect->set_clocks != nullptr) effect->set_clocks(complete, context, clocks_);
      if (effect->make_row_stage != nullptr) add(effect->make_row_stage(complete, context));
    }
  }
  for (std::size_t i = 0; i < context.scene.sensors.size() && !trigger_stages_.empty(); ++i) {
    const auto model = context.scene.sensor_models.find(context.scene.sensors[i].model);
    if (model == context.scene.sensor_models.end()) continue;
    const Response response = response_of(context.scene, context.sensing, context.scene.sensors[i]);
    const auto output = pir::output_of(model->second.detector, response, 1.0 / context.sensing.tick_rate_hz);
    if (output) outputs_.push_back({i, *output});
  }
}

Pipeline::Pipeline(const Pipeline& other) : outputs_(other.outputs_), clocks_(other.clocks_) {
  for (const auto& stage : other.trigger_stages_) add(stage->clone());
  for (const auto& stage : other.output_stages_) add_behind_output(stage->clone());
  for (const auto& stage : other.row_stages_) add(stage->clone());
}

Pipeline& Pipeline::operator=(const Pipeline& other) {
  Pipeline copy(other);
  return *this = std::move(copy);
}

void Pipeline::begin_run(std::uint64_t seed, std::uint32_t run) {
  for (const auto& stage : trigger_stages_) stage->begin_run(seed, run);
  for (Output& output : outputs_) output.state = {};
  for (const auto& stage : output_stages_) stage->begin_run(seed, run);
  clocks_.begin_run();
  for (const auto& stage : row_stages_) stage->begin_run(seed, run);
}

void Pipeline::seat_left(std::size_t seat) {
  for (const auto& stage : trigger_stages_) stage->seat_left(seat);
  for (const auto& stage : output_stages_) stage->seat_left(seat);
}

void Pipeline::hear(std::int64_t tick, std::span<std::uint8_t> triggers) {
  for (auto& [sensor, comparator, state] : outputs_) {
    const auto signal = triggers[sensor] & pir::signal_above ? 1 : triggers[sensor] & pir::signal_below ? -1 : 0;
    triggers[sensor] = comparator.counts(state, static_cast<std::int8_t>(signal)) ? pir::output_on : std::uint8_t{0};
  }
  for (std::uint8_t& trigger : triggers) trigger &= pir::output_on;
  for (const auto& stage : trigger_stages_) stage->tick(tick, triggers);
  for (auto& [sensor, comparator, state] : outputs_) {
    comparator.report(state, triggers[sensor] != 0);
    triggers[sensor] = state.on ? pir::output_on : std::uint8_t{0};
  }
  for (const auto& stage : output_stages_) stage->tick(tick, triggers);
  clocks_.hear(tick, triggers);
}

void Pipeline::apply(Sample& row) noexcept {
  for (const auto& stage : row_stages_) stage->apply(row);
}

}  // namespace pirsim::effects
