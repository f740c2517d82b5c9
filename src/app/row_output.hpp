// Where a study's rows go: a stream, or a file that can be resumed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "io/manifest.hpp"
#include "pirsim/model.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::app {

struct RowOptions {
  std::filesystem::path output;  ///< .csv, .csv.gz or .csv.zst; of a shard its folder; empty: standard output
  std::string shard;             ///< "3/100", "auto"; empty: the whole study
  std::string format = ".csv";   ///< ending of a shard's file
  enum class Start { anew, resume } start = Start::anew;
};

class RowOutput {
 public:
  virtual ~RowOutput() = default;
  [[nodiscard]] virtual RunRange missing_runs() const = 0;
  virtual void add_run(std::span<const Sample> rows, const io::RunNotes& notes) = 0;
  /// Of all runs, also of those that were there before.
  [[nodiscard]] virtual const io::RunNotes& notes() const = 0;
  /// After the last run.
  virtual void commit() = 0;
  /// The work ends early for good: nothing is left behind.
  virtual void discard() noexcept = 0;
  [[nodiscard]] virtual std::uint64_t rows() const = 0;
};

/// Throws Error: usage (a shard without a folder, and the like), io, input (nothing that could be resumed).
[[nodiscard]] std::unique_ptr<RowOutput> open_rows(const Model& model, const RowOptions& options);

}  // namespace pirsim::app
