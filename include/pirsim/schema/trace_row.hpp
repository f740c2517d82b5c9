// What one sensor with an analog response received, made of it and why, at one tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace pirsim {

struct TraceRow {
  std::int64_t tick = 0;
  std::size_t sensor = 0;
  double power_w = 0.0;     ///< beyond what an empty room radiates; signed by the zones' polarities
  double signal_v = 0.0;    ///< above the offset, with noise, saturated
  std::uint8_t output = 0;  ///< of the comparator
  /// The zone (index within the sensor) and body part whose own share of the signal is the largest by amount. Element
  /// and amplifier are linear, so shares sum to the signal but for noise and saturation.
  std::size_t zone = 0;
  std::string_view person = {};  ///< empty while nothing but noise is in the signal, as is `part`
  std::string_view part = {};
  double share_v = 0.0;
  bool operator==(const TraceRow&) const = default;
};

}  // namespace pirsim
