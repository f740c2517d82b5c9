#include "app/study_outputs.hpp"

#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>
#include <utility>

#include "app/output_size.hpp"
#include "app/session.hpp"
#include "core/text.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/compression.hpp"
#include "io/write/casas_writer.hpp"
#include "io/write/row_file.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/io.hpp"
#include "pirsim/response.hpp"
#include "pirsim/version.hpp"
#include "rt/tracer.hpp"
#include "schema/words.hpp"
#include "sim/compiled_study.hpp"
#include "studies/campaign.hpp"
#include "studies/study_report.hpp"
#include "studies/summary.hpp"

namespace pirsim::app {
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
