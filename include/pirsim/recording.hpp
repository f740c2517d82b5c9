// Ensembles in two calls: record() follows people and rays once, replay() turns what the optics showed into rows as
// often as one likes, with other detectors and other seeds, at a thousandth of the cost.
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

/// What the optics showed during one run, by numbers of the Recording.
struct RecordedRun {
  RunResult rows;          ///< as the study has them; of interest is all but the bits
  std::uint32_t rest = 0;  ///< what stands before tick 1, and has for long
  /// (n_ticks) from tick 1 on, beyond the last row as far as the study's clock_lag needs it.
  std::vector<std::uint32_t> shown;
  struct SeatLeft {
    std::int64_t tick = 0;
    std::size_t seat = 0;  ///< index into the scene's seats
  };
  std::vector<SeatLeft> seats_left;  ///< in order of time
};

/// Of each sensor it holds what its response needs: the zones, or the power that arrives.
struct Recording {
  /// Of active zones, each once; the first is the empty one. Zones of analog sensors are never among them.
  std::vector<ZoneSet> sets;
  /// (n_shown) Set and powers together are what the optics showed, each once. Empty without analog sensors: then number
  /// i is sets[i].
  std::vector<std::uint32_t> set_of;
  /// (n_shown x n_powers) 2^-64 W more than from the empty room, exactly as runs have it, by sensor and lens step in
  /// ascending order, each as if its facets had the aperture of the first step (OpticsSpec::aperture_mm2). The
  /// apertures of the others follow from the electronics, so that a recording serves any.
  std::vector<std::int64_t> powers;
  std::vector<std::uint32_t> powers_begin{0};  ///< (n_sensors + 1) the powers of sensor s begin there in each row
  std::vector<RecordedRun> runs;
  std::size_t n_sensors = 0;
  SensingSpec sensing;  ///< how rows are read from triggers
  std::string optics;   ///< digest of all that what was shown depends on, people apart

  [[nodiscard]] std::size_t n_shown() const { return set_of.empty() ? sets.size() : set_of.size(); }
  [[nodiscard]] const ZoneSet& zones(std::uint32_t shown) const { return sets[set_of.empty() ? shown : set_of[shown]]; }
  /// (n_powers)
  [[nodiscard]] std::span<const std::int64_t> powers_of(std::uint32_t shown) const {
    return std::span(powers).subspan(shown * n_powers(), n_powers());
  }
  [[nodiscard]] std::size_t n_powers() const { return powers_begin.back(); }
};

/// Follows the given runs of a study on up to `threads` threads (0: all cores). It takes 4 bytes a tick and run, 32 and
/// a bit a zone for each set of zones, and where there are analog sensors 4 and 8 a lens step and sensor for each
/// different row of powers. `run_done`, if given, is called after each run, from one thread at a time; what it throws
/// ends the work.
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
  /// of the recording. What is `before` the first tick of a run has stood there for long.
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
/// Model whose room, sensors' places, lenses, responses or ticks aren't the recorded ones, for effects among the
/// options that reach the geometry, and for a clock_lag that looks further ahead than was recorded, all of which need a
/// recording of their own; Error(input) for unknown effects; and what `consume` throws.
void emit(const Model& model, const Recording& recording, const EmitOptions& options,
          const std::function<void(const RunResult&)>& consume);

}  // namespace pirsim
