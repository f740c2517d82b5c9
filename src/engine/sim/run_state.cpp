#include "engine/sim/run_state.hpp"

#include <algorithm>

#include "engine/sim/schedule.hpp"
#include "model/core/text.hpp"
#include "model/schema/words.hpp"

namespace pirsim::sim {

Detector::Detector(const SensorArray& array)
    : array_(&array),
      edges_(array.channels(), array.n_levels(), array.soft_edges(), array.ticks_per_window(), array.tick_s()),
      polarity_(array.polarity()),
      outputs_(array.n_sensors()),
      analog_(array.analog() != nullptr ? array.n_sensors() : 0) {}

void Detector::begin_run(std::uint64_t seed, std::uint32_t run, const Exposure& rest) {
  edges_.begin_run(seed, run, rest.channels);
  if (polarity_) polarity_->begin_run(rest.sums);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (array_->zone_outputs()[i]) outputs_[i].emplace();
  }
  for (std::uint32_t i = 0; i < analog_.size(); ++i) {
    const AnalogModel& model = *array_->analog();
    const auto& sensor = model.sensors()[i];
    if (!sensor) continue;
    analog_[i] = sensor->detector.start(model.watts(i, rest.powers), {seed, run, i, Purpose::detector_noise});
  }
}

void Detector::tick(const Exposure& before, const Exposure& after, std::span<std::uint8_t> triggers) noexcept {
  tick_zones(before, after, triggers);
  advance_analog(after, triggers);
}

void Detector::tick_unchanged(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept {
  tick_zones_unchanged(exposure, triggers);
  advance_analog(exposure, triggers);
}

void Detector::tick_zones(const Exposure& before, const Exposure& after, std::span<std::uint8_t> triggers) noexcept {
  std::ranges::fill(triggers, std::uint8_t{0});
  if (polarity_) {
    polarity_->tick(after.sums, triggers);
  } else {
    edges_.tick(before.channels, after.channels, triggers);
  }
  switch_outputs(triggers);
  if (array_->has_beams()) look_at_beams(after, triggers);
}

void Detector::tick_zones_unchanged(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept {
  std::ranges::fill(triggers, std::uint8_t{0});
  if (polarity_) {
    polarity_->tick(exposure.sums, triggers);
  } else {
    edges_.tick_unchanged(exposure.channels, triggers);
  }
  switch_outputs(triggers);
  if (array_->has_beams()) look_at_beams(exposure, triggers);
}

void Detector::switch_outputs(std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (!outputs_[i]) continue;
    array_->zone_outputs()[i]->advance_to(*outputs_[i], triggers[i] != 0 ? 1 : 0);
    triggers[i] = outputs_[i]->trigger();
  }
}

void Detector::look_at_beams(const Exposure& exposure, std::span<std::uint8_t> triggers) const noexcept {
  const std::span<const ZoneSet::Word> channels = exposure.channels.words();
  for (std::size_t i = 0; i < triggers.size(); ++i) {
    if (!array_->is_beam(i)) continue;
    const auto own = array_->channels().sensor_masks().subspan(i * channels.size(), channels.size());
    bool is_broken = false;
    for (std::size_t k = 0; k < own.size(); ++k) is_broken = is_broken || (own[k] & channels[k]) != 0;
    triggers[i] = is_broken ? 1 : 0;
  }
}

void Detector::advance_analog(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t i = 0; i < analog_.size(); ++i) {
    if (!analog_[i]) continue;
    const AnalogModel& model = *array_->analog();
    model.sensors()[i]->detector.advance(*analog_[i], model.watts(i, exposure.powers));
    triggers[i] = analog_[i]->comparator.trigger();
  }
}

bool Detector::is_at_rest(const Exposure& exposure) const {
  if (is_memoryless() && !array_->has_beams()) return true;
  if (!polarity_ && !edges_.is_at_rest()) return false;
  Detector next(*this);
  std::vector<std::uint8_t> triggers(array_->n_sensors());
  next.tick_unchanged(exposure, triggers);
  const auto off = [](std::uint8_t trigger) { return trigger == 0; };
  return next.polarity_ == polarity_ && next.outputs_ == outputs_ && next.analog_ == analog_ &&
         std::ranges::all_of(triggers, off);
}

