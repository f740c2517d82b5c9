// Ensembles in two calls: record() follows people and rays once, replay() turns what the zones did into rows as often
// as one likes, with other detectors and other seeds, at a thousandth of the cost.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pirsim/model.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/study.hpp"

namespace pirsim {

/// What the zones did during one run.
struct RecordedRun {
  RunResult rows;          ///< as the study has them; of interest is all but the bits
  std::uint32_t rest = 0;  ///< index into Recording::sets: what stands before tick 1, and has for long
  /// (n_ticks) from tick 1 on: indices into Recording::sets. They go on beyond the last row as far as the study's
  /// clock_lag needs them.
  std::vector<std::uint32_t> sets;
  struct SeatLeft {
    std::int64_t tick = 0;
    std::size_t seat = 0;  ///< index into the scene's seats
  };
  std::vector<SeatLeft> seats_left;  ///< in order of time
};

struct Recording {
  std::vector<ZoneSet> sets;  ///< of active zones, each once; the first is the empty one
  std::vector<RecordedRun> runs;
  std::size_t n_sensors = 0;
  SensingSpec sensing;  ///< how rows are read from triggers
};

/// Follows the given runs of a study on up to `threads` threads (0: all cores), with 4 bytes a tick and run. Throws
/// Error(usage) for sensors with an analog response, which zones alone don't explain. `run_done`, if given, is called
/// after each run, from one thread at a time; what it throws ends the work.
[[nodiscard]] Recording record(const Model& model, std::span<const std::uint32_t> runs, unsigned threads = 0,
                               const std::function<void()>& run_done = {});

/// How zones become triggers: derive from it to try a detector of your own. One object serves many runs, one after the
/// other.
class DetectorLogic {
 public:
  virtual ~DetectorLogic() = default;
  /// Once, before any run: all sets of zones that there will be, to be prepared as the detector likes.
  virtual void prepare(std::span<const ZoneSet> sets) = 0;
  /// All randomness follows from these two.
  virtual void begin_run(std::uint64_t seed, std::uint32_t run) = 0;
  /// From one tick to the next: sets triggers[s] to 1 where sensor s triggers (they come as 0). before, after: indices
  /// of sets. What is `before` the first tick of a run has stood there for long.
  virtual void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept = 0;
};

/// The rows of recording.runs[index] as this detector gives them, which has been prepared with recording.sets.
[[nodiscard]] RunResult replay(const Recording& recording, std::size_t index, DetectorLogic& detector,
                               std::uint64_t seed);

struct EmitOptions {
  /// On triggers and rows, instead of those of the script. What the script's do to people, rays and zones is in the
  /// recording and stays.
  std::optional<std::vector<EffectSpec>> effects{};
  std::optional<std::uint64_t> seed{};  ///< instead of the script's
};

/// The rows of all recorded runs, in order, as the Model's own detector gives them: without options the study's, bit
/// for bit. Throws Error(input) for unknown effects, Error(usage) for effects that reach the geometry or a clock_lag
/// that looks further ahead than was recorded, which need a Model of their own; and what `consume` throws.
void emit(const Model& model, const Recording& recording, const EmitOptions& options,
          const std::function<void(const RunResult&)>& consume);

}  // namespace pirsim
