#include "sim/run_state.hpp"

#include "schema/schedule_people.hpp"

namespace pirsim::sim {

RunState::RunState(const CompiledStudy& study, std::uint32_t run_number)
    : run(run_number),
      crowd(study, run_number),
      exposures{study.array().unexposed(), study.array().unexposed()},
      detector(study.array()),
      logger(study.stages(), study.sensing(), study.array().n_sensors()),
      triggers(study.array().n_sensors(), 0) {
  detector.begin_run(study.seed(), run, exposure());
  logger.begin_run(study.seed(), run);
  sample.replicate = study.replicate_of(run);
  sample.trial = study.trial_of(run).id;
}

bool move_tick(const CompiledStudy& study, RunState& state) {
  ++state.tick;
  state.crowd.advance(study, state.tick);
  if (state.tick % study.sensing().ticks_per_window != 0) return false;
  state.sample.time_s = static_cast<double>(state.tick) / study.sensing().tick_rate_hz;
  if (const auto& schedule = study.trial_of(state.run).schedule) {
    const std::int64_t day = day_number(schedule->first_day, schedule->where) + study.replicate_of(state.run) - 1;
    state.sample.clock = clock_text(day, 3600.0 * schedule->from_h + state.sample.time_s);
  }
  state.sample.phase = state.crowd.phase();
  state.sample.people = state.crowd.n_on_floor(study.scene().floor);
  const std::optional<double>& duration_s = study.trial_of(state.run).duration_s;
  state.finished = duration_s ? state.sample.time_s >= *duration_s : state.crowd.done();
  return true;
}

bool step_tick(const CompiledStudy& study, RunState& state) {
  const bool window_ended = move_tick(study, state);
  if (!*state.cache) *state.cache = std::make_shared<ZoneCache>(study);
  const Exposure& before = state.exposures[static_cast<std::size_t>((state.tick - 1) % 2)];
  (*state.cache)->look(state.crowd.actors(), state.exposure());
  state.detector.tick(before, state.exposure(), state.triggers);
  for (const std::size_t seat : state.crowd.seats_left()) state.logger.seat_left(seat);
  state.logger.tick(state.tick, state.triggers);
  if (window_ended) state.logger.complete(state.sample);
  return window_ended;
}

}  // namespace pirsim::sim
