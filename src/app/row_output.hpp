// Where a study's rows go: a stream, or a file that can be resumed.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "app/options.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/model.hpp"

namespace pirsim::app {

class RowOutput {
 public:
  virtual ~RowOutput() = default;
  [[nodiscard]] virtual RunRange missing_runs() const = 0;
  virtual void add_run(std::span<const Sample> rows) = 0;
  /// After the last run.
  virtual void commit() = 0;
  /// The work ends early for good: nothing is left behind.
  virtual void discard() noexcept = 0;
  [[nodiscard]] virtual std::uint64_t rows() const = 0;
};

/// Throws Error: usage (a shard without a folder, and the like), io, input (nothing that could be resumed).
[[nodiscard]] std::unique_ptr<RowOutput> open_rows(const Model& model, const RunOptions& options);

/// Thrown when nobody reads standard output any more, as in `pirsim ... | head`.
struct ClosedPipe {};
/// Throws ClosedPipe, or Error(io), if standard output fails.
void require_written();

}  // namespace pirsim::app