bool Detector::is_memoryless() const noexcept {
  const bool no_output =
      std::ranges::none_of(array_->zone_outputs(), [](const auto& output) { return output.has_value(); });
  return !polarity_ && no_output && analog_.empty() && array_->n_levels() == 1;
}

namespace {

pir::WindowReader in_step(std::size_t n_sensors, std::int32_t ticks_per_window) {
  return {std::vector<std::int32_t>(n_sensors, 0), ticks_per_window};
}

/// Of a home with somebody on the floor.
std::string use_of_home(const CompiledStudy& study, const Crowd& crowd) {
  const Areas& areas = study.areas();
  std::vector<int> asleep(areas.size() + 1, 0), up = asleep;  // the last: of all areas
  for (const Actor& actor : crowd.actors()) {
    if (!actor.counts_on(study.scene().floor)) continue;
    std::vector<int>& some = actor.phase() == manner_of(HomeActivity::sleep).phase ? asleep : up;
    ++some.back();
    if (!areas.empty()) ++some[areas.at(actor.motion().position())];
  }
  if (up.back() == 0) return std::string(phase_asleep);
  std::vector<std::string> dark;
  for (std::size_t area = 0; area < areas.size(); ++area) {
    if (asleep[area] > 0 && up[area] == 0) dark.push_back(areas.names()[area]);
  }
  return dark.empty() ? std::string(phase_occupied) : std::string(asleep_in) + joined(dark, asleep_and);
}

/// What the people on the floor use the room for.
std::string use_of(const CompiledStudy& study, const TrialModel& trial, const Crowd& crowd) {
  int n = 0, cleaners = 0, in_meeting = 0;
  for (const Actor& actor : crowd.actors()) {
    if (!actor.counts_on(study.scene().floor)) continue;
    const auto& part = actor.person().spec.part;
    ++n;
    cleaners += part && part->part == SchedulePart::cleaner ? 1 : 0;
    in_meeting += actor.takes_part_in_meeting() ? 1 : 0;
  }
  if (n > 0 && trial.schedule && trial.schedule->household) return use_of_home(study, crowd);
  return std::string(n == 0           ? phase_empty
                     : in_meeting > 1 ? phase_meeting
                     : cleaners == n  ? phase_cleaning
                                      : phase_occupied);
}

/// All on the floor, and those of each area.
void count_people(const CompiledStudy& study, const Crowd& crowd, Sample& sample) {
  const Areas& areas = study.areas();
  sample.people = 0;
  sample.people_of_areas.assign(areas.size(), 0);
  for (const Actor& actor : crowd.actors()) {
    if (!actor.counts_on(study.scene().floor)) continue;
    ++sample.people;
    if (!areas.empty()) ++sample.people_of_areas[areas.at(actor.motion().position())];
  }
}

void end_window(const CompiledStudy& study, RunState& state) {
  const TrialModel& trial = study.trial_of(state.run);
  Sample& sample = state.sample;
  sample.time_s = static_cast<double>(state.tick) / study.sensing().tick_rate_hz;
  if (state.clock) sample.clock = state.clock->text(sample.time_s);
  sample.phase = trial.is_populated() ? use_of(study, trial, state.crowd) : std::string(state.crowd.phase());
  count_people(study, state.crowd, sample);
  sample.doors.clear();
  for (const LeafStep step : state.crowd.doors().steps()) sample.doors.push_back(step == 0 ? 0 : 1);
  state.finished = trial.duration_s ? sample.time_s >= *trial.duration_s : state.crowd.done();
}

Observer& observer_of(const CompiledStudy& study, RunState& state) {
  if (!*state.observer)
    *state.observer = std::make_shared<Observer>(study.array(), study.tracer(), ZonesOf::zone_sensors);
  return **state.observer;
}

void sense(Observer& observer, RunState& state) {
  const Exposure& before = state.exposures[static_cast<std::size_t>((state.tick - 1) % 2)];
  observer.look(state.crowd.actors(), state.crowd.doors().steps(), state.exposure());
  state.detector.tick(before, state.exposure(), state.triggers);
}

/// What is logged at this tick, at which the state has sensed, once the run ahead has heard of it.
void observe_tick(const CompiledStudy& study, RunState& state) {
  RunState* const ahead = state.ahead.get();
  state.logger.observe_tick(state.triggers, [&](std::int64_t) {
    if (ahead != nullptr) {
      move_tick(study, *ahead);
      sense(observer_of(study, state), *ahead);
      std::ranges::copy(ahead->triggers, state.triggers.begin());
    }
    for (const std::size_t seat : (ahead != nullptr ? *ahead : state).crowd.seats_left()) state.logger.seat_left(seat);
  });
}

}  // namespace

