// What runs give: a row a window, and on request a trace row a tick; and how a study is cut into blocks of runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim {

// What stands in a row where nobody knows.
inline constexpr std::uint8_t unknown_bit = 2;  ///< nobody knows; it counts for nothing
inline constexpr std::uint8_t absent_bit = 3;   ///< the room of these rows has no such sensor, or no such door
inline constexpr int unknown_people = -1, absent_people = -2;  ///< absent: the room has no such area

// One row of output.

/// The reading at the end of one window: bits cover the ticks (time_s - window, time_s], everything else is the
/// state at time_s.
struct Sample {
  int replicate = 0;  ///< counts from 1
  std::string trial;
  double time_s = 0.0;
  std::string phase;                   ///< what the first person does; with a schedule what the room is used for
  int people = 0;                      ///< people whose pelvis stands over the floor area
  std::vector<std::uint8_t> bits;      ///< (n_sensors) 1 where the sensor saw motion
  std::string clock{};                 ///< "2026-03-02T08:30:00" of time_s; empty without a clock
  std::vector<int> people_of_areas{};  ///< (n_areas, and the rest of the floor if there is one) they sum to people
  std::vector<std::uint8_t> doors{};   ///< (n_doors) 1 where one isn't shut, at time_s
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

/// All frames of one thermopile array in one run.
struct FrameStack {
  int rows = 0, columns = 0;
  std::vector<double> times_s;  ///< (n_frames)
  std::vector<float> celsius;   ///< (n_frames x rows x columns) from the upper left as the array looks; NaN: dead
};

// What happened in a run beside its rows.

/// One person at the end of one window, while they are there.
struct OccupantRow {
  double time_s = 0.0;
  std::string clock;  ///< as a Sample's
  std::string person;
  std::string activity;  ///< as a Sample's phase, of this person
  std::string seat;      ///< taken, from setting out for it to walking away from it; or empty
  Vec2 place_m{0.0};     ///< x and z of the pelvis
  enum class Where { inside, outside } where = Where::inside;  ///< over the floor area, or in a doorway
  std::string area{};                                          ///< of somebody inside, if the scene has areas
};

/// Between people, or a person and a seat; nothing of it ends a run.
enum class IncidentKind {
  passed_through,  ///< two people who had found no way round each other went through each other
  seat_changed,    ///< the seat was taken; another one was free
  seat_missed,     ///< the seat stayed taken; the person went on with what comes next
  waited_outside   ///< the seat was taken when the person came for it; they have waited outside for 10 s already
};

struct RunIncident {
  IncidentKind kind = IncidentKind::passed_through;
  double time_s = 0.0;
  std::string person;
  Vec2 place_m{0.0};  ///< x and z on the floor
};

/// Why a run could not go on; others are not concerned.
struct RunFault {
  double time_s = 0.0;
  std::string message;
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
