// What a reconciliation leaves behind, as files; the formats are described in docs/formats/reconcile.md.
#pragma once

#include <filesystem>
#include <string>

#include "reconcile/inference/reconcile.hpp"

namespace pirsim::reconcile {

inline constexpr int report_schema = 1;

/// What made the results, for the report.
struct Provenance {
  std::string program, scene, script, measured;  ///< file names as given
};

[[nodiscard]] std::string to_json(const Outcome& outcome, const Measured& measured, const Settings& settings,
                                  const Provenance& provenance);
[[nodiscard]] std::string where_csv(const Outcome& outcome);
[[nodiscard]] std::string candidates_csv(const Outcome& outcome);
/// The script with the named effects added, which plain `pirsim` runs.
[[nodiscard]] ScriptSpec patched(const ScriptSpec& script, const Outcome& outcome);

/// report.json, report.html, where.csv, candidates.csv, script_patched.yaml (if an effect was named) and trail.log,
/// each complete or not at all; the folder is made. Throws Error(io).
void write_outputs(const std::filesystem::path& folder, const Outcome& outcome, const Measured& measured,
                   const ScriptSpec& script, const Settings& settings, const Provenance& provenance);

}  // namespace pirsim::reconcile
