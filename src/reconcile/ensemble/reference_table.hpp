// What the model would have measured: many datasets of the plain model and of every effect in the catalogue.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "reconcile/ensemble/simulated_world.hpp"
#include "reconcile/data/statistics.hpp"
#include "stats/matrix.hpp"

namespace pirsim::reconcile {

struct TableSettings {
  std::uint32_t n_worlds = 1500;      ///< of the plain model, a dataset each
  std::uint32_t n_remembered = 1000;  ///< datasets of an effect that acts on remembered zones
  std::uint32_t n_traced = 400;       ///< datasets of an effect that needs new tracing
  unsigned threads = 0;               ///< 0: all cores; never changes the table
  std::vector<std::string> entries;   ///< names of effects; empty: the whole catalogue
  bool operator==(const TableSettings&) const = default;
};

/// Two fifths calibrate, and two tests are combined, so that p of an entry can't fall below 5 / (its number of
/// datasets): with fewer than these, which leave a tenth for worlds in which nobody can get about, nothing is ever
/// ruled out at the level.
[[nodiscard]] constexpr std::uint32_t fewest_datasets_to_refuse(double level) {
  return static_cast<std::uint32_t>(5.5 / level + 0.5);
}

/// One simulated dataset. The same world gives the same room and people for every entry.
struct TableRow {
  std::uint32_t entry = 0;  ///< 0: nothing; else 1 + index into ReferenceTable::effects
  std::uint32_t world = 0;
  std::vector<EffectSpec> effects;  ///< as drawn; none for nothing
};

class ReferenceTable {
 public:
  std::string key;                   ///< table_key() of what it depends on
  std::vector<std::string> effects;  ///< names of the entries from 1 on
  std::vector<TableRow> rows;        ///< by world, then entry
  stats::Matrix<float> statistics;   ///< (n_rows x n_statistics)
  Profile profile;                   ///< of the plain model, from pilot runs
  std::uint32_t n_worlds = 0;
  std::uint32_t n_left_out = 0;  ///< datasets in whose worlds people couldn't get about

  [[nodiscard]] std::size_t n_entries() const noexcept { return 1 + effects.size(); }
  [[nodiscard]] std::string entry_name(std::size_t entry) const { return entry == 0 ? "nothing" : effects[entry - 1]; }
};

/// Worlds are held back for calibration as wholes: nothing of them is seen in training.
[[nodiscard]] inline bool is_for_calibration(std::uint32_t world) noexcept { return world % 5 < 2; }

struct TableProgress {
  std::function<void(std::uint32_t done, std::uint32_t total)> worlds;  ///< may be empty
};

/// Simulates what isn't in the folder yet; chunks of worlds are kept there as they finish, so that an interrupted
/// table goes on where it stopped. An empty folder name keeps nothing. Throws Error(input) if the folder holds the
/// table of something else.
[[nodiscard]] ReferenceTable make_reference_table(const WorldSource& source, const StudyFrame& frame,
                                                  const DataShape& shape, const Profile& profile,
                                                  const TableSettings& settings, const std::filesystem::path& folder,
                                                  const TableProgress& progress = {});

/// Pilot runs of the plain model, for profiles and shapes, in worlds that no table has.
[[nodiscard]] std::vector<Series> pilot_runs(const WorldSource& source, const StudyFrame& frame, std::uint32_t n_worlds,
                                             unsigned threads);

/// Everything that a table's simulated datasets depend on, as a digest: scene, script, nuisance, runs of every trial,
/// settings, catalogue, build.
[[nodiscard]] std::string table_key(const WorldSource& source, const StudyFrame& frame, int n_replicates,
                                    const TableSettings& settings);

}  // namespace pirsim::reconcile
