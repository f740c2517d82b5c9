#include "pirsim/study.hpp"

#include <optional>

#include "core/parallel.hpp"
#include "sim/explainer.hpp"
#include "sim/run_state.hpp"
#include "sim/zone_cache_pool.hpp"

namespace pirsim {
namespace {

ZoneActivity activity_of(const ZoneSet& zones) {
  ZoneActivity activity(zones.size());
  for (std::size_t i = 0; i < activity.size(); ++i) activity[i] = zones.test(i) ? 1 : 0;
  return activity;
}

RunResult run_with(sim::ZoneCachePool& caches, const sim::CompiledStudy& study, std::uint32_t run, Record record,
                   Trace trace) {
  RunResult result{run, study.replicate_of(run), study.trial_of(run).id, {}, {}, {}};
  sim::RunState state(study, run);
  *state.cache = caches.borrow();
  std::optional<sim::Explainer> explainer;
  if (trace == Trace::signals && study.array().analog() != nullptr) explainer.emplace(study);
  while (!state.finished) {
    const bool window_ended = sim::step_tick(study, state);
    if (record == Record::samples_and_zones) result.zones.push_back(activity_of(state.exposure().zones));
    if (explainer) explainer->explain(state, result.trace);
    if (window_ended) result.samples.push_back(state.sample);
  }
  return result;
}

}  // namespace

RunResult run_once(const Model& model, std::uint32_t run, Record record, Trace trace) {
  sim::ZoneCachePool caches(model.compiled());
  return run_with(caches, model.compiled(), run, record, trace);
}

void run_study(const Model& model, const StudyOptions& options, const std::function<void(const RunResult&)>& consume) {
  const RunRange runs = options.runs.value_or(RunRange{0, model.n_runs()});
  sim::ZoneCachePool caches(model.compiled());
  ordered_parallel<RunResult>(
      runs.count(), options.threads,
      [&](std::size_t i) {
        return run_with(caches, model.compiled(), runs.first + static_cast<std::uint32_t>(i), options.record,
                        options.trace);
      },
      [&](RunResult& result) { consume(result); }, options.goes_on);
}

}  // namespace pirsim
