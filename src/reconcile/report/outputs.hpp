// What a reconciliation leaves behind, as files; the formats are described in docs/formats/reconcile.md.
#pragma once

#include <array>
#include <string>

#include "pirsim/reconcile.hpp"

namespace pirsim::reconcile {

/// What write_report() replaces or removes in its folder.
inline constexpr std::array report_files{"where.csv", "candidates.csv", "script_patched.yaml", "report.html",
                                         "report.json"};

[[nodiscard]] std::string to_json(const Outcome& outcome, const Measured& measured, const Settings& settings,
                                  const Context& context, const Provenance& provenance);
[[nodiscard]] std::string where_csv(const Outcome& outcome);
[[nodiscard]] std::string candidates_csv(const Outcome& outcome);

}  // namespace pirsim::reconcile
