// What the files of single effects share.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "effects/catalogue.hpp"

namespace pirsim::effects {

/// One of the scene's sensors, or all.
[[nodiscard]] ChoiceInfo sensor_choice();

/// Indices of the sensors that an effect is for: the one named, or all.
[[nodiscard]] std::vector<std::uint32_t> sensors_of(const EffectSpec& effect, const SceneSpec& scene);

/// One stream a sensor of `sensors`, at its beginning for this run.
[[nodiscard]] std::vector<Stream> streams_of(const std::vector<std::uint32_t>& sensors, std::uint64_t seed,
                                             std::uint32_t run, Purpose purpose);

/// Ticks to the next event of a Poisson process, at least 1: its chance in each tick is 1 - exp(-mean), mean > 0.
[[nodiscard]] std::int64_t ticks_to_event(Stream& stream, double mean_per_tick) noexcept;

/// clone() by copying.
template <typename Stage>
class CloneableTriggerStage : public TriggerStage {
 public:
  [[nodiscard]] std::unique_ptr<TriggerStage> clone() const override {
    return std::make_unique<Stage>(static_cast<const Stage&>(*this));
  }
};
template <typename Stage>
class CloneableRowStage : public RowStage {
 public:
  [[nodiscard]] std::unique_ptr<RowStage> clone() const override {
    return std::make_unique<Stage>(static_cast<const Stage&>(*this));
  }
};

}  // namespace pirsim::effects
