#include "effects/kit.hpp"

#include <algorithm>
#include <cmath>

namespace pirsim::effects {

ChoiceInfo sensor_choice() { return {"sensor", ChoiceKind::sensor, {}, "all sensors"}; }

std::string word(const EffectSpec& effect, std::string_view choice) {
  if (const auto made = effect.choices.find(choice); made != effect.choices.end()) return made->second;
  return std::ranges::find(find(effect.name).info.choices, choice, &ChoiceInfo::name)->words.front();
}

std::vector<std::uint32_t> sensors_of(const EffectSpec& effect, const SceneSpec& scene) {
  const auto named = effect.choices.find("sensor");
  std::vector<std::uint32_t> sensors;
  for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
    if (named == effect.choices.end() || named->second == scene.sensors[i].id) sensors.push_back(i);
  }
  return sensors;
}

std::vector<Stream> streams_of(const std::vector<std::uint32_t>& sensors, std::uint64_t seed, std::uint32_t run,
                               Purpose purpose) {
  std::vector<Stream> streams;
  for (const std::uint32_t sensor : sensors) streams.emplace_back(StreamKey{seed, run, sensor, purpose});
  return streams;
}

std::int64_t ticks_to_event(Stream& stream, double mean_per_tick) noexcept {
  constexpr double never = 1e15;
  return 1 + static_cast<std::int64_t>(std::min(never, std::floor(-std::log1p(-stream.uniform()) / mean_per_tick)));
}

}  // namespace pirsim::effects
