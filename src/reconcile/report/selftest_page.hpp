// A self-test in pictures.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/report.hpp"
#include "reconcile/validation/selftest.hpp"
#include "reconcile/validation/targets.hpp"

namespace pirsim::reconcile {

/// Targets first, then what is taken for what, power by effect, calibration and coverage.
[[nodiscard]] io::Report selftest_page(const SelftestResult& result, Geometry geometry);

/// Hypotheses by hypotheses: how often the column's was the likeliest where the row's was hidden.
[[nodiscard]] io::GridChart confusion_chart(const SelftestResult& result);
/// How often an effect is seen, and is then in the set, against its strength.
[[nodiscard]] io::LineChart power_chart(const SelftestResult& result, const std::string& effect);
/// The same of all effects in one picture.
[[nodiscard]] io::GridChart power_grid(const SelftestResult& result);
/// How often the likeliest hypothesis was right, against the probability that it was given.
[[nodiscard]] io::LineChart reliability_chart(const SelftestResult& result);
/// Effect by effect: how often the 90 % intervals hold the truth.
[[nodiscard]] io::BarChart coverage_chart(const SelftestResult& result);

/// selftest.html, selftest.md (all rates and tables), targets.md and selftest.csv (a row a case); the folder is made.
/// Throws Error(io).
void write_selftest(const std::filesystem::path& folder, const SelftestResult& result, Geometry geometry,
                    const std::string& made_by);

}  // namespace pirsim::reconcile
