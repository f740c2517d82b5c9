// Outputs that may get larger than anybody expects: what is said before they are made.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/options.hpp"
#include "files/write/row_file.hpp"
#include "pirsim/model.hpp"

namespace pirsim::app {

// Limits, assumed; docs/formats/inputs.md tells them.
inline constexpr double film_bytes = 200e6;  ///< unless a user asks for more; what viewers and browsers open in seconds
inline constexpr double run_bytes = 4e9;     ///< in memory, of what is recorded at every tick of a run

/// Does a user want what is written however large it gets?
enum class Size { usual, any };

/// --large
void offer_size(CLI::App& command, Size& size);

/// A film of one run, as glTF or in a page.
struct FilmSize {
  std::string what;  ///< "the film"
  std::size_t n_people = 0;
  double keys_per_s = 10.0;
  double bytes_a_byte = 1.0;  ///< of the file, of the animation
};
/// Throws Error(usage) for more than a film may usually have (docs/formats/inputs.md).
void require_usual(const FilmSize& film, double seconds, Size size);

/// "1.2 GB", "340 MB"
[[nodiscard]] std::string bytes_in_words(double bytes);

// Running a study with all that it can write: what `run` and the commands that make a study of their own share.

/// Where rows go: a stream, or a file that can be resumed.
struct RowOptions {
  std::filesystem::path output;  ///< .csv, .csv.gz or .csv.zst; of a shard its folder; empty: standard output
  std::string shard;             ///< "3/100", "auto"; empty: the whole study
  std::string format = ".csv";   ///< ending of a shard's file
  enum class Start { anew, resume } start = Start::anew;
};

struct RunOptions {
  RowOptions rows;
  std::filesystem::path summary;    ///< .csv or .md
  std::filesystem::path zones;      ///< .csv, .csv.gz or .csv.zst
  std::filesystem::path trace;      ///< the same
  std::filesystem::path occupants;  ///< as zones
  std::filesystem::path casas;      ///< text, compressed as zones are
  std::filesystem::path report;     ///< .html
  std::filesystem::path frames;     ///< folder
  std::optional<double> frame_s;    ///< a moment of the run whose frame is written as CSV, too
  std::optional<double> max_time_s;
  unsigned threads = 0;
  enum class Faults { note, stop } faults = Faults::note;  ///< of single runs
};

/// Where rows and all else go, and how much of the study is run.
void offer_run_options(CLI::App& command, const std::shared_ptr<RunOptions>& options);
/// Throws Error(usage) for options that don't go together; before any work.
void check_options(const RunOptions& options);
/// What rows don't say, as warnings. Throws Error(incomplete) if runs failed: the last thing to do.
void tell(const io::RunNotes& notes, Verbosity verbosity);
/// Runs what is asked for and writes it.
void run(const Model& model, const Inputs& inputs, const RunOptions& options);

}  // namespace pirsim::app
