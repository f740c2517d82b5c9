#include "pirsim/study.hpp"

#include <optional>

#include "core/parallel.hpp"
#include "pirsim/error.hpp"
#include "sim/explainer.hpp"
#include "sim/observer.hpp"
#include "sim/run_state.hpp"

namespace pirsim {
namespace {

void note_incidents(const sim::CompiledStudy& study, const sim::RunState& state, std::vector<RunIncident>& incidents) {
  for (const sim::Actor& actor : state.crowd.actors()) {
    for (const sim::Incident& incident : actor.incidents()) {
      incidents.push_back(
          {incident.kind, static_cast<double>(incident.tick) * study.tick_s(), actor.person().spec.id, incident.place});
    }
  }
}

void add_occupants(const sim::CompiledStudy& study, const sim::RunState& state, std::vector<OccupantRow>& rows) {
  for (const sim::Actor& actor : state.crowd.actors()) {
    if (actor.person().spec.changes.role == PersonRole::object) continue;
    if (!actor.present()) continue;
    const Vec2 place = actor.motion().position();
    const bool inside = study.scene().floor.contains(place);
    rows.push_back({state.sample.time_s, state.sample.clock, actor.person().spec.id, std::string(actor.phase()),
                    std::string(actor.seat()), place, inside ? OccupantRow::Where::inside : OccupantRow::Where::outside,
                    std::string(inside ? study.areas().name_at(place) : std::string_view())});
  }
}

sim::ZonesOf zones_for(Record record) {
  return record == Record::samples_and_zones ? sim::ZonesOf::all_sensors : sim::ZonesOf::zone_sensors;
}

RunResult run_with(sim::ObserverPool& observers, const sim::CompiledStudy& study, std::uint32_t run, Record record,
                   Trace trace, Occupants occupants, const std::function<void()>& window_done = {}) {
  RunResult result;
  result.run = run;
  result.replicate = study.replicate_of(run);
  result.trial = study.trial_of(run).id;
  sim::RunState state(study, run);
  *state.observer = observers.borrow();
  std::optional<sim::Explainer> explainer;
  if (trace == Trace::signals && study.array().analog() != nullptr) explainer.emplace(study);
  if (explainer) explainer->settle(state);
  // Zones and signals are recorded at every tick, so no window may be passed over.
  const bool may_pass = record == Record::samples && !explainer;
  try {
    while (!state.finished) {
      if (may_pass && sim::pass_empty_window(study, state)) {
        result.samples.push_back(state.sample);
        if (window_done) window_done();
        continue;
      }
      const bool window_ended = sim::step_tick(study, state);
      if (record == Record::samples_and_zones) result.zones.push_back(state.exposure().zones);
      if (explainer) explainer->explain(state, result.trace);
      if (window_ended) result.samples.push_back(state.sample);
      if (window_ended && occupants == Occupants::told) add_occupants(study, state, result.occupants);
      note_incidents(study, state, result.incidents);
      if (window_ended && window_done) window_done();
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    result.samples.clear();
    result.zones.clear();
    result.trace.clear();
    result.occupants.clear();
    result.fault = {static_cast<double>(state.tick) * study.tick_s(), error.issues().front().message};
  }
  return result;
}

}  // namespace

RunResult run_once(const Model& model, std::uint32_t run, Record record, Trace trace, Occupants occupants) {
  sim::ObserverPool observers(model.compiled(), zones_for(record));
  return run_with(observers, model.compiled(), run, record, trace, occupants);
}

void run_study(const Model& model, const StudyOptions& options, const std::function<void(const RunResult&)>& consume) {
  const RunRange range = options.runs.value_or(RunRange{0, model.n_runs()});
  const auto run_of = [&](std::size_t i) {
    return options.chosen ? (*options.chosen)[i] : range.first + static_cast<std::uint32_t>(i);
  };
  sim::ObserverPool observers(model.compiled(), zones_for(options.record));
  ordered_parallel<RunResult>(
      options.chosen ? options.chosen->size() : range.count(), options.threads,
      [&](std::size_t i) {
        return run_with(observers, model.compiled(), run_of(i), options.record, options.trace, options.occupants,
                        options.window_done);
      },
      [&](RunResult& result) { consume(result); }, options.goes_on);
}

}  // namespace pirsim
