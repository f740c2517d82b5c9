// A folder of shards as one dataset: what is missing, and the whole of it as one file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/manifest.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::studies {

struct ShardReport {
  enum class State {
    done,        ///< data and manifest are there and agree with each other and with the other shards
    missing,     ///< nothing is there
    unfinished,  ///< begun; --resume goes on
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
