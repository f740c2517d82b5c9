// What a study writes: rows as runs end, and what needs all runs at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/study_run.hpp"
#include "io/write/manifest.hpp"
#include "pirsim/model.hpp"
#include "pirsim/study.hpp"

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

}  // namespace pirsim::app
