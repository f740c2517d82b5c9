// A small self-test whose rates are asserted, and what breaks them: three seats, a minute of work each, six effects.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "reconcile/report/sentences.hpp"
#include "reconcile/selftest/selftest.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

ScriptSpec short_study() { return test::short_study({"S1", "S4", "S8"}, 60.0); }

SelftestSettings small() {
  SelftestSettings settings;
  settings.analysis.table = {
      500,
      500,
      500,
      {"false_triggers", "missed_triggers", "pulse_stretching", "dead_time", "clock_lag", "dead_sensor"}};
  settings.analysis.trees = 100;
  settings.n_nulls = 200;
  settings.n_injected = 10;
  settings.leave_out = LeaveOut::effects;
  return settings;
}

const ReferenceStudy& reference_study() {
  static const ReferenceStudy reference = make_full_study(test::shipped_scene("meeting_room.gltf"), short_study(),
                                                          small().analysis, Measured::Kind::series, 1);
  return reference;
}

const std::vector<InjectedDataset>& injected() {
  static const std::vector<InjectedDataset> all = inject(reference_study(), small());
  return all;
}

Rate rate(const SelftestResult& result, const std::string& what) {
  const std::vector<Rate> rates = rates_of(result);
  const auto found = std::ranges::find(rates, what, &Rate::what);
  REQUIRE(found != rates.end());
  REQUIRE(found->of > 0);
  return *found;
}

/// Three standard errors of a share of so many cases.
double tolerance(double share, const Rate& rate) {
  return 3.0 * std::sqrt(share * (1.0 - share) / static_cast<double>(rate.of));
}

/// A share's tolerance if it is judged by quantiles of calibration datasets, drawn once for all cases: of each effect
/// 60 or more, so that the shares of so many datasets scatter too. Ref: [Vovk2013]
double tolerance_when_calibrated(double share, const Rate& rate) {
  const double n_calibration = 60.0 * static_cast<double>(reference_study().table.effects.size());
  return std::hypot(tolerance(share, rate), 3.0 * std::sqrt(share * (1.0 - share) / n_calibration));
}

ReferenceStudy changed(const std::function<void(ReferenceTable&)>& change) {
  ReferenceStudy reference = reference_study();
  change(reference.table);
  return reference;
}

ReferenceStudy study_of(const Settings& analysis) {
  return make_full_study(test::shipped_scene("meeting_room.gltf"), test::short_study({"S4"}, 60.0), analysis,
                         Measured::Kind::series, 1);
}

}  // namespace

// One case: its sections share the reference study and the injected datasets.
TEST_CASE("a small self-test keeps its promises and what must break it does", "[reconcile][selftest][minutes]") {
  SECTION("a small self-test keeps its promises") {
    const SelftestResult result = judge(reference_study(), injected(), small());
    const auto at_most = [&](const std::string& what, double share) {
      const Rate found = rate(result, what);
      CAPTURE(what, found.hits, found.of);
      CHECK(found.value() <= share + tolerance(share, found));
    };
    const auto at_least = [&](const std::string& what, double share) {
      const Rate found = rate(result, what);
      CAPTURE(what, found.hits, found.of);
      CHECK(found.value() >= share - tolerance(share, found));
    };
    at_most("a disagreement although nothing is hidden", 0.05);
    at_most("a name although nothing is hidden", 0.01);
    at_most("one wrong name", 0.01);
    at_most("one wrong family", 0.01);
    for (const InjectedCase& c : result.cases) {
      if (c.verdict != Verdict::named) continue;
      CHECK(c.named.size() == 1);  // those that can't be ruled out beside it aren't named
      CHECK(c.family == effects::find(c.named.front()).info.family);
    }
    const Rate in_set = rate(result, "the truth in the set, given a disagreement");
    CAPTURE(in_set.hits, in_set.of);
    CHECK(in_set.value() >= 0.95 - tolerance_when_calibrated(0.95, in_set));
    at_least("the right name, given a name", 0.98);
    at_least("parameters within their 90 % intervals", 0.90);
    // Not promised, but a workflow that never finds anything would keep all of the above.
    at_least("a disagreement seen", 0.6);
    at_least("exactly the right name, given a disagreement", 0.5);
  }
  SECTION("calibration on datasets that the classifier was trained on breaks the self-test") {
    const ReferenceStudy leaking = changed([](ReferenceTable& table) {
      // Every calibration row becomes a copy of a training row of the same hypothesis.
      for (std::size_t hypothesis = 0; hypothesis < table.n_hypotheses(); ++hypothesis) {
        std::vector<std::size_t> training, calibration;
        for (std::size_t i = 0; i < table.rows.size(); ++i) {
          if (table.rows[i].hypothesis != hypothesis) continue;
          (is_for_calibration(table.rows[i].realization) ? calibration : training).push_back(i);
        }
        for (std::size_t i = 0; i < calibration.size(); ++i) {
          std::ranges::copy(std::as_const(table.statistics).row(training[i]),
                            table.statistics.row(calibration[i]).begin());
        }
      }
    });
    SelftestSettings settings = small();
    settings.leave_out = LeaveOut::none;
    const Rate in_set = rate(judge(leaking, injected(), settings), "the truth in the set, given a disagreement");
    CAPTURE(in_set.hits, in_set.of);
    CHECK(in_set.value() < 0.95 - tolerance_when_calibrated(0.95, in_set));
  }
  SECTION("shuffled labels break the self-test") {
    const ReferenceStudy shuffled = changed([](ReferenceTable& table) {
      // Each effect's datasets are dealt to all effects, whatever made them.
      Stream stream({3, 0, 0, Purpose::test});
      std::vector<std::size_t> rows;
      for (std::size_t i = 0; i < table.rows.size(); ++i) {
        if (table.rows[i].hypothesis > 0) rows.push_back(i);
      }
      for (std::size_t i = rows.size(); i > 1; --i) {
        const std::size_t other = stream.index(static_cast<std::uint32_t>(i));
        std::ranges::swap_ranges(table.statistics.row(rows[i - 1]), table.statistics.row(rows[other]));
      }
    });
    SelftestSettings settings = small();
    settings.leave_out = LeaveOut::none;
    const Rate exact = rate(judge(shuffled, injected(), settings), "exactly the right name, given a disagreement");
    CHECK(exact.value() < 0.2);
  }
}

TEST_CASE("datasets that were injected are kept beside those of other numbers", "[reconcile][selftest]") {
  const TemporaryFolder folder;
  SelftestSettings settings;
  settings.analysis.table = {20, 20, 20, {"false_triggers"}};
  settings.n_nulls = 2;
  settings.n_injected = 0;
  settings.injected_folder = folder.path() / "injected";
  const ReferenceStudy reference = study_of(settings.analysis);
  const auto inject_so_many = [&](std::uint32_t n) {
    settings.n_nulls = n;
    return inject(reference, settings);
  };
  const auto changed_last = [&] {
    std::filesystem::file_time_type last{};
    for (const auto& hypothesis : std::filesystem::recursive_directory_iterator(folder.path()))
      last = std::max(last, hypothesis.last_write_time());
    return last;
  };
  CHECK(inject_so_many(2).size() == 2);
  CHECK(inject_so_many(3).size() == 3);
  const auto before = changed_last();
  CHECK(inject_so_many(2).size() == 2);
  CHECK(changed_last() == before);  // nothing was simulated again
}
