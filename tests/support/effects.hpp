// Small studies to try effects on.
#pragma once

#include <numeric>

#include "engine/effects/catalogue.hpp"
#include "support/shipped.hpp"

namespace pirsim::test {

/// Two trials of Study A, shortened.
inline ScriptSpec short_study_a(int replicates = 1) {
  return shipped_script("studyA.yaml", {"trials.for_each.seat=[S4, S10]", "replicates=" + std::to_string(replicates),
                                        "people.0.actions.3.work.duration_s=35"});
}
/// The open office with three people, shortened. Sensors answer by hard zones, on which all effects act.
inline ScriptSpec short_office() {
  return shipped_script("office.yaml",
                        {"sensing.response=zones", "replicates=1", "people.0.actions.2.work.duration_s=20",
                         "people.1.actions.0.wait_s=1", "people.1.actions.3.work.duration_s=10",
                         "people.1.actions.5.wait_s=5", "people.2.actions.0.wait_s=2", "people.2.actions.4.at_s=30"});
}

inline ScriptSpec with(ScriptSpec script, std::vector<EffectSpec> effects) {
  script.effects = std::move(effects);
  return script;
}

/// As a script may have it: without what is usual.
inline EffectSpec bare_effect(const std::string& name, std::map<std::string, double, std::less<>> parameters,
                              std::map<std::string, std::string, std::less<>> choices = {}) {
  return {name, std::move(parameters), std::move(choices), {}};
}

/// Every strength at an end of its prior, the lower if there are two, details as usual.
inline EffectSpec strong(const effects::Effect& effect) {
  EffectSpec spec{effect.info.name, {}, {}, {}};
  for (const effects::ParameterInfo& parameter : effect.info.parameters) {
    if (!effects::applies(parameter, spec)) continue;
    const bool is_strength = parameter.role == effects::Role::strength;
    spec.parameters[parameter.name] = !is_strength                    ? parameter.typical
                                      : parameter.low < parameter.off ? parameter.low
                                                                      : parameter.high;
  }
  return spec;
}

inline std::vector<RunResult> results_of(const Model& model, unsigned threads = 0) {
  std::vector<RunResult> results;
  run_study(model, {threads, Record::samples}, [&](const RunResult& result) { results.push_back(result); });
  return results;
}

inline bool same_rows(const std::vector<RunResult>& a, const std::vector<RunResult>& b) {
  return std::ranges::equal(a, b, {}, &RunResult::samples, &RunResult::samples);
}

inline std::vector<std::uint32_t> all_runs(const Model& model) {
  std::vector<std::uint32_t> runs(model.n_runs());
  std::iota(runs.begin(), runs.end(), 0U);
  return runs;
}

}  // namespace pirsim::test
