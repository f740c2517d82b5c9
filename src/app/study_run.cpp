#include "app/study_run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/long_work.hpp"
#include "app/session.hpp"
#include "engine/rt/tracer.hpp"
#include "engine/sim/compiled_study.hpp"
#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "files/write/campaign.hpp"
#include "files/write/casas_writer.hpp"
#include "files/write/frame_writer.hpp"
#include "files/write/row_file.hpp"
#include "files/write/summary.hpp"
#include "model/core/text.hpp"
#include "model/schema/words.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "pirsim/model.hpp"
#include "pirsim/response.hpp"
#include "pirsim/study.hpp"
#include "pirsim/version.hpp"
#include "surveys/look.hpp"
#include "surveys/sight.hpp"
#include "surveys/study_report.hpp"

// What a study writes: rows as runs end, and what needs all runs at once.

namespace pirsim::app {

/// A table that grows run by run.
class TableOutput {
 public:
  virtual ~TableOutput() = default;
  [[nodiscard]] virtual RunRange missing_runs() const = 0;
  /// Tells how many bytes that takes before compression. A run that isn't missing adds nothing.
  virtual std::size_t add_run(const RunResult& result, const io::RunNotes& notes) = 0;
  /// Of all runs, also of those that were there before.
  [[nodiscard]] virtual const io::RunNotes& notes() const = 0;
  /// After the last run. To compress much takes long: goes_on is asked meanwhile, and if it says no, Error(stopped) is
  /// thrown and nothing is lost.
  virtual void commit(const std::function<bool()>& goes_on) = 0;
  /// The study ends early and won't be resumed: removes what was written.
  virtual void discard() noexcept = 0;
  [[nodiscard]] virtual std::uint64_t rows() const = 0;
};

/// Whether rows go where they can be resumed.
[[nodiscard]] bool is_resumable(const RowOptions& options);

/// The tables that can be cut into shards, stopped and resumed: rows, and who is where if that is asked for.
class StudyTables {
 public:
  /// Throws Error: usage (a shard without a folder, and the like), io, input (nothing that could be resumed).
  StudyTables(const Model& model, const RunOptions& options);

  [[nodiscard]] RunRange missing_runs() const;  ///< of any of them
  /// Gives the bytes of who is where, or of rows if these are all.
  std::size_t add_run(const RunResult& result, const io::RunNotes& notes);
  void commit(const std::function<bool()>& goes_on);
  void discard() noexcept;
  [[nodiscard]] const TableOutput& rows() const { return *tables_.front(); }