Logger::Logger(const effects::Pipeline& stages, const SensingSpec& sensing, std::size_t n_sensors)
    : stages_(stages),
      kind_(sensing.reader),
      ticks_per_window_(sensing.ticks_per_window),
      n_sensors_(n_sensors),
      reader_(in_step(n_sensors, ticks_per_window_)) {}

void Logger::begin_run(std::uint64_t seed, std::uint32_t run) {
  stages_.begin_run(seed, run);
  tick_ = heard_ = 0;
  reader_ = kind_ == Reader::in_step
                ? in_step(n_sensors_, ticks_per_window_)
                : pir::WindowReader(pir::drawn_leads(n_sensors_, ticks_per_window_, seed, run), ticks_per_window_);
}

void Logger::complete(Sample& row) noexcept {
  row.bits.assign(reader_.readings().begin(), reader_.readings().end());
  stages_.apply(row);
}

RunState::RunState(const CompiledStudy& study, std::uint32_t run_number)
    : run(run_number),
      crowd(study, run_number),
      exposures{study.array().unexposed(), study.array().unexposed()},
      detector(study.array()),
      logger(study.stages(), study.sensing(), study.array().n_sensors()),
      clock(study.clock_of(run)),
      triggers(study.array().n_sensors(), 0) {
  logger.begin_run(study.seed(), run);
  sample.replicate = study.replicate_of(run);
  sample.trial = study.trial_of(run).id;
}

const ZoneSet& zones_of_all(const CompiledStudy& study, RunState& state) {
  if (study.array().analog() == nullptr) return state.exposure().zones;
  auto& [observer, exposure] = *state.onlooker;
  if (!observer) {
    observer = std::make_unique<Observer>(study.array(), study.tracer(), ZonesOf::all_sensors);
    exposure = study.array().unexposed();
  }
  observer->look_at_zones(state.crowd.actors(), state.crowd.doors().steps(), exposure);
  return exposure.zones;
}

bool move_tick(const CompiledStudy& study, RunState& state) {
  ++state.tick;
  state.crowd.advance(study, state.tick);
  const auto& actors = state.crowd.actors();
  state.empty_ticks = std::ranges::any_of(actors, &Actor::present) ? 0 : state.empty_ticks + 1;
  state.at_rest = false;
  if (state.tick % study.sensing().ticks_per_window != 0) return false;
  end_window(study, state);
  return true;
}

void settle(const CompiledStudy& study, RunState& state) {
  observer_of(study, state).look(state.crowd.actors(), state.crowd.doors().steps(), state.exposure());
  state.detector.begin_run(study.seed(), state.run, state.exposure());
  if (state.logger.looks_ahead() && state.ahead.get() == nullptr) state.ahead.hold(state);
}

bool step_tick(const CompiledStudy& study, RunState& state) {
  if (state.tick == 0) settle(study, state);
  const bool window_ended = move_tick(study, state);
  sense(observer_of(study, state), state);
  observe_tick(study, state);
  if (window_ended) state.logger.complete(state.sample);
  return window_ended;
}

bool pass_empty_window(const CompiledStudy& study, RunState& state) {
  const std::int64_t n_ticks = study.sensing().ticks_per_window;
  // Two ticks, so that both exposures show the empty room.
  if (state.finished || state.empty_ticks < 2 || state.tick % n_ticks != 0) return false;
  if (state.crowd.away_until(study, state.tick) < state.tick + n_ticks) return false;
  if (state.at_rest) {
    state.tick += n_ticks;
    state.logger.skip(n_ticks);
  } else {
    for (std::int64_t i = 0; i < n_ticks; ++i) {
      ++state.tick;
      state.detector.tick_unchanged(state.exposure(), state.triggers);
      observe_tick(study, state);
    }
    state.at_rest = state.logger.is_at_rest() && state.detector.is_at_rest(state.exposure());
  }
  state.empty_ticks += n_ticks;
  end_window(study, state);
  state.logger.complete(state.sample);
  return true;
}

}  // namespace pirsim::sim
