#include "effects/catalogue.hpp"

namespace pirsim::effects {

Pipeline::Pipeline(std::span<const EffectSpec> effects, const StageContext& context) {
  for (const Effect* effect : catalogue()) {
    for (const EffectSpec& spec : effects) {
      if (spec.name != effect->info.name || is_off(spec)) continue;
      const EffectSpec complete = resolved(*effect, spec);
      if (effect->make_stage != nullptr) add(effect->make_stage(complete, context));
      if (effect->set_clocks != nullptr) effect->set_clocks(complete, context, clocks_);
      if (effect->make_row_stage != nullptr) add(effect->make_row_stage(complete, context));
    }
  }
}

Pipeline::Pipeline(const Pipeline& other) : clocks_(other.clocks_) {
  for (const auto& stage : other.trigger_stages_) add(stage->clone());
  for (const auto& stage : other.row_stages_) add(stage->clone());
}

Pipeline& Pipeline::operator=(const Pipeline& other) {
  Pipeline copy(other);
  return *this = std::move(copy);
}

void Pipeline::begin_run(std::uint64_t seed, std::uint32_t run) {
  for (const auto& stage : trigger_stages_) stage->begin_run(seed, run);
  clocks_.begin_run();
  for (const auto& stage : row_stages_) stage->begin_run(seed, run);
}

void Pipeline::seat_left(std::size_t seat) {
  for (const auto& stage : trigger_stages_) stage->seat_left(seat);
}

void Pipeline::hear(std::int64_t tick, std::span<std::uint8_t> triggers) {
  for (const auto& stage : trigger_stages_) stage->tick(tick, triggers);
  clocks_.hear(tick, triggers);
}

void Pipeline::apply(Sample& row) noexcept {
  for (const auto& stage : row_stages_) stage->apply(row);
}

}  // namespace pirsim::effects
