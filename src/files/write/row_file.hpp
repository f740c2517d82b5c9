// The side-car of a data file: what made it, which part of the study it holds, and the hash by which it is known
// (docs/formats/rows.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/core/random.hpp"
#include "pirsim/input_file.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::io {

struct HashedFile {
  std::string name;  ///< without its folder
  std::string sha256;
  bool operator==(const HashedFile&) const = default;
};

/// All that decides the bytes of a study's rows. Equal provenance and equal runs: equal rows.
struct Provenance {
  std::string version;
  std::string git_revision;
  std::string compiler;
  std::string embree;              ///< version and instruction set
  std::vector<HashedFile> inputs;  ///< script, scene, and the files that they name, in the order they were read
  std::string resolved_script;     ///< YAML, after overrides
  std::uint64_t seed = 0;
  std::uint32_t study_runs = 0;  ///< of the whole study
  /// Sensors in order, and how each answers: "zones", "analog" or "analog, drawn: 1.27" (times as sensitive as rated).
  /// Follows from the inputs, and is told for a reader.
  std::vector<std::pair<std::string, std::string>> responses{};
};

struct FailedRun {
  std::uint32_t run = 0;
  std::string trial;
  int replicate = 0;
  double time_s = 0.0;
  std::string time;     ///< as rows tell it; empty without a clock
  std::string message;  ///< says which person, where, doing what
};

/// What happened in runs that their rows don't tell.
struct RunNotes {
  std::uint64_t passes_through = 0;  ///< of people who found no way round others
  std::string first_pass;            ///< trial, replicate, second, person and place; empty if there is none
  std::uint64_t seats_changed = 0;
  std::uint64_t seats_missed = 0;
  std::uint64_t waits_outside = 0;  ///< for a seat that was taken
  std::string first_wait;           ///< trial, replicate, person and second; empty if there is none
  std::vector<FailedRun> failed;    ///< without rows
  RunNotes& operator+=(const RunNotes& other);
  [[nodiscard]] bool empty() const noexcept;
  /// What a reader of sums needs to know of them, in sentences; empty if nothing happened.
  [[nodiscard]] std::string remarks() const;
};

struct Manifest {
  Provenance provenance;
  std::string tracer;  ///< changes no bit of the rows
  std::string table;   ///< "occupants"; empty: the rows
  std::optional<Shard> shard;
  RunRange runs;
  std::uint64_t rows = 0;
  std::uint64_t bytes = 0;  ///< of the rows with their header, before compression
  std::string sha256;       ///< of these bytes
  RunNotes notes;
};

/// What differs, in words: "git revision (1a2b3c, not 4d5e6f)". Empty if nothing does.
[[nodiscard]] std::vector<std::string> differences(const Provenance& one, const Provenance& other);
/// As manifests name them.
[[nodiscard]] std::vector<HashedFile> named(const std::vector<InputFile>& files);

[[nodiscard]] std::string to_json(const Manifest& manifest, int indent);
/// In one line, and back; std::nullopt for what was damaged.
[[nodiscard]] std::string to_json(const RunNotes& notes);
[[nodiscard]] std::optional<RunNotes> notes_from_json(const std::string& text);
/// Throws Error(input); `name` stands in messages.
[[nodiscard]] Manifest manifest_from_json(const std::string& text, const std::string& name);

/// `<data file>.json`
[[nodiscard]] std::filesystem::path manifest_path(const std::filesystem::path& data_file);
/// Written last, so that a data file with a manifest is complete. Throws Error(io).
void write_manifest(const std::filesystem::path& file, const Manifest& manifest);
/// Throws Error: io, input.
[[nodiscard]] Manifest read_manifest(const std::filesystem::path& file);

// A file of rows that survives whatever ends the process: it can be resumed after the last complete run.

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
