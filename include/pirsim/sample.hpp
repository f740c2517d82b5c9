// What runs give: a row a window, and on request a trace row a tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pirsim {

// One row of output.

/// The reading at the end of one window: bits cover the ticks (time_s - window, time_s], everything else is the
/// state at time_s.
struct Sample {
  int replicate = 0;  ///< counts from 1
  std::string trial;
  double time_s = 0.0;
  std::string phase;
  int people = 0;                  ///< people whose pelvis stands over the floor area
  std::vector<std::uint8_t> bits;  ///< (n_sensors) 1 where the sensor saw motion
  bool operator==(const Sample&) const = default;
};

// What one sensor with an analog response received, made of it and why, at one tick.

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
