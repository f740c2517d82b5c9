// What the model would have measured: many datasets of the plain model and of every effect in the catalogue.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "files/disk/file.hpp"
#include "reconcile/data/statistics.hpp"
#include "reconcile/ensemble/realization.hpp"
#include "stats/matrix.hpp"

namespace pirsim::reconcile {

/// One simulated dataset. The same realization gives the same room and people for every hypothesis.
struct TableRow {
  std::uint32_t hypothesis = 0;  ///< 0: nothing; else 1 + index into ReferenceTable::effects
  std::uint32_t realization = 0;
  std::vector<EffectSpec> effects;  ///< as drawn; none for nothing
};

class ReferenceTable {
 public:
  std::string key;                   ///< table_key() of what it depends on
  std::vector<std::string> effects;  ///< names of the hypotheses from 1 on
  std::vector<TableRow> rows;        ///< by realization, then hypothesis
  stats::Matrix<float> statistics;   ///< (n_rows x n_statistics)
  Profile profile;                   ///< of the plain model, from pilot runs
  std::uint32_t n_left_out = 0;      ///< datasets in whose realizations people couldn't get about

  [[nodiscard]] std::size_t n_hypotheses() const noexcept { return 1 + effects.size(); }
  /// Their names.
  [[nodiscard]] std::vector<std::string> hypotheses() const {
    std::vector<std::string> names{"nothing"};
    names.insert(names.end(), effects.begin(), effects.end());
    return names;
  }
  [[nodiscard]] std::string hypothesis_name(std::size_t hypothesis) const {
    return hypothesis == 0 ? "nothing" : effects[hypothesis - 1];
  }
};

/// Realizations are held back for calibration as wholes: nothing of them is seen in training.
[[nodiscard]] inline bool is_for_calibration(std::uint32_t realization) noexcept { return realization % 5 < 2; }

/// Simulates what isn't in the folder yet; chunks of realizations are kept there as they finish, so that an interrupted
/// table goes on where it stopped. An empty folder name keeps nothing. Throws Error(input) if the folder holds the
/// table of something else.
[[nodiscard]] ReferenceTable make_reference_table(const RealizationSource& source, const StudyFrame& frame,
                                                  const DataShape& shape, const Profile& profile,
                                                  const TableSettings& settings, const std::filesystem::path& folder,
                                                  const Context& context = {});

/// Pilot runs of the plain model, for profiles and shapes, in realizations that no table has.
[[nodiscard]] std::vector<Series> pilot_runs(const RealizationSource& source, const StudyFrame& frame,
                                             std::uint32_t n_realizations, const Context& context = {});
/// Datasets of a table of what surrounds people, as a fan or a draught, and of the plain model.
[[nodiscard]] std::vector<std::vector<Series>> surroundings_pilot(const RealizationSource& source,
                                                                  const StudyFrame& frame, int n_replicates,
                                                                  std::uint32_t n_realizations,
                                                                  const Context& context = {});

/// Everything that a table's simulated datasets depend on, as a digest: scene, script, nuisance, runs of every trial,
/// settings, catalogue, build.
[[nodiscard]] std::string table_key(const RealizationSource& source, const StudyFrame& frame, int n_replicates,
                                    const TableSettings& settings);

// Simulated datasets on disk: a folder with chunks of finished realizations, each of which names its key and number,
// and a journal of them. Private to reconcile.

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

}  // namespace pirsim::reconcile
