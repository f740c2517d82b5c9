#include "app/study_run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iostream>
#include <sstream>

#include "app/long_work.hpp"
#include "app/session.hpp"
#include "app/study_outputs.hpp"
#include "core/text.hpp"
#include "io/write/row_file.hpp"
#include "pirsim/study.hpp"
#include "sim/compiled_study.hpp"
#include "studies/sight.hpp"

namespace pirsim::app {
namespace {

io::FailedRun failed_run(const RunResult& result, const std::optional<RunClock>& clock) {
  const double time_s = result.fault->time_s;
  return {result.run, result.trial, result.replicate, time_s, clock ? clock->text(time_s) : "", result.fault->message};
}

/// As rows tell the time: "2026-03-02T08:30:00", or without a clock "second 123".
std::string time_of(const std::optional<RunClock>& clock, double run_s) {
  if (clock) return clock->text(run_s);
  return "second " + std::to_string(std::lround(run_s));
}

std::string place_of(const RunIncident& incident, const RunResult& result, const std::optional<RunClock>& clock) {
  std::ostringstream text;
  text.precision(3);
  text << "trial " << result.trial << ", replicate " << result.replicate << ", '" << incident.person << "' at ("
       << incident.place_m.x << ", " << incident.place_m.y << ") m, " << time_of(clock, incident.time_s);
  return text.str();
}

std::string moment_of(const RunIncident& incident, const RunResult& result, const std::optional<RunClock>& clock) {
  return "trial " + result.trial + ", replicate " + std::to_string(result.replicate) + ", '" + incident.person + "', " +
         time_of(clock, incident.time_s);
}

io::RunNotes notes_of(const RunResult& result, const Model& model) {
  const std::optional<RunClock> clock = model.compiled().clock_of(result.run);
  io::RunNotes notes;
  for (const RunIncident& incident : result.incidents) {
    switch (incident.kind) {
      case IncidentKind::passed_through:
        ++notes.passes_through;
        if (notes.first_pass.empty()) notes.first_pass = place_of(incident, result, clock);
        break;
      case IncidentKind::seat_changed:
        ++notes.seats_changed;
        break;
      case IncidentKind::seat_missed:
        ++notes.seats_missed;
        break;
      case IncidentKind::waited_outside:
        ++notes.waits_outside;
        if (notes.first_wait.empty()) notes.first_wait = moment_of(incident, result, clock);
        break;
    }
  }
  if (result.fault) notes.failed.push_back(failed_run(result, clock));
  return notes;
}

std::string describe(const io::FailedRun& run) {
  std::ostringstream text;
  text << "trial " << run.trial << ", replicate " << run.replicate << ", ";
  if (run.time.empty()) {
    text << "second " << run.time_s;
  } else {
    text << run.time;
  }
  text << ": " << run.message;
  return text.str();
}

}  // namespace

void tell(const io::RunNotes& notes, Verbosity verbosity) {
  const auto warn = [&](std::uint64_t n, const std::string& what) {
    if (n > 0 && verbosity != Verbosity::quiet) std::cerr << "warning: " << counted(n, "time") << what << '\n';
  };
  warn(notes.passes_through, " a person who had been held up walked through others; first in " + notes.first_pass);
  warn(notes.seats_changed, " a person took another seat because theirs stayed taken");
  warn(notes.seats_missed, " a person stayed without a seat because theirs stayed taken");
  warn(notes.waits_outside,
       " a person waited outside, unseen, since the seat they came for was taken; first in " + notes.first_wait);
  if (notes.failed.empty()) return;
  constexpr std::size_t most_told = 10;
  std::string message = counted(notes.failed.size(), "run") +
                        (notes.failed.size() == 1 ? " failed and has no rows" : " failed and have no rows");
  for (std::size_t i = 0; i < std::min(notes.failed.size(), most_told); ++i) {
    message += "\n  " + describe(notes.failed[i]);
  }
  throw Error(ErrorCode::incomplete, message);
}

namespace {

void tell_what_is_written(const RunOptions& options, const TableOutput& rows, std::uint32_t n_new,
                          Verbosity verbosity) {
  if (verbosity == Verbosity::quiet) return;
  if (n_new == 0 && options.rows.start == RowOptions::Start::resume) {
    std::cerr << options.rows.output.string() << ": nothing to resume, all runs are there\n";
    return;
  }
  std::vector<WrittenFile> files;
  if (is_resumable(options.rows)) files.push_back({options.rows.output, counted(rows.rows(), "row")});
  for (const auto& file :
       {options.summary, options.report, options.zones, options.trace, options.occupants, options.casas})
    files.push_back({file});
  tell_written(files, verbosity);
}

/// Of all these runs, nearly; 0 if runs end when everybody is done.
double simulated_s(const Model& model, const RunRange& runs) {
  const std::vector<sim::TrialModel>& trials = model.compiled().trials();
  double sum_s = 0.0;
  for (const sim::TrialModel& trial : trials) {
    if (!trial.duration_s) return 0.0;
    sum_s += *trial.duration_s;
  }
  return sum_s / static_cast<double>(trials.size()) * runs.count();
}

std::string stop_message(const RunOptions& options, const std::string& cause, const Model& model,
                         const StudyTables& tables) {
  const RunRange left = tables.missing_runs();
  std::string message = "stopped by " + cause;
  if (!is_resumable(options.rows)) return message;
  message += ", " + std::to_string(left.count()) + " of " + counted(model.n_runs(), "run") +
             (left.count() == 1 ? " is left" : " are left");
  return message + "; --resume continues";
}

}  // namespace

namespace {

/// Of a table that can be resumed: with what lies beside it, or of a shard its folder.
std::vector<NamedFile> outputs_of(const std::string& option, const std::filesystem::path& output,
                                  const RowOptions& rows) {
  if (!rows.shard.empty()) return {{option, output, {}, {"shard-*"}}};
  std::vector<NamedFile> outputs{{option, output, io::table_endings()}};
  if (output.empty() || io::is_written_directly(output)) return outputs;
  for (const std::filesystem::path& file : io::files_beside(output))
    outputs.push_back({"what lies beside " + option, file});
  return outputs;
}

}  // namespace

void check_options(const RunOptions& options) {
  const bool sharded = !options.rows.shard.empty();
  const char* partial = sharded                                           ? "--shard"
                        : options.rows.start == RowOptions::Start::resume ? "--resume"
                        : options.max_time_s                              ? "--max-time"
                                                                          : nullptr;
  if (partial == nullptr) return;
  if (options.rows.output.empty()) {
    throw Error(ErrorCode::usage, std::string(partial) + " needs -o " + (sharded ? "DIR" : "FILE"));
  }
  struct Table {
    std::string option;
    std::filesystem::path output;
  };
  for (const auto& [option, output] : {Table{"-o", options.rows.output}, Table{"--occupants", options.occupants}}) {
    if (output.empty()) continue;
    const std::string name = output.filename().string();
    if (sharded &&
        std::ranges::any_of(io::table_endings(), [&](const auto& ending) { return name.ends_with(ending); })) {
      throw Error(ErrorCode::usage, "--shard: " + option + " '" + output.string() +
                                        "' is named as a file, but is to be a folder: a file a shard");
    }
    if (!sharded && io::is_written_directly(output)) {
      throw Error(ErrorCode::usage, std::string(partial) + ": '" + output.string() +
                                        "' is not a regular file, so its rows can't be resumed");
    }
  }
  if (has_whole_study_outputs(options)) {
    throw Error(ErrorCode::usage,
                std::string(partial) +
                    " goes with none of --summary, --zones, --trace, --casas and --report: they need all runs at once");
  }
}

void run(const Model& model, const Inputs& inputs, const RunOptions& options) {
  if (inputs.verbosity != Verbosity::quiet) {
    const Progress looking({.what = "looking at what sensors see"}, inputs.verbosity);
    tell(studies::warnings(studies::look_around(model), model.scene()), inputs.verbosity);
  }

  // Rows that only go to a stream can end anywhere, as by Ctrl-C.
  std::optional<StopRequest> stop;
  if (!options.rows.output.empty() || !options.occupants.empty() || has_whole_study_outputs(options)) stop.emplace();
  WholeStudyOutputs others(model, inputs, options);  // first: what it refuses must leave no rows behind
  StudyTables tables(model, options);
  const RunRange runs = tables.missing_runs();
  const std::uint32_t wanted = runs.count();
  Progress progress({"simulating", wanted, "runs", simulated_s(model, runs)}, inputs.verbosity);
  std::atomic<std::uint32_t> done = 0;
  const auto out_of_time = [&] { return options.max_time_s && done > 0 && progress.seconds() >= *options.max_time_s; };
  StudyOptions study;
  study.threads = options.threads;
  study.record = options.zones.empty() ? Record::samples : Record::samples_and_zones;
  study.trace = options.trace.empty() ? Trace::none : Trace::signals;
  study.occupants = !options.occupants.empty() || others.need_occupants() ? Occupants::told : Occupants::counted;
  study.runs = runs;
  const double window_s = model.tick_s() * model.compiled().sensing().ticks_per_window;
  study.window_done = [&] { progress.simulated(window_s); };
  const auto is_wanted = [&] { return !(stop && stop->was_made()); };
  study.goes_on = [&] { return is_wanted() && !out_of_time(); };
  try {
    run_study(model, study, [&](const RunResult& result) {
      if (result.fault && options.faults == RunOptions::Faults::stop) {
        throw Error(ErrorCode::infeasible, describe(failed_run(result, model.compiled().clock_of(result.run))));
      }
      const std::size_t n_bytes = tables.add_run(result, notes_of(result, model));
      if (done == 0 && !options.occupants.empty()) announce("--occupants", n_bytes, model, inputs.verbosity);
      others.add(result);
      ++done;
      progress.finished();
    });
  } catch (const Error& error) {
    // A study that --strict stopped can be resumed, as one that a full disk stopped.
    if (error.code() != ErrorCode::io && error.code() != ErrorCode::infeasible) tables.discard();
    throw;
  }
  if (done < wanted) {
    const std::string cause = stop && stop->was_made() ? stop->signal_name() : "--max-time";
    throw Error(ErrorCode::stopped, stop_message(options, cause, model, tables));
  }
  tables.commit(is_wanted);
  const TableOutput& rows = tables.rows();
  others.commit(rows.notes());
  tell_what_is_written(options, rows, done, inputs.verbosity);
  tell(rows.notes(), inputs.verbosity);
  if (inputs.verbosity == Verbosity::verbose) {
    std::cerr << counted(done, "run") << ", " << counted(rows.rows(), "row") << " in " << progress.seconds() << " s\n";
  }
}

void offer_run_options(CLI::App& command, const std::shared_ptr<RunOptions>& options) {
  const std::string tables = in_words(io::table_endings());
  CLI::Option* rows = command
                          .add_option(output_names, options->rows.output,
                                      "rows, " + tables + " (default, or -: as CSV on standard output)")
                          ->option_text("FILE")
                          ->transform(CLI::Validator(
                              [](std::string& file) {
                                if (file == "-") file.clear();
                                return std::string();
                              },
                              ""));
  declare_outputs(command, rows, [options] { return outputs_of("-o", options->rows.output, options->rows); });
  offer_output(command, "--summary", options->summary,
               "table of sums per trial and sensor, " + in_words(summary_endings()), summary_endings());
  offer_output(command, "--report", options->report, "counts and time series as one self-contained page, .html",
               {".html"});
  offer_output(command, "--zones", options->zones, "every zone's activity at every tick, " + tables,
               io::table_endings());
  offer_output(command, "--trace", options->trace,
               "analog sensors' power, signal and what is behind it at every tick, " + tables, io::table_endings());
  CLI::Option* occupants = command
                               .add_option("--occupants", options->occupants,
                                           "where everybody is and what they do, a row a window and person, " + tables +
                                               "; of a shard a folder")
                               ->option_text("FILE");
  declare_outputs(command, occupants,
                  [options] { return outputs_of("--occupants", options->occupants, options->rows); });
  offer_output(command, "--casas", options->casas,
               "a log of sensors and what people do, as CASAS' homes have it, .txt, .txt.gz or .txt.zst",
               {".txt", ".txt.gz", ".txt.zst"});
  offer_threads(command, options->threads);
  CLI::Option* shard =
      command
          .add_option("--shard", options->rows.shard,
                      "only this block of the runs: I/N, auto/N or auto (in a job array); -o names a folder")
          ->option_text("I/N");
  command.add_option("--format", options->rows.format, "of a shard: " + tables + " (default: .csv)")
      ->option_text("ENDING")
      ->needs(shard)
      ->check(CLI::IsMember(io::table_endings()));
  command.add_flag_callback(
      "--resume", [options] { options->rows.start = RowOptions::Start::resume; },
      "continue after the last complete run; does nothing if all runs are complete");
  command.add_flag_callback(
      "--strict", [options] { options->faults = RunOptions::Faults::stop; },
      "stop at the first run that fails (default: note it, continue with the others, exit code 6)");
  command.add_option("--max-time", options->max_time_s, "stop at the end of a run after so long: 3000, 50m, 2h")
      ->option_text("TIME")
      ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1.0}, {"m", 60.0}, {"h", 3600.0}},
                                        CLI::AsNumberWithUnit::CASE_SENSITIVE, "TIME"))
      ->check(CLI::NonNegativeNumber);
}

}  // namespace pirsim::app
