#include "engine/sim/recording.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "model/core/parallel.hpp"
#include "model/core/random.hpp"
#include "pirsim/recording.hpp"

namespace pirsim {
namespace sim {
namespace {

/// A run with its own numbering.
struct NumberedRun {
  Recording own;  ///< moments alone
  RecordedRun track;
};

/// With room for what sensors of this array show.
Recording nothing_shown(const SensorArray& array) {
  Recording recording;
  recording.n_sensors = array.n_sensors();
  recording.powers.resize(array.n_sensors());
  for (std::size_t sensor = 0; sensor < array.n_sensors() && array.analog() != nullptr; ++sensor) {
    const std::vector<std::uint32_t>& begin = array.analog()->power().receivers_begin();
    recording.powers[sensor].n_steps = begin[sensor + 1] - begin[sensor];
  }
  return recording;
}

NumberedRun record_run(const CompiledStudy& study, std::uint32_t run, ObserverPool& observers) {
  NumberedRun recorded{nothing_shown(study.array()), begun_run(study, run)};
  RecordedRun& track = recorded.track;
  MomentNumbering numbering(recorded.own, study.array().channels().n_zones());
  RunState state(study, run);
  *state.observer = observers.borrow();
  settle(study, state);
  ZoneSet zones;
  std::vector<PowerSteps> powers;
  std::uint32_t number = 0;
  const auto note = [&] {
    const Exposure& now = state.exposure();
    if (now.zones == zones && now.powers == powers) return;
    zones = now.zones;
    powers = now.powers;
    number = numbering.number(zones.words(), powers);
  };
  note();
  track.rest = number;
  for (std::optional<std::int64_t> end; !end || state.tick < *end;) {
    if (step_tick(study, state) && !end) track.rows.samples.push_back(state.sample);
    if (state.finished && !end) end = study.stages().heard_by(state.tick);
    for (const std::size_t seat : state.crowd.seats_left()) track.seats_left.push_back({state.tick, seat});
    note();
    track.moments.push_back(number);
  }
  return recorded;
}

template <typename T>
std::string_view bytes(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}
template <typename T>
std::string_view bytes(const std::vector<T>& values) {
  return bytes(std::span(values));
}

/// Digest of what an Exposure depends on besides people, and of when there is one.
std::string optics_of(const CompiledStudy& study) {
  const SensorArray& array = study.array();
  const RayBundle& zones = array.clipped();
  Sha256 digest;
  digest.add(std::to_string(study.sensing().tick_rate_hz) + ' ' + std::to_string(array.ticks_per_window()));
  // Who left which seat is recorded by the seat's index.
  for (const SeatSpec& seat : study.scene().seats) digest.add(seat.id + '\n');
  for (const std::string& area : study.areas().names()) digest.add("area " + area + '\n');  // recorded rows count them
  digest.add(bytes(zones.cluster_zones_begin));
  digest.add(bytes(zones.sensor_clusters_begin));
  static_assert(sizeof(Ray) == 6 * sizeof(float));  // nothing but numbers: equal bytes are equal rays
  for (std::size_t sensor = 0; sensor < zones.n_sensors(); ++sensor) {
    digest.add(array.is_analog(sensor) ? "analog" : "zones");
    if (array.is_analog(sensor)) continue;
    for (std::size_t zone = zones.first_zone(sensor); zone < zones.first_zone(sensor + 1); ++zone) {
      const std::size_t begin = zones.zone_rays_begin[zone], n = zones.zone_rays_begin[zone + 1] - begin;
      digest.add(std::to_string(n));
      digest.add(bytes(std::span(zones.rays).subspan(begin, n)));
      digest.add(bytes(std::span(zones.range).subspan(begin, n)));
    }
  }
  for (const DoorSpec& door : study.scene().doors) digest.add("door " + door.id + '\n');  // whose columns rows have
  if (!array.leaves().empty()) digest.add(bytes(array.range()));
  if (array.analog() == nullptr) return digest.hex();
  const PowerModel& power = array.analog()->power();
  digest.add(bytes(power.receivers_begin()));
  digest.add(bytes(power.clipped().zone_rays_begin));
  digest.add(bytes(power.clipped().rays));
  digest.add(bytes(power.clipped().range));
  digest.add(bytes(power.rays().weights));
  std::vector<double> backgrounds;
  std::vector<std::uint32_t> receivers;
  for (std::uint32_t ray = 0; ray < power.clipped().rays.size(); ++ray) {
    backgrounds.push_back(power.background(ray));
    receivers.push_back(power.receiver_of(ray));
  }
  digest.add(bytes(backgrounds));
  digest.add(bytes(receivers));
  return digest.hex();
}

/// sim::Detector on what a recording shows.
class ReplayedOptics final : public DetectorLogic {
 public:
  explicit ReplayedOptics(const CompiledStudy& study)
      : study_(study), detector_(study.array()), before_(study.array().unexposed()), after_(before_) {}

