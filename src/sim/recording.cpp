#include "pirsim/recording.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"
#include "effects/catalogue.hpp"
#include "sim/replay.hpp"
#include "sim/run_state.hpp"
#include "sim/zone_cache.hpp"

namespace pirsim {
namespace sim {
namespace {

/// A run with its own numbering of sets.
struct NumberedRun {
  RecordedRun track;
  std::vector<ZoneSet> sets;
};

NumberedRun record_run(const CompiledStudy& study, std::uint32_t run, ZoneCachePool& caches) {
  NumberedRun recorded{{{run, study.replicate_of(run), study.trial_of(run).id, {}, {}, {}}, {}, {}}, {}};
  const std::size_t n_zones = study.array().channels().n_zones();
  SetNumbering numbering(n_zones);
  RunState state(study, run);
  *state.cache = caches.borrow();
  ZoneSet last(n_zones);
  std::uint32_t number = 0;
  while (!state.finished) {
    if (step_tick(study, state)) recorded.track.rows.samples.push_back(state.sample);
    for (const std::size_t seat : state.crowd.seats_left()) recorded.track.seats_left.push_back({state.tick, seat});
    if (state.exposure().zones != last) {
      last = state.exposure().zones;
      number = numbering.number(last);
    }
    recorded.track.sets.push_back(number);
  }
  recorded.sets = std::move(numbering.sets());
  return recorded;
}

/// sim::Detector on a recording's sets, each of which is made ready for it once.
class ReplayedDetector final : public DetectorLogic {
 public:
  explicit ReplayedDetector(const SensorArray& array) : array_(array), detector_(array) {}

  void prepare(std::span<const ZoneSet> sets) override {
    exposures_.clear();
    for (const ZoneSet& set : sets) {
      exposures_.push_back(array_.unexposed());
      exposures_.back().zones = set;
      array_.expose(exposures_.back());
    }
  }
  void begin_run(std::uint64_t seed, std::uint32_t run) override { detector_.begin_run(seed, run, array_.unexposed()); }
  void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept override {
    detector_.tick(exposures_[before], exposures_[after], triggers);
  }

 private:
  const SensorArray& array_;
  Detector detector_;
  std::vector<Exposure> exposures_;
};

}  // namespace

Recording empty_recording(const CompiledStudy& study) {
  if (study.array().analog() != nullptr) {
    throw Error(ErrorCode::usage, "a recording of zones isn't enough for sensors with an analog response");
  }
  return {{}, {}, study.array().n_sensors(), study.sensing()};
}

std::unique_ptr<DetectorLogic> make_logic(const Model& model) {
  return std::make_unique<ReplayedDetector>(model.compiled().array());
}

effects::Pipeline make_stages(const Model& model, std::span<const EffectSpec> effects) {
  const CompiledStudy& study = model.compiled();
  Diagnostics diagnostics;
  effects::check(effects, study.scene(), diagnostics);
  diagnostics.throw_if_errors();
  return {effects, {study.scene(), study.sensing(), study.array().clipped()}};
}

RunResult replay(const Recording& recording, std::size_t index, DetectorLogic& detector, std::uint64_t seed,
                 const effects::Pipeline& stages) {
  const RecordedRun& track = recording.runs[index];
  RunResult result = track.rows;
  Logger logger(stages, recording.sensing, recording.n_sensors);
  logger.begin_run(seed, result.run);
  detector.begin_run(seed, result.run);
  std::vector<std::uint8_t> triggers(recording.n_sensors);
  auto left = track.seats_left.begin();
  std::uint32_t before = 0;
  std::int64_t tick = 0;
  for (Sample& sample : result.samples) {
    for (int i = 0; i < recording.sensing.ticks_per_window; ++i) {
      const std::uint32_t after = track.sets[static_cast<std::size_t>(tick)];
      ++tick;
      std::ranges::fill(triggers, std::uint8_t{0});
      detector.tick(before, after, triggers);
      before = after;
      for (; left != track.seats_left.end() && left->tick == tick; ++left) logger.seat_left(left->seat);
      logger.tick(tick, triggers);
    }
    logger.complete(sample);
  }
  return result;
}

}  // namespace sim

Recording record(const Model& model, std::span<const std::uint32_t> runs, unsigned threads,
                 const std::function<void()>& run_done) {
  const sim::CompiledStudy& study = model.compiled();
  Recording recording = sim::empty_recording(study);
  sim::SetNumbering numbering(study.array().channels().n_zones());
  sim::ZoneCachePool caches(study);
  ordered_parallel<sim::NumberedRun>(
      runs.size(), threads, [&](std::size_t i) { return sim::record_run(study, runs[i], caches); },
      [&](sim::NumberedRun& recorded) {
        std::vector<std::uint32_t> renumbered;
        for (const ZoneSet& set : recorded.sets) renumbered.push_back(numbering.number(set));
        for (std::uint32_t& number : recorded.track.sets) number = renumbered[number];
        recording.runs.push_back(std::move(recorded.track));
        if (run_done) run_done();
      });
  recording.sets = std::move(numbering.sets());
  return recording;
}

RunResult replay(const Recording& recording, std::size_t index, DetectorLogic& detector, std::uint64_t seed) {
  return sim::replay(recording, index, detector, seed, {});
}

void emit(const Model& model, const Recording& recording, const EmitOptions& options,
          const std::function<void(const RunResult&)>& consume) {
  for (const EffectSpec& effect : options.effects.value_or(std::vector<EffectSpec>{})) {
    if (effects::info(effect.name).reach != effects::Reach::geometry) continue;
    throw Error(ErrorCode::usage,
                "effect '" + effect.name + "' changes what the zones see: compile a model with it and record that");
  }
  const effects::Pipeline stages = sim::make_stages(model, options.effects.value_or(model.script().effects));
  const std::uint64_t seed = options.seed.value_or(model.script().seed);
  const std::unique_ptr<DetectorLogic> detector = sim::make_logic(model);
  detector->prepare(recording.sets);
  for (std::size_t i = 0; i < recording.runs.size(); ++i) {
    consume(sim::replay(recording, i, *detector, seed, stages));
  }
}

}  // namespace pirsim
