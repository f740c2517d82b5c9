// A file of rows that survives whatever ends the process: it can be resumed after the last complete run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/digest.hpp"
#include "io/write/manifest.hpp"

namespace pirsim::io {

/// While runs come in, the rows stand in `<file>.partial`, without compression, and `<file>.journal` says after each
/// run how far they reach and what their hash is (both without .gz or .zst). commit() puts the file in its place and
/// then writes its manifest; until then every way to die leaves a state that RowFile::Start::resume goes on from.
/// One process at a time works on a file; a second one is refused.
class RowFile {
 public:
  enum class Start { anew, resume };

  /// `made`: what the manifest will say, without rows, bytes and hash. `header`: the line of column names. To resume
  /// is refused by Error(input) if the file, finished or not, was made from anything else. Throws Error(io).
  RowFile(std::filesystem::path file, Manifest made, const std::string& header, Start start);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// True if file and manifest are there, fit, and the hash is right: nothing is left to do.
  [[nodiscard]] bool finished() const noexcept;
  [[nodiscard]] std::uint32_t next_run() const noexcept;  ///< the first whose rows are missing
  [[nodiscard]] std::uint64_t rows() const noexcept;
  /// Of the run next_run(), whole lines.
  void add_run(std::string_view lines, std::uint64_t n_rows, const RunNotes& notes = {});
  /// Of all runs that are in the file.
  [[nodiscard]] const RunNotes& notes() const noexcept;
  /// After the last run. Asks goes_on, if given, while it compresses; after a no it throws Error(stopped), and to
  /// resume puts the file in its place.
  void commit(const std::function<bool()>& goes_on = {});
  /// Removes what was written: there is no sense in going on.
  void discard() noexcept;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// What a RowFile writes beside the file: its manifest, and the two that are there while runs come in.
[[nodiscard]] std::vector<std::filesystem::path> files_beside(const std::filesystem::path& file);

/// Compares rows, which come in pieces with their header, with what a manifest says of them.
class DataCheck {
 public:
  explicit DataCheck(const Manifest& manifest) : manifest_(manifest) {}
  void add(std::string_view bytes);
  [[nodiscard]] bool is_too_long() const noexcept { return bytes_ > manifest_.bytes; }
  [[nodiscard]] std::string fault() const;  ///< of all that came; empty: none

 private:
  const Manifest& manifest_;
  Sha256 hash_;
  std::uint64_t bytes_ = 0, lines_ = 0;
  bool is_quoted_ = false;
};

/// Whether the data file is what its manifest says; if not, why. Reads it all, in bounded memory.
[[nodiscard]] std::string fault_of_data(const std::filesystem::path& file, const Manifest& manifest);

}  // namespace pirsim::io
