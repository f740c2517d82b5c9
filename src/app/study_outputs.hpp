// What a study writes: rows as runs end, and what needs all runs at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "app/study_run.hpp"
#include "io/manifest.hpp"
#include "pirsim/model.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/study.hpp"

namespace pirsim::app {

class RowOutput {
 public:
  virtual ~RowOutput() = default;
  [[nodiscard]] virtual RunRange missing_runs() const = 0;
  virtual void add_run(std::span<const Sample> rows, const io::RunNotes& notes) = 0;
  /// Of all runs, also of those that were there before.
  [[nodiscard]] virtual const io::RunNotes& notes() const = 0;
  /// After the last run. To compress much takes long: goes_on is asked meanwhile, and if it says no, Error(stopped) is
  /// thrown and nothing is lost.
  virtual void commit(const std::function<bool()>& goes_on) = 0;
  /// The study ends early and won't be resumed: removes what was written.
  virtual void discard() noexcept = 0;
  [[nodiscard]] virtual std::uint64_t rows() const = 0;
};

/// Throws Error: usage (a shard without a folder, and the like), io, input (nothing that could be resumed).
[[nodiscard]] std::unique_ptr<RowOutput> open_rows(const Model& model, const RowOptions& options);

[[nodiscard]] bool has_whole_study_outputs(const RunOptions& options);

/// Nothing of them is left if the study ends early.
class WholeStudyOutputs {
 public:
  /// Throws Error: usage for what the study hasn't got (before anything is opened), io.
  WholeStudyOutputs(const Model& model, const Inputs& inputs, const RunOptions& options);
  ~WholeStudyOutputs();
  void add(const RunResult& result);
  void commit(const io::RunNotes& notes);
  /// What they need of every run.
  [[nodiscard]] Occupants occupants() const noexcept;

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace pirsim::app