  void prepare(const Recording& recording) override {
    if (recording.optics != optics_of(study_)) {
      throw Error(ErrorCode::usage,
                  "the recording is of other optics than the model's: only electronics, effects on triggers and rows "
                  "and the seed may differ; room, seats, sensors' places, lenses, responses and ticks may not");
    }
    recording_ = &recording;
  }
  void begin_run(std::uint64_t seed, std::uint32_t run) override { begins_ = {seed, run}; }
  void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept override {
    if (begins_) {
      show(before, before_);
      detector_.begin_run(begins_->seed, begins_->run, before_);
      begins_.reset();
    }
    if (after == before) return detector_.tick_unchanged(before_, triggers);
    show(after, after_);
    detector_.tick(before_, after_, triggers);
    std::swap(before_, after_);
  }

 private:
  struct Run {
    std::uint64_t seed = 0;
    std::uint32_t run = 0;
  };

  void show(std::uint32_t number, Exposure& exposure) const noexcept {
    exposure.zones = recording_->zones(number);
    study_.array().expose(exposure);
    if (exposure.powers.empty()) return;
    exposure.powers.clear();
    add_powers(*recording_, number, exposure.powers);
  }

  const CompiledStudy& study_;
  const Recording* recording_ = nullptr;
  Detector detector_;
  std::optional<Run> begins_;  ///< with the tick that comes next, which tells what it begins from
  Exposure before_, after_;    ///< of the last tick; scratch
};

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) noexcept {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
  return hash ^ (hash >> 32U);
}

/// As `sensing` reads rows from triggers.
RunResult replay_as(const SensingSpec& sensing, const Recording& recording, std::size_t index, DetectorLogic& detector,
                    std::uint64_t seed, const effects::Pipeline& stages) {
  const RecordedRun& track = recording.runs[index];
  if (!goes_as_far_as(track, sensing, stages)) {
    throw Error(ErrorCode::usage,
                "clock_lag looks further ahead than was recorded: compile a model with it and record that");
  }
  RunResult result = track.rows;
  Logger logger(stages, sensing, recording.n_sensors);
  logger.begin_run(seed, result.run);
  detector.begin_run(seed, result.run);
  std::vector<std::uint8_t> triggers(recording.n_sensors);
  auto left = track.seats_left.begin();
  std::uint32_t before = track.rest;
  const auto sense = [&](std::int64_t tick) {
    const std::uint32_t after = track.moments[static_cast<std::size_t>(tick - 1)];
    std::ranges::fill(triggers, std::uint8_t{0});
    detector.tick(before, after, triggers);
    before = after;
    for (; left != track.seats_left.end() && left->tick == tick; ++left) logger.seat_left(left->seat);
  };
  for (Sample& sample : result.samples) {
    for (int i = 0; i < sensing.ticks_per_window; ++i) logger.observe_tick(triggers, sense);
    logger.complete(sample);
  }
  return result;
}

}  // namespace

RecordedRun begun_run(const CompiledStudy& study, std::uint32_t run) {
  return {{run, study.replicate_of(run), study.trial_of(run).id, {}, {}, {}}, 0, {}, {}};
}

void add_powers(const Recording& recording, std::uint32_t moment, std::vector<PowerSteps>& powers) {
  for (std::size_t sensor = 0; sensor < recording.n_sensors && !recording.moments.empty(); ++sensor) {
    const auto row = recording.powers_of(moment, sensor);
    powers.insert(powers.end(), row.begin(), row.end());
  }
}

Recording empty_recording(const CompiledStudy& study) {
  Recording recording = nothing_shown(study.array());
  recording.sensing = study.sensing();
  recording.optics = optics_of(study);
  return recording;
}

MomentNumbering::MomentNumbering(Recording& recording, std::size_t n_zones)
    : recording_(recording), n_zones_(n_zones), rows_(recording.n_sensors) {
  std::size_t n_receivers = 0;
  for (const PowerRows& rows : recording.powers) n_receivers += rows.n_steps;
  number(ZoneSet(n_zones).words(), std::vector<PowerSteps>(n_receivers, 0));
}

std::uint32_t MomentNumbering::number_set(std::span<const ZoneSet::Word> zones) {
  std::uint64_t hash = 0;
  for (const ZoneSet::Word word : zones) hash = mixed(hash, word);
  std::vector<ZoneSet>& sets = recording_.sets;
  const std::uint32_t number =
      sets_.number(hash, [&](std::uint32_t known) { return std::ranges::equal(sets[known].words(), zones); });
  if (number == sets.size()) sets.emplace_back(n_zones_).add(zones);
  return number;
}

std::uint32_t MomentNumbering::number_row(std::size_t sensor, std::span<const PowerSteps> powers) {
  std::uint64_t hash = 0;
  for (const PowerSteps power : powers) hash = mixed(hash, static_cast<std::uint64_t>(power));
  std::vector<std::int64_t>& known_powers = recording_.powers[sensor].power;
  const std::uint32_t number = rows_[sensor].number(hash, [&](std::uint32_t known) {
    return std::equal(powers.begin(), powers.end(), known_powers.begin() + known * std::ssize(powers));
  });
  if (number * powers.size() == known_powers.size()) {
    known_powers.insert(known_powers.end(), powers.begin(), powers.end());
  }
  return number;
}

std::uint32_t MomentNumbering::number(std::span<const ZoneSet::Word> zones, std::span<const PowerSteps> powers) {
  const std::uint32_t set = number_set(zones);
  if (powers.empty()) return set;
  std::vector<std::uint32_t> moment{set};
  for (std::size_t sensor = 0, begin = 0; sensor < recording_.n_sensors; ++sensor) {
    const std::size_t n_steps = recording_.powers[sensor].n_steps;
    moment.push_back(n_steps == 0 ? 0 : number_row(sensor, powers.subspan(begin, n_steps)));
    begin += n_steps;
  }
  std::uint64_t hash = 0;
  for (const std::uint32_t each : moment) hash = mixed(hash, each);
  std::vector<std::uint32_t>& moments = recording_.moments;
  const std::uint32_t number = moments_.number(hash, [&](std::uint32_t known) {
    return std::equal(moment.begin(), moment.end(), moments.begin() + known * std::ssize(moment));
  });
  if (number * moment.size() == moments.size()) moments.insert(moments.end(), moment.begin(), moment.end());
  return number;
}

std::unique_ptr<DetectorLogic> make_logic(const Model& model) {
  return std::make_unique<ReplayedOptics>(model.compiled());
}

effects::Pipeline make_stages(const Model& model, std::span<const EffectSpec> effects) {
  const CompiledStudy& study = model.compiled();
  Diagnostics diagnostics;
  effects::check(effects, study.scene(), diagnostics);
  diagnostics.throw_if_errors();
  return {effects, {study.scene(), study.sensing(), study.array().clipped(), study.n_runs()}};
}

bool goes_as_far_as(const RecordedRun& track, const SensingSpec& sensing, const effects::Pipeline& stages) {
  const auto last_row = static_cast<std::int64_t>(track.rows.samples.size()) * sensing.ticks_per_window;
  return static_cast<std::int64_t>(track.moments.size()) >= stages.heard_by(last_row);
}

RunResult replay(const Recording& recording, std::size_t index, DetectorLogic& detector, std::uint64_t seed,
                 const effects::Pipeline& stages) {
  return replay_as(recording.sensing, recording, index, detector, seed, stages);
}

}  // namespace sim

