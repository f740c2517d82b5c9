// A study in shards: its parts, their state, and their rows joined.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/read/row_reader.hpp"
#include "files/write/row_file.hpp"
#include "files/write/summary.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::studies {

// Which part of a study a task of a job array computes, and what its file is called.

/// A variable's value, if it is set.
using Environment = std::function<std::optional<std::string>(const char* name)>;
[[nodiscard]] std::optional<std::string> process_environment(const char* name);

/// "3/100" is the third of a hundred. "auto/100" takes the task's number, 1 to 100, from the job array. "auto" takes
/// the number of shards from it too: it needs the whole array, of evenly spaced numbers, and so doesn't serve to submit
/// a part of an array again. Read are SLURM_ARRAY_TASK_{ID,MIN,STEP,COUNT}, SGE_TASK_{ID,FIRST,LAST,STEPSIZE}, and
/// PBS_ARRAY_INDEX or PBS_ARRAYID (number only). Throws Error(usage).
[[nodiscard]] Shard parse_shard(std::string_view text, const Environment& environment = process_environment);

/// "shard-0003-of-0100"
[[nodiscard]] std::string shard_name(const Shard& shard);
/// The shard that a file name begins with, if it does.
[[nodiscard]] std::optional<Shard> shard_of(std::string_view file_name);

// Sums of a study's rows from the bytes of its file, where there is no process that still has the runs.

/// Takes a row file (docs/formats/rows.md) piece by piece, from its header on, and counts each run into a Summary.
/// Needs memory for the counts alone.
class RowTally {
 public:
  /// trials: ids of the study, in order. measured: as Summary takes them.
  RowTally(std::vector<std::string> trials, SummarySpec spec, std::vector<MeasuredCell> measured);

  /// Throws Error(input) where the bytes aren't rows of this study.
  void add(std::string_view bytes);
  /// After the last piece. Throws Error(input) if there was no header, or the last line has no end.
  [[nodiscard]] const Summary& finish();

 private:
  void take_line(std::string_view line);
  void end_run();

  std::vector<std::string> trials_;
  SummarySpec spec_;
  std::vector<MeasuredCell> measured_;
  std::optional<io::RowFormat> format_;  ///< once the header is known, as the next two
  std::optional<Summary> summary_;
  std::optional<RunCounts> counts_;
  Sample row_;
  std::optional<int> replicate_;  ///< of the run whose rows come in; none before the first
  std::string trial_;
  std::string line_;  ///< so far
  bool is_quoted_ = false;
  int n_lines_ = 0;
};

struct ShardReport {
  enum class State {
    done,        ///< data and manifest are there and agree with each other and with the other shards
    missing,     ///< nothing is there
    unfinished,  ///< begun; --resume continues
    broken,      ///< see `why`
  };
  Shard shard;
  State state = State::missing;
  std::string why;
};

/// All shards of the folder, in order; reads every byte of the data, in bounded memory. Throws Error: io, input (no
/// shards, or shards of different counts).
[[nodiscard]] std::vector<ShardReport> campaign_status(const std::filesystem::path& folder);

/// Numbers of the shards that aren't done, as job arrays take them: "3,17-19". Empty if all are.
[[nodiscard]] std::string array_specification(const std::vector<ShardReport>& shards);
/// A line for each shard that isn't done, and one for the rest.
[[nodiscard]] std::string to_text(const std::vector<ShardReport>& shards);

/// Writes to `output` (.csv, .csv.gz or .csv.zst) and its manifest the very bytes that one process would have written.
/// Streams in bounded memory; the output appears only if every shard is there, once, made by one build from one spec,
/// and has the hash of its manifest. `sink` gets the same bytes on their way, before compression. Throws Error: io,
/// input (all that is wrong).
using Sink = std::function<void(std::string_view)>;
io::Manifest merge_campaign(const std::filesystem::path& folder, const std::filesystem::path& output,
                            const Sink& sink = {});
/// What all shards were made from: that of the first finished one. Throws Error: io, input.
[[nodiscard]] io::Provenance campaign_provenance(const std::filesystem::path& folder);

}  // namespace pirsim::studies
