// Ensembles in two calls: record() follows people and rays once, replay() turns what the optics showed into rows as
// often as one likes, with other detectors and other seeds, at a small part of the cost.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/model.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/study.hpp"

namespace pirsim {

/// What the optics showed during one run.
struct RecordedRun {
  RunResult rows;          ///< as the study has them; of interest is all but the bits
  std::uint32_t rest = 0;  ///< number of the Recording's moment that stands before tick 1, and has for long
  /// (n_ticks) of those that follow from tick 1 on, beyond the last row as far as the study's clock_lag needs it.
  std::vector<std::uint32_t> moments;
  struct SeatLeft {
    std::int64_t tick = 0;
    std::size_t seat = 0;  ///< index into the scene's seats
  };
  std::vector<SeatLeft> seats_left;  ///< in order of time
};

/// What one analog sensor received at different moments, each different row once: a number a lens step in ascending
/// order, 2^-64 W more than from the empty room, exactly as runs have it, as if the step's facets had the aperture of
/// the first step's (OpticsSpec::aperture_mm2). The apertures of the others follow from the electronics, so that a
/// recording serves any.
struct PowerRows {
  std::size_t n_steps = 0;          ///< 0: the sensor answers by zones
  std::vector<std::int64_t> power;  ///< (n_rows x n_steps) the first row is zeros
};

/// Of each sensor it holds what its response needs: the zones, or the power that arrives.
struct Recording {
  /// Of active zones, each once; the first is the empty one. Zones of analog sensors are never among them.
  std::vector<ZoneSet> sets;
  std::vector<PowerRows> powers;  ///< (n_sensors)
  /// (n_moments x (1 + n_sensors)) What the optics showed, each once: which set, and which of each sensor's rows. Empty
  /// without analog sensors: then number i is sets[i].
  std::vector<std::uint32_t> moments;
  std::vector<RecordedRun> runs;
  std::size_t n_sensors = 0;
  SensingSpec sensing;  ///< how rows are read from triggers
  std::string optics;   ///< digest of all that what was shown depends on, people apart

  [[nodiscard]] std::size_t n_moments() const {
    return moments.empty() ? sets.size() : moments.size() / (1 + n_sensors);
  }
  [[nodiscard]] const ZoneSet& zones(std::uint32_t number) const {
    return sets[moments.empty() ? number : moments[number * (1 + n_sensors)]];
  }
  /// Of an analog sensor: (n_steps)
  [[nodiscard]] std::span<const std::int64_t> powers_of(std::uint32_t number, std::size_t sensor) const {
    const auto& [n_steps, power] = powers[sensor];
    return std::span(power).subspan(n_steps * moments[number * (1 + n_sensors) + 1 + sensor], n_steps);
  }
};

/// Follows the given runs of a study on up to `threads` threads (0: all cores). It takes 4 bytes a tick and run. Each
/// set of zones adds 32 bytes and a bit a zone; where there are analog sensors, each different moment adds 4 bytes a
/// sensor and each different row of a sensor 8 a lens step. An hour of eight people who move naturally under ten
/// sensors takes 2 MB if they answer by zones and 6 MB if they are analog. `run_done`, if given, is called after each
/// run, from one thread at a time; what it throws ends the work.
[[nodiscard]] Recording record(const Model& model, std::span<const std::uint32_t> runs, unsigned threads = 0,
                               const std::function<void()>& run_done = {});

/// How what the optics show becomes triggers: derive from it to try a detector of your own. One object serves many
/// runs, one after the other.
class DetectorLogic {
 public:
  virtual ~DetectorLogic() = default;
  /// Once, before any run: all zones and powers that there will be, to be prepared as the detector likes. The recording
  /// outlives the detector.
  virtual void prepare(const Recording& recording) = 0;
  /// All randomness follows from these two.
  virtual void begin_run(std::uint64_t seed, std::uint32_t run) = 0;
  /// From one tick to the next: sets triggers[s] to 1 where sensor s triggers (they come as 0). before, after: numbers
  /// of moments. What is `before` the first tick of a run has stood there for long.
  virtual void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept = 0;
};

/// The rows of recording.runs[index] as this detector gives them, which has been prepared with the recording.
[[nodiscard]] RunResult replay(const Recording& recording, std::size_t index, DetectorLogic& detector,
                               std::uint64_t seed);

struct EmitOptions {
  /// On triggers and rows, instead of those of the script. What the script's do to people, rays and zones is in the
  /// recording and stays.
  std::optional<std::vector<EffectSpec>> effects{};
  std::optional<std::uint64_t> seed{};  ///< instead of the script's
};

/// The rows of all recorded runs, in order, as the Model's own detectors give them: without options those of its study,
/// bit for bit. It may be another Model than the recorded one, with other electronics in its sensors, another seed or
/// other effects on triggers and rows; its people are not asked, they did what was recorded. Throws Error(usage) for a
/// Model whose room, seats, sensors' places, lenses, responses or ticks aren't the recorded ones, for effects among the
/// options that reach the geometry, and for a clock_lag that looks further ahead than was recorded, all of which need a
/// recording of their own; Error(input) for unknown effects; and what `consume` throws.
void emit(const Model& model, const Recording& recording, const EmitOptions& options,
          const std::function<void(const RunResult&)>& consume);

}  // namespace pirsim
