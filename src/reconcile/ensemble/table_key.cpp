#include "effects/catalogue.hpp"
#include "pirsim/version.hpp"
#include "reconcile/ensemble/reference_table.hpp"
#include "schema/fingerprint.hpp"

namespace pirsim::reconcile {
namespace {

// Structured bindings name every field, so that a new one doesn't compile until it stands here.

void add(Fingerprint& print, const Units& units) {
  const auto& [trial, n_days, n_rows, of_row, people, names, begins_s] = units;
  print.add_each(trial, n_days, n_rows, of_row, people, names, begins_s);
}

void add(Fingerprint& print, const StudyFrame& frame) {
  const auto& [trials, sensors, counted_phases, window_s, units] = frame;
  print.add_each(trials, sensors, counted_phases, window_s);
  add(print, units);
}

void add(Fingerprint& print, const TableSettings& settings) {
  const auto& [n_realizations, n_remembered, n_traced, hypotheses] = settings;
  print.add_each(n_realizations, n_remembered, n_traced, hypotheses);
  for (const std::string& hypothesis : hypotheses) {  // and what is drawn of them
    for (const effects::ParameterInfo& parameter : effects::find(hypothesis).info.parameters)
      print.add_each(parameter.name, parameter.low, parameter.high, parameter.scale);
  }
}

}  // namespace

std::string table_key(const RealizationSource& source, const StudyFrame& frame, int n_replicates,
                      const TableSettings& settings) {
  Fingerprint print;
  print.add_each(version(), git_revision(), source.scene);
  ScriptSpec script = source.script;
  script.seed = 0;  // realizations have seeds of their own
  script.replicates = 1;
  print.add_each(script, source.nuisance, source.seed, n_replicates, n_statistics(frame));
  add(print, settings);
  add(print, frame);
  return print.digest();
}

}  // namespace pirsim::reconcile
