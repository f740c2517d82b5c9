// Results in pictures, as pages for readers who know no statistics, and as the files beside them
// (docs/formats/reconcile.md).
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "pirsim/csv.hpp"
#include "pirsim/reconcile.hpp"
#include "reconcile/selftest/plan.hpp"
#include "reconcile/selftest/selftest.hpp"
#include "show/charts.hpp"
#include "show/report.hpp"

namespace pirsim::reconcile {

/// Trials by sensors: measured less expected seconds; cells that the global test flags are framed.
[[nodiscard]] io::GridChart difference_chart(const Location& location, double alpha);
/// Every number that the global test looked at, beside the band that it has to leave to be refused.
[[nodiscard]] io::BandChart envelope_chart(const Location& location, double alpha);
/// All hypotheses of the catalogue by probability; those kept stand out.
[[nodiscard]] io::BarChart ranking_chart(const Outcome& outcome);
/// One a parameter: twenty equally likely values within the range looked at.
[[nodiscard]] std::vector<io::DotsChart> posterior_charts(const FittedEffect& fitted,
                                                          const std::optional<RangeEnd>& end = {});

/// Hypotheses by hypotheses: how often the column's was the likeliest where the row's was hidden.
[[nodiscard]] io::GridChart confusion_chart(const SelftestResult& result);
/// How often an effect is seen, and is then in the set, against its strength.
[[nodiscard]] io::LineChart power_chart(const SelftestResult& result, const std::string& effect);

/// As CSV, a line an item.
template <typename Row, std::size_t n, typename Items>
[[nodiscard]] std::string table_of(const Column<Row> (&columns)[n], const Items& items) {
  std::ostringstream out;
  io::TableWriter<Row> csv(out, std::span<const Column<Row>>(columns));
  for (const auto& item : items) csv.write(Row(item));
  return out.str();
}

/// "95 % (75 % to 100 %, 19 of 20)".
[[nodiscard]] std::string with_interval(const Rate& rate);
/// A square with the share in percent; an empty one without any case.
[[nodiscard]] io::GridChart::Cell share_cell(const Rate& rate);
/// What was hidden (rows) against what it was taken for (columns). shares: (n_hypotheses x n_hypotheses) of each row; a
/// row of zeros has no case and stays empty.
[[nodiscard]] io::GridChart confusion_grid(const std::vector<std::string>& hypotheses,
                                           const std::vector<std::vector<double>>& shares, const std::string& title,
                                           const std::string& note);

/// How a reader gets at the runs in which a cell was counted.
struct Watched {
  std::vector<std::string> model_options;  ///< words of a command: "--scene", "rooms/a.gltf", ...
  std::string phase;                       ///< in which seconds with motion are counted; empty: all the time
  bool whole_trials = true;                ///< or parts of days, which have no page of their own
};

/// The verdict first; then where model and measurement differ, which effects were looked at and why each was kept or
/// dropped, how strong the named ones are, and whether held-out trials are predicted better with them.
[[nodiscard]] io::Report report_page(const Outcome& outcome, const Watched& watched = {});

[[nodiscard]] io::Report plan_page(const PlanResult& result);
[[nodiscard]] std::string to_json(const PlanResult& result);
/// plan.html, plan.json, plan.csv; the folder is made. Throws Error(io).
void write_plan(const std::filesystem::path& folder, const PlanResult& result, const std::string& made_by);

/// What is taken for what, power by effect, calibration and coverage.
[[nodiscard]] io::Report selftest_page(const SelftestResult& result);
[[nodiscard]] std::string to_markdown(const SelftestResult& result);
/// selftest.html, selftest.md (all rates and tables) and selftest.csv (a row a case); the folder is made.
/// Throws Error(io).
void write_selftest(const std::filesystem::path& folder, const SelftestResult& result, const std::string& made_by);

/// What write_report() and the reference table (table/, table_with_.../) write in its folder.
inline constexpr std::array report_files{
    "where.csv", "candidates.csv", "script_patched.yaml", "report.html", "report.json", "trail.log", "table*"};

[[nodiscard]] std::string to_json(const Outcome& outcome, const Measured& measured, const Settings& settings,
                                  const Context& context, const Provenance& provenance);

}  // namespace pirsim::reconcile
