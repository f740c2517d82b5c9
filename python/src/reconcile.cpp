// Model against measurement.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <pirsim/reconcile.hpp>
#include <pirsim/version.hpp>

#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

/// What pirsim.reconcile() asks for, as its arguments.
struct Question {
  double alpha = 0.05;
  int max_effects = 3;
  double budget = 1.0;
  std::vector<std::string> effects;
  std::string nuisance;  ///< file, "none", or empty: the usual
  std::string folder;    ///< of the report
  std::string table;     ///< folder of simulated datasets
};

reconcile::Settings settings_of(const Question& question, const ScriptSpec& script) {
  reconcile::Settings settings = reconcile::settings_of(script, question.alpha, question.budget, question.effects);
  settings.max_effects = question.max_effects;
  settings.nuisance = reconcile::nuisance_of(question.nuisance);
  settings.table_folder = question.table;
  return settings;
}

/// What was repaired or ignored, as an InputWarning each.
nb::list warnings(const SceneSpec& scene, const ScriptSpec& script, const std::vector<std::string>& of_data,
                  const std::vector<std::string>& of_analysis) {
  nb::list told;
  for (const auto* issues : {&scene.warnings, &script.warnings}) {
    for (const Issue& issue : *issues) told.append(to_python(to_string(issue)));
  }
  for (const auto* notes : {&of_data, &of_analysis}) {
    for (const std::string& note : *notes) told.append(to_python(note));
  }
  return told;
}

nb::dict to_dict(const reconcile::Outcome& outcome, const ScriptSpec& script) {
  nb::dict result;
  result["verdict"] = to_python(std::string(name(outcome.verdict)));
  result["sentence"] = to_python(reconcile::sentence(outcome));
  result["data_findings"] = listed(outcome.data_findings, [](const reconcile::DataFinding& finding) {
    return to_python(reconcile::in_words(finding));
  });
  result["details"] = to_python(reconcile::details(outcome));
  result["p"] = outcome.location.p;
  result["named"] = to_python(outcome.named);
  result["fits"] = listed(outcome.fits, [](const reconcile::FittedEffect& fit) {
    nb::dict intervals;
    for (const reconcile::FittedParameter& p : fit.parameters) {
      intervals[to_python(p.name)] = nb::make_tuple(p.interval.low, p.interval.high);
    }
    return nb::make_tuple(to_python(fit.effect), intervals);
  });
  result["candidates"] = listed(outcome.candidates, [](const reconcile::Candidate& candidate) {
    return nb::make_tuple(to_python(candidate.score.hypothesis), candidate.score.probability, candidate.score.p,
                          nb::bool_(candidate.kept), to_python(reconcile::in_words(candidate)));
  });
  result["cells"] = listed(outcome.location.cells, [](const reconcile::LocatedCell& cell) {
    return nb::make_tuple(to_python(cell.trial), to_python(cell.sensor), cell.measured_s, cell.expected_s, cell.low_s,
                          cell.high_s, cell.adjusted_p);
  });
  result["patched"] = to_python(reconcile::patched(script, outcome));
  return result;
}

/// measured: the name of a file, or with `text` its content. names: of program, scene and script, for the report.
nb::dict reconcile_study(nb::handle scene, nb::handle script, const std::string& measured, const std::string& text,
                         const std::vector<std::string>& overrides, const Folders& folders, const Question& question,
                         std::uint64_t seed, unsigned threads, nb::handle progress) {
  const ScriptSpec given = script_of(script, overrides, folders);
  const SceneSpec scene_spec = scene_of(scene, folders);
  const reconcile::Measured rows = text.empty() ? reconcile::read_measured(measured, scene_spec, given)
                                                : reconcile::parse_measured(text, measured, scene_spec, given);
  const ScriptSpec script_spec = reconcile::with_holds(scene_spec, given, rows);
  const reconcile::Settings settings = settings_of(question, given);
  reconcile::Outcome outcome;
  attend(progress, [&](Job& job) {
    reconcile::Context context{seed, threads};
    const auto stop = [&] {
      if (job.stop) throw Job::Stopped{};
    };
    context.observer.stage = [&](const std::string&) { stop(); };
    context.observer.progress = [&](std::uint32_t done, std::uint32_t total) {
      job.n_all = total;
      job.n_done = done;
      stop();
    };
    outcome = reconcile::reconcile(scene_spec, script_spec, rows, settings, context);
    if (question.folder.empty()) return;
    reconcile::write_report(
        question.folder, outcome, rows, script_spec, settings, context,
        {"pirsim " + version() + " " + git_revision(), scene_spec.name, script_spec.name, measured, {}});
  });
  nb::dict result = to_dict(outcome, script_spec);
  result["warnings"] = warnings(scene_spec, script_spec, rows.notes, outcome.notes);
  return result;
}

}  // namespace

void add_reconcile(nb::module_& module) {
  nb::class_<Question>(module, "Question", "Arguments of pirsim.reconcile().")
      .def(nb::init<>())
      .def_rw("alpha", &Question::alpha)
      .def_rw("max_effects", &Question::max_effects)
      .def_rw("budget", &Question::budget)
      .def_rw("effects", &Question::effects)
      .def_rw("nuisance", &Question::nuisance)
      .def_rw("folder", &Question::folder)
      .def_rw("table", &Question::table);
  module.def("reconcile", &reconcile_study, "scene"_a, "script"_a, "measured"_a, "text"_a, "overrides"_a, "folders"_a,
             "question"_a, "seed"_a, "threads"_a, "progress"_a.none(), "Parts of pirsim.Reconciliation, by name.");
}

}  // namespace pirsim::python
