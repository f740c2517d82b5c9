// What the model would have measured: many datasets of the plain model and of every effect in the catalogue.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "reconcile/data/statistics.hpp"
#include "reconcile/ensemble/simulated_realization.hpp"
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
  std::uint32_t n_realizations = 0;
  std::uint32_t n_left_out = 0;  ///< datasets in whose realizations people couldn't get about

  [[nodiscard]] std::size_t n_hypotheses() const noexcept { return 1 + effects.size(); }
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

/// Everything that a table's simulated datasets depend on, as a digest: scene, script, nuisance, runs of every trial,
/// settings, catalogue, build.
[[nodiscard]] std::string table_key(const RealizationSource& source, const StudyFrame& frame, int n_replicates,
                                    const TableSettings& settings);

}  // namespace pirsim::reconcile
