#include "app/row_output.hpp"

#include <iostream>
#include <sstream>

#include "app/outputs.hpp"
#include "io/atomic_file.hpp"
#include "io/row_file.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/io.hpp"
#include "pirsim/version.hpp"
#include "rt/tracer.hpp"
#include "sim/compiled_study.hpp"
#include "studies/campaign.hpp"

namespace pirsim::app {
namespace {

namespace fs = std::filesystem;

/// Standard output, or a device or pipe.
class StreamedRows final : public RowOutput {
 public:
  StreamedRows(const Model& model, const fs::path& file)
      : runs_{0, model.n_runs()},
        file_(file.empty() ? nullptr : std::make_unique<io::AtomicFile>(file)),
        csv_(stream(), model.columns()) {}

  [[nodiscard]] RunRange missing_runs() const override { return runs_; }
  void add_run(std::span<const Sample> rows, const io::RunNotes& notes) override {
    for (const Sample& sample : rows) csv_.write(sample);
    notes_ += notes;
    rows_ += rows.size();
    if (!stream()) commit();  // which says why
  }
  void commit() override { file_ ? file_->commit() : require_written(); }
  void discard() noexcept override {}
  [[nodiscard]] std::uint64_t rows() const override { return rows_; }
  [[nodiscard]] const io::RunNotes& notes() const override { return notes_; }

 private:
  [[nodiscard]] std::ostream& stream() { return file_ ? file_->stream() : std::cout; }

  RunRange runs_;
  std::unique_ptr<io::AtomicFile> file_;
  io::CsvWriter csv_;
  std::uint64_t rows_ = 0;
  io::RunNotes notes_;
};

class ResumableRows final : public RowOutput {
 public:
  ResumableRows(const fs::path& file, io::Manifest made, const std::vector<std::string>& columns,
                RowOptions::Start start)
      : end_(made.runs.end),
        csv_(lines_, columns),
        file_(file, std::move(made), lines_.str(),
              start == RowOptions::Start::resume ? io::RowFile::Start::resume : io::RowFile::Start::anew) {}

  [[nodiscard]] RunRange missing_runs() const override { return {file_.next_run(), end_}; }
  void add_run(std::span<const Sample> rows, const io::RunNotes& notes) override {
    lines_.str({});
    for (const Sample& sample : rows) csv_.write(sample);
    file_.add_run(lines_.view(), rows.size(), notes);
  }
  void commit() override {
    if (!file_.finished()) file_.commit();
  }
  void discard() noexcept override { file_.discard(); }
  [[nodiscard]] std::uint64_t rows() const override { return file_.rows(); }
  [[nodiscard]] const io::RunNotes& notes() const override { return file_.notes(); }

 private:
  std::uint32_t end_;
  std::ostringstream lines_;
  io::CsvWriter csv_;
  io::RowFile file_;
};

std::string tracer_used(const Model& model) {
  std::string name(rt::name(model.compiled().tracer()));
  if (model.compiled().tracer() == TracerKind::direct) name += " " + std::string(rt::direct_instruction_set());
  return name;
}

io::Manifest manifest_of(const Model& model) {
  std::vector<std::string> files = model.script().files;
  files.insert(files.end(), model.scene().files.begin(), model.scene().files.end());
  io::Manifest manifest;
  manifest.provenance = {.version = version(),
                         .git_revision = git_revision(),
                         .compiler = compiler(),
                         .embree = rt::embree_version() + " " + rt::instruction_set(),
                         .inputs = io::hashed(files),
                         .resolved_script = io::to_yaml(model.script()),
                         .seed = model.script().seed,
                         .study_runs = model.n_runs()};
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

std::unique_ptr<RowOutput> open_shard(const Model& model, const RowOptions& options) {
  const Shard shard = studies::parse_shard(options.shard);
  make_folder(options.output);
  refuse_other_shards(options.output, shard);
  io::Manifest manifest = manifest_of(model);
  manifest.shard = shard;
  manifest.runs = runs_of(shard, model.n_runs());
  return std::make_unique<ResumableRows>(options.output / (studies::shard_name(shard) + options.format),
                                         std::move(manifest), model.columns(), options.start);
}

}  // namespace

std::unique_ptr<RowOutput> open_rows(const Model& model, const RowOptions& options) {
  if (!options.shard.empty()) return open_shard(model, options);
  if (options.output.empty() || io::is_written_directly(options.output)) {
    return std::make_unique<StreamedRows>(model, options.output);
  }
  return std::make_unique<ResumableRows>(options.output, manifest_of(model), model.columns(), options.start);
}

}  // namespace pirsim::app