Recording record(const Model& model, std::span<const std::uint32_t> runs, unsigned threads,
                 const std::function<void()>& run_done) {
  const sim::CompiledStudy& study = model.compiled();
  Recording recording = sim::empty_recording(study);
  sim::MomentNumbering numbering(recording, study.array().channels().n_zones());
  sim::ObserverPool observers(study, sim::ZonesOf::zone_sensors);
  ordered_parallel<sim::NumberedRun>(
      runs.size(), threads, [&](std::size_t i) { return sim::record_run(study, runs[i], observers); },
      [&](sim::NumberedRun& recorded) {
        const auto& [own, track] = recorded;
        std::vector<std::uint32_t> renumbered;
        std::vector<sim::PowerSteps> powers;
        for (std::uint32_t i = 0; i < own.n_moments(); ++i) {
          powers.clear();
          sim::add_powers(own, i, powers);
          renumbered.push_back(numbering.number(own.zones(i).words(), powers));
        }
        recorded.track.rest = renumbered[track.rest];
        for (std::uint32_t& number : recorded.track.moments) number = renumbered[number];
        recording.runs.push_back(std::move(recorded.track));
        if (run_done) run_done();
      });
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
                "effect '" + effect.name + "' changes what the optics show: compile a model with it and record that");
  }
  const effects::Pipeline stages = sim::make_stages(model, options.effects.value_or(model.script().effects));
  const std::uint64_t seed = options.seed.value_or(model.script().seed);
  const std::unique_ptr<DetectorLogic> detector = sim::make_logic(model);
  detector->prepare(recording);
  for (std::size_t i = 0; i < recording.runs.size(); ++i) {
    consume(sim::replay_as(model.compiled().sensing(), recording, i, *detector, seed, stages));
  }
}

}  // namespace pirsim
