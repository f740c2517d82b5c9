// Faults and how they are told. The library throws one exception type, never prints, never exits.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pirsim {

/// What went wrong, as the process exit code that the command line returns for it (docs/formats/inputs.md).
enum class ErrorCode : int {
  usage = 2,       ///< the command line or an argument of a library call is wrong
  input = 3,       ///< a file was read but its content is refused
  io = 4,          ///< a file can't be read or written
  infeasible = 5,  ///< the inputs are valid but the run they ask for can't be done (a seat that can't be reached)
  incomplete = 6,  ///< some runs of the study could not go on; the rows of all others are there
  internal = 70,   ///< a fault of pirsim itself, or memory ran out
  stopped = 75,    ///< a signal or a time limit ended the work early, at the end of a run (sysexits.h: EX_TEMPFAIL)
};

/// A place in an input file; line and column count from 1, 0 means unknown.
struct Where {
  std::string file;
  int line = 0;
  int column = 0;
  bool operator==(const Where&) const = default;
};

enum class Severity { warning, error };

/// One fault or remark, printed as `file:line:column: error: message`.
struct Issue {
  Severity severity = Severity::error;
  Where where;
  std::string message;
};

/// LLVM-style single line, without a trailing newline; unknown parts of the place are left out.
[[nodiscard]] std::string to_string(const Issue& issue);

/// The only exception that leaves pirsim. `what()` is all issues, one a line.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, std::vector<Issue> issues);
  Error(ErrorCode code, Where where, std::string message);
  Error(ErrorCode code, std::string message);
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] const std::vector<Issue>& issues() const noexcept { return issues_; }

 private:
  ErrorCode code_;
  std::vector<Issue> issues_;
};

/// Collects everything that is wrong with one input, so that a user sees all faults at once.
class Diagnostics {
 public:
  void error(Where where, std::string message);
  void warning(Where where, std::string message);
  /// Throws Error(code) with all issues if any of them is an error.
  void throw_if_errors(ErrorCode code = ErrorCode::input) const;
  [[nodiscard]] bool has_errors() const noexcept;
  [[nodiscard]] const std::vector<Issue>& issues() const noexcept { return issues_; }
  [[nodiscard]] std::vector<Issue> warnings() const;

 private:
  std::vector<Issue> issues_;
};

/// ` (did you mean 'X'?)` for the only candidate that goes on after `name` with an underscore (`yaw`: `yaw_deg`), else
/// for the nearest in edit distance (ties: first in order); an empty string if none is near enough to be meant.
[[nodiscard]] std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace pirsim
