#include "sim/study.hpp"

#include <optional>

#include "core/parallel.hpp"
#include "sim/explainer.hpp"
#include "sim/state.hpp"

namespace pirsim {

namespace {

ZoneActivity activity_of(const ZoneSet& zones) {
  ZoneActivity activity(zones.size());
  for (std::size_t i = 0; i < activity.size(); ++i) activity[i] = zones.test(i) ? 1 : 0;
  return activity;
}

}  // namespace

RunResult run_once(const Model& model, std::uint32_t run, Record record, Trace trace) {
  RunResult result{run, model.replicate_of(run), model.trial_of(run).id, {}, {}, {}};
  State state(model, run);
  std::optional<sim::Explainer> explainer;
  if (trace == Trace::signals && model.analog() != nullptr) explainer.emplace(model);
  while (!state.finished()) {
    const bool window_ended = step_tick(model, state);
    if (record == Record::samples_and_zones) result.zones.push_back(activity_of(state.zones()));
    if (explainer) explainer->explain(state, result.trace);
    if (window_ended) result.samples.push_back(state.sample());
  }
  return result;
}

void run_study(const Model& model, const StudyOptions& options, const std::function<void(const RunResult&)>& consume) {
  const RunRange runs = options.runs.value_or(RunRange{0, model.n_runs()});
  ordered_parallel<RunResult>(
      runs.count(), options.threads,
      [&](std::size_t i) {
        return run_once(model, runs.first + static_cast<std::uint32_t>(i), options.record, options.trace);
      },
      [&](RunResult& result) { consume(result); }, options.goes_on);
}

}  // namespace pirsim
