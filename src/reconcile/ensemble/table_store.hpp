// Simulated datasets on disk: a folder with chunks of finished realizations, each of which names its key and number,
// and a journal of them. Private to reconcile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/files/journal.hpp"
#include "reconcile/ensemble/reference_table.hpp"

namespace pirsim::reconcile {

/// The runs of one dataset as they were simulated: statistics are taken when they are needed, so that data with other
/// gaps, and other statistics, need no new simulation.
struct SimulatedDataset {
  TableRow row;
  std::vector<Series> runs;
};
/// Datasets of some realizations that follow each other.
struct TableChunk {
  std::vector<SimulatedDataset> datasets;
  std::uint32_t n_left_out = 0;
};

class TableStore {
 public:
  /// `key`: what the datasets depend on. An empty folder name keeps nothing. Throws Error(input) if the folder holds a
  /// table with another key.
  TableStore(std::filesystem::path folder, const std::string& key);
  /// None if the chunk isn't there. Throws Error(input) if it is damaged, of another table or of other realizations.
  [[nodiscard]] std::optional<TableChunk> find(std::uint32_t number) const;
  /// Before work that is to be kept; afterwards what another process kept meanwhile is found too. Throws Error(io) if
  /// the folder can't be written or another process is at work on it, which two may read.
  void claim();
  void keep(std::uint32_t number, const TableChunk& chunk);

 private:
  [[nodiscard]] std::filesystem::path file(std::uint32_t number) const;
  [[nodiscard]] std::filesystem::path journal_path() const;
  void take(const std::optional<io::Journal::Content>& journal);

  std::filesystem::path folder_;
  std::string key_;
  std::set<std::string> there_;         ///< names of chunks
  std::optional<io::Journal> journal_;  ///< once it is claimed
};

/// Simulates item `index` (a realization) with all of its datasets.
using ItemJob = std::function<TableChunk(std::uint32_t index)>;
/// Calls use(chunk) for the datasets of items 0 to n_items - 1, in order: those that aren't in the store are simulated,
/// on several threads, and kept there; the context is told how many are done.
void for_each_chunk(TableStore& store, std::uint32_t n_items, const Context& context, const ItemJob& job,
                    const std::function<void(TableChunk&)>& use);

/// A row a dataset.
void append_statistics(const StudyFrame& frame, const DataShape& shape, const Profile& profile, const TableChunk& chunk,
                       unsigned threads, stats::Matrix<float>& statistics);

}  // namespace pirsim::reconcile
