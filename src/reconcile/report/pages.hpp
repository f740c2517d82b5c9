// Results as pages for readers who know no statistics, and the files beside them (docs/formats/reconcile.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/report.hpp"
#include "pirsim/reconcile.hpp"
#include "reconcile/validation/plan.hpp"
#include "reconcile/validation/targets.hpp"

namespace pirsim::reconcile {

/// How a reader gets at the runs in which a cell was counted.
struct Watched {
  std::vector<std::string> model_options;  ///< words of a command: "--scene", "rooms/a.gltf", ...
  std::string phase;                       ///< in which seconds with motion are counted; empty: all the time
};

/// The verdict first; then where model and measurement differ, which effects were looked at and why each was kept or
/// dropped, how strong the named ones are, and whether held-out trials are predicted better with them.
[[nodiscard]] io::Report report_page(const Outcome& outcome, double alpha, const Watched& watched = {});

[[nodiscard]] io::Report plan_page(const PlanResult& result);
[[nodiscard]] std::string to_json(const PlanResult& result);
[[nodiscard]] std::string to_csv(const PlanResult& result);  ///< a row a design
/// plan.html, plan.json, plan.csv; the folder is made. Throws Error(io).
void write_plan(const std::filesystem::path& folder, const PlanResult& result, const std::string& made_by);

/// Targets first, then what is taken for what, power by effect, calibration and coverage.
[[nodiscard]] io::Report selftest_page(const SelftestResult& result, Geometry geometry);
[[nodiscard]] std::string to_markdown(const SelftestResult& result);
[[nodiscard]] std::string to_csv(const SelftestResult& result);  ///< a row a case
/// Targets, met or not, and the pairs that can't be told apart, as Markdown.
[[nodiscard]] std::string targets_markdown(const SelftestResult& result, Geometry geometry);
/// selftest.html, selftest.md (all rates and tables), targets.md and selftest.csv (a row a case); the folder is made.
/// Throws Error(io).
void write_selftest(const std::filesystem::path& folder, const SelftestResult& result, Geometry geometry,
                    const std::string& made_by);

}  // namespace pirsim::reconcile
