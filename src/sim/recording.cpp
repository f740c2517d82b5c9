#include "pirsim/recording.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "effects/catalogue.hpp"
#include "sim/observer.hpp"
#include "sim/replay.hpp"
#include "sim/run_state.hpp"

namespace pirsim {
namespace sim {
namespace {

/// A run with its own numbering of sets.
struct NumberedRun {
  RecordedRun track;
  std::vector<ZoneSet> sets;
};

NumberedRun record_run(const CompiledStudy& study, std::uint32_t run, ObserverPool& observers) {
  NumberedRun recorded{{{run, study.replicate_of(run), study.trial_of(run).id, {}, {}, {}}, 0, {}, {}}, {}};
  const std::size_t n_zones = study.array().channels().n_zones();
  SetNumbering numbering(n_zones);
  RunState state(study, run);
  *state.observer = observers.borrow();
  settle(study, state);
  ZoneSet last = state.exposure().zones;
  std::uint32_t number = numbering.number(last);
  recorded.track.rest = number;
  for (std::optional<std::int64_t> end; !end || state.tick < *end;) {
    if (step_tick(study, state) && !end) recorded.track.rows.samples.push_back(state.sample);
    if (state.finished && !end) end = study.stages().heard_by(state.tick);
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
class ReplayedSets final : public DetectorLogic {
 public:
  explicit ReplayedSets(const SensorArray& array) : array_(array), detector_(array) {}

  void prepare(std::span<const ZoneSet> sets) override {
    exposures_.clear();
    for (const ZoneSet& set : sets) {
      exposures_.push_back(array_.unexposed());
      exposures_.back().zones = set;
      array_.expose(exposures_.back());
    }
  }
  void begin_run(std::uint64_t seed, std::uint32_t run) override { begins_ = {seed, run}; }
  void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept override {
    if (begins_) detector_.begin_run(begins_->seed, begins_->run, exposures_[before]);
    begins_.reset();
    detector_.tick(exposures_[before], exposures_[after], triggers);
  }

 private:
  struct Run {
    std::uint64_t seed = 0;
    std::uint32_t run = 0;
  };
  const SensorArray& array_;
  Detector detector_;
  std::optional<Run> begins_;  ///< with the tick that comes next, which tells what it begins from
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
  return std::make_unique<ReplayedSets>(model.compiled().array());
}

effects::Pipeline make_stages(const Model& model, std::span<const EffectSpec> effects) {
  const CompiledStudy& study = model.compiled();
  Diagnostics diagnostics;
  effects::check(effects, study.scene(), diagnostics);
  diagnostics.throw_if_errors();
  return {effects, {study.scene(), study.sensing(), study.array().clipped()}};
}

bool goes_as_far_as(const RecordedRun& track, const SensingSpec& sensing, const effects::Pipeline& stages) {
  const auto last_row = static_cast<std::int64_t>(track.rows.samples.size()) * sensing.ticks_per_window;
  return static_cast<std::int64_t>(track.sets.size()) >= stages.heard_by(last_row);
}

RunResult replay(const Recording& recording, std::size_t index, DetectorLogic& detector, std::uint64_t seed,
                 const effects::Pipeline& stages) {
  const RecordedRun& track = recording.runs[index];
  if (!goes_as_far_as(track, recording.sensing, stages)) {
    throw Error(ErrorCode::usage,
                "clock_lag looks further ahead than was recorded: compile a model with it and record that");
  }
  RunResult result = track.rows;
  Logger logger(stages, recording.sensing, recording.n_sensors);
  logger.begin_run(seed, result.run);
  detector.begin_run(seed, result.run);
  std::vector<std::uint8_t> triggers(recording.n_sensors);
  auto left = track.seats_left.begin();
  std::uint32_t before = track.rest;
  const auto sense = [&](std::int64_t tick) {
    const std::uint32_t after = track.sets[static_cast<std::size_t>(tick - 1)];
    std::ranges::fill(triggers, std::uint8_t{0});
    detector.tick(before, after, triggers);
    before = after;
    for (; left != track.seats_left.end() && left->tick == tick; ++left) logger.seat_left(left->seat);
  };
  for (Sample& sample : result.samples) {
    for (int i = 0; i < recording.sensing.ticks_per_window; ++i) logger.observe_tick(triggers, sense);
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
  sim::ObserverPool observers(study);
  ordered_parallel<sim::NumberedRun>(
      runs.size(), threads, [&](std::size_t i) { return sim::record_run(study, runs[i], observers); },
      [&](sim::NumberedRun& recorded) {
        std::vector<std::uint32_t> renumbered;
        for (const ZoneSet& set : recorded.sets) renumbered.push_back(numbering.number(set));
        recorded.track.rest = renumbered[recorded.track.rest];
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
