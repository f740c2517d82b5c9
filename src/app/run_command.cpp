#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/session.hpp"
#include "pirsim/core/version.hpp"
#include "pirsim/effects/catalogue.hpp"
#include "pirsim/io/atomic_file.hpp"
#include "pirsim/io/csv_reader.hpp"
#include "pirsim/io/csv_writer.hpp"
#include "pirsim/io/manifest.hpp"
#include "pirsim/io/script_reader.hpp"
#include "pirsim/sim/study.hpp"
#include "pirsim/studies/sight.hpp"
#include "pirsim/studies/study_report.hpp"
#include "pirsim/studies/summary.hpp"

namespace pirsim::app {
namespace {

/// A file that appears when all is well, or standard output.
class Output {
 public:
  explicit Output(const std::filesystem::path& path) {
    if (!path.empty()) file_.emplace(path);
  }
  [[nodiscard]] std::ostream& stream() { return file_ ? file_->stream() : std::cout; }
  void commit() {
    if (file_) {
      file_->commit();
    } else if (!std::cout.flush()) {
      throw Error(ErrorCode::io, "standard output can't be written");
    }
  }

 private:
  std::optional<io::AtomicFile> file_;
};

std::vector<std::string> sensor_ids(const Model& model) {
  std::vector<std::string> ids;
  for (const SensorSpec& sensor : model.scene().sensors) ids.push_back(sensor.id);
  return ids;
}

std::vector<std::size_t> first_zones(const Model& model) {
  const RayBundle& rays = model.rated_rays();
  std::vector<std::size_t> begins;
  for (const auto cluster : rays.sensor_clusters_begin) begins.push_back(rays.cluster_zones_begin[cluster]);
  return begins;
}

void write_summary(const studies::Summary& summary, io::AtomicFile& file, const RunOptions& options,
                   Verbosity verbosity) {
  file.stream() << (options.summary.extension() == ".md" ? studies::to_markdown(summary) : studies::to_csv(summary));
  file.commit();
  if (verbosity != Verbosity::quiet) std::cerr << studies::to_text(summary);
}

std::string tracer_used(const Model& model) {
  std::string name(rt::name(model.tracer()));
  if (model.tracer() == rt::TracerKind::direct) name += " " + std::string(rt::direct_instruction_set());
  return name;
}

io::Manifest manifest_of(const Model& model, const Inputs& inputs, std::uint64_t rows) {
  return {.program = version() + " " + git_revision() + " " + compiler(),
          .embree = rt::embree_version() + " " + rt::instruction_set(),
          .tracer = tracer_used(model),
          .scene = inputs.scene.filename().string(),
          .script = inputs.script.filename().string(),
          .resolved_script = io::to_yaml(model.script()),
          .seed = model.script().seed,
          .runs = model.n_runs(),
          .rows = rows};
}

studies::Summary make_summary(const Model& model, const RunOptions& options) {
  std::vector<std::string> trials;
  for (const TrialModel& trial : model.trials()) trials.push_back(trial.id);
  const SummarySpec& spec = model.script().summary;
  std::vector<MeasuredCell> measured;
  const bool compared = !options.summary.empty() || !options.report.empty();
  if (compared && !spec.reference_file.empty()) {
    measured = io::read_measured_cells(std::filesystem::path(model.script().directory) / spec.reference_file);
  }
  return {trials, sensor_ids(model), measured};
}

}  // namespace

void run(const Inputs& inputs, const RunOptions& options) {
  if (options.action == RunOptions::Action::print_config) {
    const ScriptSpec script = io::read_script(inputs.script, inputs.overrides);
    Diagnostics diagnostics;
    effects::check(script.effects, diagnostics);
    diagnostics.throw_if_errors();
    std::cout << io::to_yaml(script);
    require_written();
    return;
  }
  const Model model = load(inputs);
  tell(studies::warnings(studies::look_around(model), model.scene().name), inputs.verbosity);

  Output rows(options.output);
  io::CsvWriter csv(rows.stream(), model.columns());
  std::optional<io::AtomicFile> zones_file;
  std::optional<io::ZoneCsvWriter> zones;
  if (!options.zones.empty()) {
    zones_file.emplace(options.zones);
    zones.emplace(zones_file->stream(), sensor_ids(model), first_zones(model));
  }
  std::optional<io::AtomicFile> summary_file;
  if (!options.summary.empty()) summary_file.emplace(options.summary);
  std::optional<io::AtomicFile> report_file;
  if (!options.report.empty()) report_file.emplace(options.report);
  studies::Summary summary = make_summary(model, options);
  studies::StudyReport report(model);
  std::uint64_t n_rows = 0;
  Progress progress(model.n_runs(), inputs.verbosity);
  const StudyOptions study{options.threads, zones ? Record::samples_and_zones : Record::samples};
  run_study(model, study, [&](const RunResult& result) {
    for (const Sample& sample : result.samples) csv.write(sample);
    n_rows += result.samples.size();
    if (!rows.stream()) throw Error(ErrorCode::io, "the rows can't be written: is the disk full?");
    for (std::size_t i = 0; zones && i < result.zones.size(); ++i) {
      zones->write(result.replicate, result.trial, static_cast<std::int64_t>(i) + 1, result.zones[i]);
    }
    studies::RunCounts counts(model.scene().sensors.size(), model.script().summary);
    for (const Sample& sample : result.samples) counts.add(sample);
    summary.add_run(result.trial, counts.counts());
    report.add_run(result, counts.counts());
    progress.run_finished();
  });
  rows.commit();
  if (zones_file) zones_file->commit();
  if (summary_file) write_summary(summary, *summary_file, options, inputs.verbosity);
  if (report_file) write_page(*report_file, report.finish(summary), inputs);
  if (!options.output.empty()) {
    std::filesystem::path side_car = options.output;
    side_car += ".json";
    io::write_manifest(side_car, manifest_of(model, inputs, n_rows));
  }
  if (inputs.verbosity == Verbosity::verbose) {
    std::cerr << model.n_runs() << " runs, " << n_rows << " rows in " << progress.seconds() << " s\n";
  }
}

}  // namespace pirsim::app
