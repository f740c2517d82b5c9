// Ensembles in two calls: trace() follows people and rays once, emit() turns what the zones did into rows as often as
// one likes, with other detectors and other seeds, at a thousandth of the cost.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pir/motion_detector.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/rays.hpp"
#include "sim/model.hpp"
#include "sim/study.hpp"

namespace pirsim::sim {

/// What the zones did during one run.
struct ZoneTrack {
  RunResult rows;                   ///< as the study has them; of interest is all but the bits
  std::vector<std::uint32_t> sets;  ///< (n_ticks) from tick 1 on: index into ZoneTracks::sets
  struct SeatLeft {
    std::int64_t tick = 0;
    std::size_t seat = 0;  ///< index into the scene's seats
  };
  std::vector<SeatLeft> seats_left;  ///< in order of time
};

struct ZoneTracks {
  std::vector<ZoneSet> sets;  ///< each once; the first is the empty one, which stands before tick 1
  std::vector<ZoneTrack> runs;
  std::size_t n_sensors = 0;
  int ticks_per_window = 50;
  Reader reader = Reader::in_step;
};

/// Follows the given runs of a study on up to `threads` threads (0: all cores), with 4 bytes a tick and run.
[[nodiscard]] ZoneTracks trace(const Model& model, std::span<const std::uint32_t> runs, unsigned threads = 0);

/// How zones become bits. One object serves many runs, one after the other.
class DetectorLogic {
 public:
  virtual ~DetectorLogic() = default;
  /// Once, before any run: all sets of zones that there will be, to be prepared as the detector likes.
  virtual void prepare(std::span<const ZoneSet> sets) = 0;
  /// All randomness follows from these two.
  virtual void begin_run(std::uint64_t seed, std::uint32_t run) = 0;
  /// From one tick to the next: sets triggers[s] to 1 where sensor s triggers. before, after: indices of sets.
  virtual void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept = 0;
};

/// A change in a channel is motion; random only where edges are soft.
class ChangeLogic final : public DetectorLogic {
 public:
  explicit ChangeLogic(pir::MotionDetector detector) : ChangeLogic(detector, {detector, 1, 1}) {}
  ChangeLogic(pir::MotionDetector detector, pir::EdgeDraw edge_draw)
      : detector_(std::move(detector)), edge_draw_(std::move(edge_draw)) {}
  void prepare(std::span<const ZoneSet> sets) override;
  void begin_run(std::uint64_t seed, std::uint32_t run) override;
  void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept override;

 private:
  pir::MotionDetector detector_;
  pir::EdgeDraw edge_draw_;
  std::vector<ZoneSet> channels_;  ///< of each set
};

/// Zones with signs, filtered: see pir::PolarityDetector.
class PolarityLogic final : public DetectorLogic {
 public:
  explicit PolarityLogic(pir::PolarityDetector detector) : detector_(std::move(detector)) {}
  void prepare(std::span<const ZoneSet> sets) override;
  void begin_run(std::uint64_t seed, std::uint32_t run) override;
  void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept override;

 private:
  pir::PolarityDetector detector_;
  std::vector<double> sums_;  ///< (n_sets x n_sensors)
};

/// The detector that the Model's own runs have.
[[nodiscard]] std::unique_ptr<DetectorLogic> make_logic(const Model& model);

/// The rows of tracks.runs[index] as this detector gives them, which has been prepared with tracks.sets, changed by
/// what the pipeline does to triggers and rows. With ChangeLogic(model.detector()), the script's seed and the Model's
/// pipeline: the study's rows, bit for bit.
[[nodiscard]] RunResult emit(const ZoneTracks& tracks, std::size_t index, DetectorLogic& detector, std::uint64_t seed,
                             const effects::Pipeline& pipeline = {});

/// What these effects do to triggers and rows of a study that was compiled without them, to be given to emit(). Those
/// that reach geometry are passed over: they need a Model of their own. Throws Error(input) for unknown names.
[[nodiscard]] effects::Pipeline make_pipeline(const Model& model, std::span<const EffectSpec> effects);

}  // namespace pirsim::sim