 private:
  std::vector<std::unique_ptr<TableOutput>> tables_;
};

/// Once the first run tells how much a run writes: some studies would fill a disk.
void announce(const std::string& option, std::size_t first_bytes, const Model& model, Verbosity verbosity);

[[nodiscard]] bool has_whole_study_outputs(const RunOptions& options);

/// Nothing of them is left if the study ends early.
class WholeStudyOutputs {
 public:
  /// Throws Error: usage for what the study hasn't got (before anything is opened), io.
  WholeStudyOutputs(const Model& model, const Inputs& inputs, const RunOptions& options);
  ~WholeStudyOutputs();
  void add(const RunResult& result);
  void commit(const io::RunNotes& notes);
  [[nodiscard]] bool need_occupants() const noexcept;

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

void offer_size(CLI::App& command, Size& size) {
  command.add_flag_callback(
      "--large", [&size] { size = Size::any; },
      "write it however large it gets (otherwise at most " + bytes_in_words(film_bytes) + ")");
}

std::string bytes_in_words(double bytes) {
  constexpr double giga = 1e9, mega = 1e6;
  std::ostringstream text;
  if (bytes >= giga) {
    text << std::round(bytes / giga * 10.0) / 10.0 << " GB";
  } else {
    text << std::ceil(bytes / mega) << " MB";
  }
  return text.str();
}

void require_usual(const FilmSize& film, double seconds, Size size) {
  const double bytes = film.bytes_a_byte * studies::expected_bytes(film.n_people, seconds, film.keys_per_s);
  if (size == Size::any || bytes <= film_bytes) return;
  std::ostringstream text;
  text << film.what << " would have about " << bytes_in_words(bytes) << " (" << std::llround(seconds) << " s, "
       << counted(static_cast<std::size_t>(film.n_people), "person", "people") << ", " << film.keys_per_s
       << " keys a second): take a part with --from and --to, fewer --keys-per-s, or give --large";
  throw Error(ErrorCode::usage, text.str());
}

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

/// Pets are nobody, so that no count has them.
void tell_of_pets(const Model& model, const RunOptions& options, Verbosity verbosity) {
  const std::vector<TrialSpec>& trials = model.script().trials;
  if (options.occupants.empty() || trials.empty() || verbosity == Verbosity::quiet) return;
  for (const PetSpec& pet : trials.front().pets)
    std::cerr << "--occupants: without the " << pet.id << "; `pirsim check` says which sensors see it\n";
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

namespace {

/// A file a run and array, and one of the frame that is asked for.
void write_frames(const Model& model, const RunOptions& options, const RunResult& result) {
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const std::filesystem::path file =
        options.frames / io::frame_file(model.scene().arrays[i].id, result.trial, result.replicate);
    io::write_text_file(file, io::to_npy(result.frames[i]));
    if (options.frame_s)
      io::write_text_file(std::filesystem::path(file).replace_extension(".frame.csv"),
                          io::frame_to_csv(result.frames[i], *options.frame_s));
  }
}

}  // namespace

void run(const Model& model, const Inputs& inputs, const RunOptions& options) {
  if (!options.frames.empty()) {
    if (model.scene().arrays.empty()) throw Error(ErrorCode::usage, "--frames: the scene has no thermal array");
    make_folder(options.frames);
  }
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
  study.frames = options.frames.empty() ? Frames::none : Frames::taken;
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
      if (!options.frames.empty()) write_frames(model, options, result);
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
  tell_of_pets(model, options, inputs.verbosity);
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
  offer_output_folder(command, "--frames", options->frames,
                      "folder for frames of thermal arrays: a stack a run and array, .npy, [frame, y, x] in degrees C",
                      {"*.npy", "*.frame.csv"});
  command.add_option("--frame", options->frame_s, "of --frames: also the frame at this second of each run, as CSV")
      ->option_text("SECOND")
      ->needs("--frames")
      ->check(CLI::NonNegativeNumber);
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

namespace {

namespace fs = std::filesystem;

/// Text for a file, compressed by the ending of its name, or for standard output.
class LineOutput {
 public:
  explicit LineOutput(const fs::path& file)
      : file_(file.empty() ? nullptr : std::make_unique<io::AtomicFile>(file)),
        writer_(stream(), io::compression_of(file)) {}

  /// What is written here is in the file after the next pass_on().
  [[nodiscard]] std::ostream& lines() { return lines_; }
  std::size_t pass_on() {
    const std::size_t n_bytes = lines_.view().size();
    writer_.write(lines_.view());
    lines_.str({});
    if (!stream()) put_in_place();  // says why it can't be written
    return n_bytes;
  }
  void commit() {
    pass_on();
    writer_.finish();
    put_in_place();
  }

 private:
  [[nodiscard]] std::ostream& stream() { return file_ ? file_->stream() : std::cout; }
  void put_in_place() { file_ ? file_->commit() : require_written(); }

  std::unique_ptr<io::AtomicFile> file_;
  io::DataWriter writer_;
  std::ostringstream lines_;
};

/// Rows as lines.
class RowLines {
 public:
  RowLines(std::ostream& out, const Model& model) : csv_(out, model.columns()) {}
  std::size_t write(const RunResult& result) {
    for (const Sample& sample : result.samples) csv_.write(sample);
    return result.samples.size();
  }

 private:
  io::CsvWriter csv_;
};

/// Who is where, as lines.
class OccupantLines {
 public:
  OccupantLines(std::ostream& out, const Model& model)
      : csv_(out, column_names<OccupantLine>({.areas = model.areas()})) {}
  std::size_t write(const RunResult& result) {
    for (const OccupantRow& row : result.occupants) csv_.write({result.replicate, result.trial, row});
    return result.occupants.size();
  }

 private:
  io::TableWriter<OccupantLine> csv_;
};

/// Standard output, a device or pipe, or what goes with these.
template <typename Lines>
class StreamedTable final : public TableOutput {
 public:
  StreamedTable(const Model& model, const fs::path& file)
      : runs_{0, model.n_runs()}, output_(file), lines_(output_.lines(), model) {}

  [[nodiscard]] RunRange missing_runs() const override { return runs_; }
  std::size_t add_run(const RunResult& result, const io::RunNotes& notes) override {
    rows_ += lines_.write(result);
    notes_ += notes;
    return output_.pass_on();
  }
  void commit(const std::function<bool()>&) override { output_.commit(); }
  void discard() noexcept override {}
  [[nodiscard]] std::uint64_t rows() const override { return rows_; }
  [[nodiscard]] const io::RunNotes& notes() const override { return notes_; }

 private:
  RunRange runs_;
  LineOutput output_;
  Lines lines_;
  std::uint64_t rows_ = 0;
  io::RunNotes notes_;
};

template <typename Lines>
class ResumableTable final : public TableOutput {
 public:
  ResumableTable(const Model& model, const fs::path& file, io::Manifest made, RowOptions::Start start)
      : end_(made.runs.end),
        lines_(text_, model),
        file_(file, std::move(made), text_.str(),
              start == RowOptions::Start::resume ? io::RowFile::Start::resume : io::RowFile::Start::anew) {}

  [[nodiscard]] RunRange missing_runs() const override { return {file_.next_run(), end_}; }
  std::size_t add_run(const RunResult& result, const io::RunNotes& notes) override {
    if (result.run < file_.next_run()) return 0;  // another table of the study misses it
    text_.str({});
    const std::size_t n_rows = lines_.write(result);
    file_.add_run(text_.view(), n_rows, notes);
    return text_.view().size();
  }
  void commit(const std::function<bool()>& goes_on) override {
    if (!file_.finished()) file_.commit(goes_on);
  }
  void discard() noexcept override { file_.discard(); }
  [[nodiscard]] std::uint64_t rows() const override { return file_.rows(); }
  [[nodiscard]] const io::RunNotes& notes() const override { return file_.notes(); }

 private:
  std::uint32_t end_;
  std::ostringstream text_;
  Lines lines_;
  io::RowFile file_;
};

std::string tracer_used(const Model& model) {
  std::string name(rt::name(model.compiled().tracer()));
  if (model.compiled().tracer() == TracerKind::direct) name += " " + std::string(rt::direct_instruction_set());
  return name;
}

io::Manifest manifest_of(const Model& model) {
  std::vector<InputFile> files = model.script().files;
  files.insert(files.end(), model.scene().files.begin(), model.scene().files.end());
  io::Manifest manifest;
  manifest.provenance = {.version = version(),
                         .git_revision = git_revision(),
                         .compiler = compiler(),
                         .embree = rt::embree_version() + " " + rt::instruction_set(),
                         .inputs = io::named(files),
                         .resolved_script = io::to_yaml(model.script()),
                         .seed = model.script().seed,
                         .study_runs = model.n_runs()};
  const SensingSpec& sensing = model.script().sensing;
  for (std::uint32_t i = 0; i < model.scene().sensors.size(); ++i) {
    const SensorSpec& sensor = model.scene().sensors[i];
    const Response response = response_of(model.scene(), sensing, sensor);
    std::string words = word_of(response);
    if (response == Response::analog && sensing.units != Units::typical) {
      const double times = unit_sensitivity(model.scene(), sensing.units, model.script().seed, i);
      words += std::string(", ") + word_of(sensing.units) + ": " + fixed(times, 2);
    }
    manifest.provenance.responses.emplace_back(sensor.id, std::move(words));
  }
  manifest.tracer = tracer_used(model);
  manifest.runs = {0, model.n_runs()};
  return manifest;
}

/// A part of an array that is submitted again must not be taken for a whole array.
void refuse_other_shards(const fs::path& folder, const Shard& shard) {
  std::error_code fault;
  for (const auto& entry : fs::directory_iterator(folder, fault)) {
    const auto other = studies::shard_of(entry.path().filename().string());
    if (!other || other->count == shard.count) continue;
    throw Error(ErrorCode::usage, "--shard: this is shard " + std::to_string(shard.index) + " of " +
                                      std::to_string(shard.count) + ", but '" + folder.string() + "' holds shards of " +
                                      std::to_string(other->count) + "; use --shard auto/" +
                                      std::to_string(other->count) + " or another folder");
  }
}

template <typename Lines>
std::unique_ptr<TableOutput> open_table(const Model& model, const RowOptions& options, const fs::path& output,
                                        const std::string& table) {
  io::Manifest manifest = manifest_of(model);
  manifest.table = table;
  if (options.shard.empty()) {
    if (!is_resumable(options) || io::is_written_directly(output))
      return std::make_unique<StreamedTable<Lines>>(model, output);
    return std::make_unique<ResumableTable<Lines>>(model, output, std::move(manifest), options.start);
  }
  const Shard shard = studies::parse_shard(options.shard);
  make_folder(output);
  refuse_other_shards(output, shard);
  manifest.shard = shard;
  manifest.runs = runs_of(shard, model.n_runs());
  return std::make_unique<ResumableTable<Lines>>(model, output / (studies::shard_name(shard) + options.format),
                                                 std::move(manifest), options.start);
}

}  // namespace

bool is_resumable(const RowOptions& options) {
  return !options.output.empty() && !io::is_written_directly(options.output);
}

StudyTables::StudyTables(const Model& model, const RunOptions& options) {
  const RowOptions& rows = options.rows;
  tables_.push_back(open_table<RowLines>(model, rows, rows.output, ""));
  if (options.occupants.empty()) return;
  try {
    tables_.push_back(open_table<OccupantLines>(model, rows, options.occupants, "occupants"));
  } catch (...) {
    if (rows.start == RowOptions::Start::anew) discard();
    throw;
  }
}

RunRange StudyTables::missing_runs() const {
  RunRange missing = tables_.front()->missing_runs();
  for (const auto& table : tables_) missing.first = std::min(missing.first, table->missing_runs().first);
  return missing;
}

std::size_t StudyTables::add_run(const RunResult& result, const io::RunNotes& notes) {
  std::size_t n_bytes = 0;
  for (const auto& table : tables_) n_bytes = table->add_run(result, notes);
  return n_bytes;
}

void StudyTables::commit(const std::function<bool()>& goes_on) {
  for (const auto& table : tables_) table->commit(goes_on);
}

void StudyTables::discard() noexcept {
  for (const auto& table : tables_) table->discard();
}

namespace {

std::vector<std::string> sensor_ids(const Model& model) {
  std::vector<std::string> ids;
  for (const SensorSpec& sensor : model.scene().sensors) ids.push_back(sensor.id);
  return ids;
}

std::vector<std::string> door_ids(const Model& model) {
  std::vector<std::string> ids;
  for (const DoorSpec& door : model.scene().doors) ids.push_back(door.id);
  return ids;
}

std::vector<std::size_t> first_zones(const Model& model) {
  const RayBundle& rays = model.rays();
  std::vector<std::size_t> begins;
  for (const auto cluster : rays.sensor_clusters_begin) begins.push_back(rays.cluster_zones_begin[cluster]);
  return begins;
}

studies::Summary make_summary(const Model& model, const RunOptions& options) {
  std::vector<std::string> trials;
  for (const TrialSpec& trial : model.script().trials) trials.push_back(trial.id);
  const bool compared = !options.summary.empty() || !options.report.empty();
  const std::vector<MeasuredCell> measured = compared ? measured_cells(model.script()) : std::vector<MeasuredCell>{};
  return {trials, sensor_ids(model), measured};
}

/// A log is of days that follow each other.
void require_one_clock(const Model& model) {
  const std::vector<TrialSpec>& trials = model.script().trials;
  if (trials.size() == 1 && (trials.front().schedule || model.n_runs() == 1) && model.compiled().trials().front().clock)
    return;
  throw Error(
      ErrorCode::usage,
      "--casas: a log has a date and a time on each line: it takes days of a schedule, or one run with `begin`");
}

/// What is recorded at every tick is in memory until its run ends.
void require_memory(const std::string& option, double bytes_a_tick, const Model& model) {
  const SensingInForce& sensing = model.compiled().sensing();
  for (const sim::TrialModel& trial : model.compiled().trials()) {
    const double bytes = trial.duration_s.value_or(0.0) * sensing.tick_rate_hz * bytes_a_tick;
    if (bytes <= run_bytes) continue;
    throw Error(ErrorCode::usage, option + ": a run of trial '" + trial.id + "' would take about " +
                                      bytes_in_words(bytes) + " of memory, more than " + bytes_in_words(run_bytes) +
                                      ": simulate a shorter part of it, or fewer ticks a second");
  }
}

void require_memory(const Model& model, const RunOptions& options) {
  const sim::AnalogModel* analog = model.compiled().array().analog();
  const std::size_t zone_bytes = sizeof(ZoneSet) + ZoneSet(model.rays().n_zones()).words().size_bytes();
  if (!options.zones.empty()) require_memory("--zones", static_cast<double>(zone_bytes), model);
  if (!options.trace.empty() && analog != nullptr)
    require_memory("--trace", static_cast<double>(sizeof(TraceRow) * model.scene().sensors.size()), model);
}

/// Zones of all runs.
class ZoneOutput {
 public:
  ZoneOutput(const std::filesystem::path& file, const Model& model)
      : sensors_(sensor_ids(model)), first_zones_(first_zones(model)), output_(file), csv_(output_.lines()) {}

  /// Bytes before compression.
  std::size_t add(const RunResult& result) {
    std::int64_t tick = 0;
    for (const ZoneSet& active : result.zones) {
      ++tick;
      std::vector<std::uint8_t> bits(active.size());
      for (std::size_t zone = 0; zone < bits.size(); ++zone) bits[zone] = active.test(zone) ? 1 : 0;
      for (std::size_t i = 0; i < sensors_.size(); ++i) {
        const auto zones = std::span(bits).subspan(first_zones_[i], first_zones_[i + 1] - first_zones_[i]);
        csv_.write({result.replicate, result.trial, tick, sensors_[i], zones});
      }
    }
    return output_.pass_on();
  }
  void commit() { output_.commit(); }

 private:
  std::vector<std::string> sensors_;
  std::vector<std::size_t> first_zones_;  ///< of each sensor, and behind the last one
  LineOutput output_;
  io::TableWriter<ZoneLine> csv_;
};

/// All runs as the log of a smart home.
class CasasOutput {
 public:
  CasasOutput(const std::filesystem::path& file, const Model& model)
      : output_(file), log_(output_.lines(), sensor_ids(model), door_ids(model)) {}

  /// Bytes before compression.
  std::size_t add(const RunResult& result) {
    log_.add(result.samples, result.occupants);
    return output_.pass_on();
  }
  void commit() {
    log_.finish();
    output_.commit();
  }

 private:
  LineOutput output_;
  io::CasasWriter log_;
};

/// Signals of all runs and what is behind them.
class TraceOutput {
 public:
  TraceOutput(const std::filesystem::path& file, const Model& model)
      : sensors_(sensor_ids(model)),
        tick_rate_hz_(model.compiled().sensing().tick_rate_hz),
        output_(file),
        csv_(output_.lines()) {}

  /// Bytes before compression.
  std::size_t add(const RunResult& result) {
    for (const TraceRow& row : result.trace) {
      const double time_s = static_cast<double>(row.tick) / tick_rate_hz_;
      csv_.write({result.replicate, result.trial, time_s, sensors_[row.sensor], row});
    }
    return output_.pass_on();
  }
  void commit() { output_.commit(); }

 private:
  std::vector<std::string> sensors_;
  int tick_rate_hz_;
  LineOutput output_;
  io::TableWriter<TraceLine> csv_;
};

}  // namespace

void announce(const std::string& option, std::size_t first_bytes, const Model& model, Verbosity verbosity) {
  constexpr double worth_telling = 1e8;  // assumed: 0.1 GB surprises nobody
  const double bytes = static_cast<double>(first_bytes) * model.n_runs();
  if (verbosity == Verbosity::quiet || bytes < worth_telling) return;
  std::ostringstream text;
  text << std::setprecision(2) << option << ": the first of " << counted(model.n_runs(), "run") << " has "
       << static_cast<double>(first_bytes) * 1e-6 << " MB, so all will have about " << bytes * 1e-9
       << " GB before compression\n";
  std::cerr << text.str();
}

bool has_whole_study_outputs(const RunOptions& options) {
  return !options.summary.empty() || !options.zones.empty() || !options.trace.empty() || !options.report.empty() ||
         !options.casas.empty();
}

struct WholeStudyOutputs::Files {
  const Model& model;
  const Inputs& inputs;
  const RunOptions& options;
  studies::Summary summary;
  studies::StudyReport report;
  std::optional<ZoneOutput> zones{};
  bool unannounced = true;
  std::optional<TraceOutput> trace{};
  std::optional<CasasOutput> casas{};
  std::optional<io::AtomicFile> summary_file{}, report_file{};
};

WholeStudyOutputs::WholeStudyOutputs(const Model& model, const Inputs& inputs, const RunOptions& options)
    : files_(new Files{model, inputs, options, make_summary(model, options), studies::StudyReport(model)}) {
  if (!options.trace.empty() && model.compiled().array().analog() == nullptr)
    throw Error(ErrorCode::usage, "--trace: no sensor has an analog response");
  require_memory(model, options);
  if (!options.casas.empty()) require_one_clock(model);
  if (!options.zones.empty()) files_->zones.emplace(options.zones, model);
  if (!options.casas.empty()) files_->casas.emplace(options.casas, model);
  if (!options.trace.empty()) files_->trace.emplace(options.trace, model);
  if (!options.summary.empty()) files_->summary_file.emplace(options.summary);
  if (!options.report.empty()) files_->report_file.emplace(options.report);
}

WholeStudyOutputs::~WholeStudyOutputs() = default;

bool WholeStudyOutputs::need_occupants() const noexcept {
  return files_->casas || (files_->report_file && files_->report.needs_occupants());
}

void WholeStudyOutputs::add(const RunResult& result) {
  Files& files = *files_;
  if (result.fault) return;
  const bool first = std::exchange(files.unannounced, false);
  const auto add = [&](auto& output, const std::string& option) {
    if (!output) return;
    const std::size_t n_bytes = output->add(result);
    if (first) announce(option, n_bytes, files.model, files.inputs.verbosity);
  };
  add(files.zones, "--zones");
  add(files.trace, "--trace");
  add(files.casas, "--casas");
  if (files.report_file) files.report.add_run(result);
  if (!files.summary_file && !files.report_file) return;
  studies::RunCounts counts(files.model.scene().sensors.size(), files.model.script().summary, files.model.areas());
  for (const Sample& sample : result.samples) counts.add(sample);
  files.summary.add_run(result.trial, counts.counts(), counts.areas());
}

void WholeStudyOutputs::commit(const io::RunNotes& notes) {
  Files& files = *files_;
  if (files.zones) files.zones->commit();
  if (files.trace) files.trace->commit();
  if (files.casas) files.casas->commit();
  if (files.summary_file) {
    write_summary(files.summary, *files.summary_file, files.options.summary, files.model.script().name, notes.remarks(),
                  files.inputs.verbosity);
  }
  if (files.report_file) write_page(*files.report_file, files.report.finish(files.summary), files.inputs);
}

}  // namespace pirsim::app
