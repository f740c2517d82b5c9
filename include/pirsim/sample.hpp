// What runs give: a row a window, and on request a trace row a tick; and how a study is cut into blocks of runs.
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

/// Runs first, first + 1, ... end - 1 of a study.
struct RunRange {
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  [[nodiscard]] std::uint32_t count() const noexcept { return end - first; }
  bool operator==(const RunRange&) const = default;
};

/// The index-th (from 1) of `count` blocks.
struct Shard {
  std::uint32_t index = 1;
  std::uint32_t count = 1;
  bool operator==(const Shard&) const = default;
};

/// Contiguous blocks whose sizes differ by one run at most; together they are all runs, each once. Blocks are empty
/// where there are more shards than runs.
[[nodiscard]] constexpr RunRange runs_of(const Shard& shard, std::uint32_t n_runs) noexcept {
  const auto cut = [&](std::uint64_t blocks) { return static_cast<std::uint32_t>(n_runs * blocks / shard.count); };
  return {cut(shard.index - 1), cut(shard.index)};
}

}  // namespace pirsim
