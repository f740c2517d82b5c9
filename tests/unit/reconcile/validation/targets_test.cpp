// Targets and pictures of a self-test, from cases made by hand.
#include "reconcile/validation/targets.hpp"

#include <algorithm>

#include "io/pages/report.hpp"
#include "reconcile/report/pages.hpp"
#include "reconcile/report/sentences.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

InjectedCase injected_case(const std::string& truth, const std::string& taken_for, Verdict verdict) {
  InjectedCase c;
  c.kind = truth == "nothing" ? CaseKind::nothing : CaseKind::one;
  c.truth = truth;
  c.strength = truth == "nothing" ? Strength::none : Strength::strong;
  c.verdict = verdict;
  c.likeliest = taken_for;
  if (verdict == Verdict::named) c.named = {taken_for};
  if (verdict == Verdict::one_of) c.named = {"fidgeting", "soft_zone_edges"};
  return c;
}

SelftestResult result_of(std::size_t nulls, std::size_t alarms) {
  SelftestResult result;
  result.hypotheses = {"nothing", "soft_zone_edges", "fidgeting", "sensor_yaw"};
  for (std::size_t i = 0; i < nulls; ++i) {
    result.cases.push_back(
        injected_case("nothing", "nothing", i < alarms ? Verdict::one_of : Verdict::no_disagreement));
  }
  return result;
}

Reached alarm_rate(std::size_t nulls, std::size_t alarms) {
  const auto all = compare_with_targets(result_of(nulls, alarms), Geometry::uncertain);
  return std::ranges::find(all, Counted::alarm_on_nothing, [](const TargetResult& one) { return one.target.rate; })
      ->reached;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

}  // namespace

TEST_CASE("a target is met only if the whole interval is within its bounds", "[selftest]") {
  // Exact 95 % intervals (from the binomial's tails): 15 of 600 0.0141-0.0409, 27 of 600 0.0299-0.0648, 36 of 600
  // 0.0424-0.0821, 60 of 600 0.0772-0.1268; the target is at most 0.05.
  CHECK(alarm_rate(600, 15) == Reached::yes);
  CHECK(alarm_rate(600, 27) == Reached::probably);
  CHECK(alarm_rate(600, 36) == Reached::hardly);
  CHECK(alarm_rate(600, 60) == Reached::no);
  CHECK(alarm_rate(0, 0) == Reached::not_tested);
}

TEST_CASE("every target but those of known geometry has a rate that a full self-test counts", "[selftest]") {
  SelftestResult result = result_of(1, 0);
  for (const CaseKind kind : {CaseKind::one, CaseKind::left_out, CaseKind::out_of_catalogue}) {
    InjectedCase c = injected_case("sensor_yaw", "sensor_yaw", Verdict::named);
    c.kind = kind;
    c.n_parameters = c.n_covered = 1;
    c.verification.emplace().before.energy_score = 1.0;  // there is something to close
    c.injected = 1;                                      // the first of them
    result.cases.push_back(c);
  }
  const std::size_t first = result.cases.size();
  for (const CaseKind kind : {CaseKind::one, CaseKind::left_out_variant}) {
    result.cases.push_back(injected_case("fidgeting", "fidgeting", Verdict::named));
    result.cases.back().kind = kind;
    result.cases.back().injected = first;
  }
  for (const TargetResult& one : compare_with_targets(result, Geometry::uncertain)) {
    INFO(in_words(one.target.rate));
    CHECK(one.rate.of > 0);
  }
}

TEST_CASE("what had no case is neither met nor a number", "[selftest]") {
  const SelftestResult result = result_of(0, 0);
  const std::string compared = targets_markdown(result, Geometry::uncertain), text = to_markdown(result);
  CHECK(count(compared, "| calibration error of the probabilities | at most 0.05 | | | not tested |") == 1);
  CHECK(count(text, "| calibration error of the probabilities | no case |") == 1);
  CHECK(count(text, "| sensor_yaw | no case | no case | no case | no case | no case | no case |") == 1);
  CHECK(count(to_html(selftest_page(result, Geometry::uncertain)), "probability and share: no case") == 1);
}

TEST_CASE("gaps that are closed are counted where the right name was applied and claims where nothing is hidden",
          "[selftest]") {
  SelftestResult result = result_of(10, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    result.cases[i].verification.emplace();
    result.cases[i].verification->shrunk = i == 0;
  }
  for (const double share : {0.95, 0.5, 0.92, 0.91}) {
    result.cases.push_back(injected_case("sensor_yaw", "sensor_yaw", Verdict::named));
    result.cases.back().verification.emplace();
    result.cases.back().verification->before.energy_score = 1.0;
    result.cases.back().verification->share_closed = share;
    result.cases.back().verification->shrunk = true;
    result.cases.back().verification->closed = share > 0.6;
  }
  result.cases.push_back(injected_case("sensor_yaw", "sensor_yaw", Verdict::named));  // not among those tried
  result.cases.push_back(injected_case("sensor_yaw", "sensor_yaw", Verdict::named));
  result.cases.back().verification.emplace().n_trials = 3;  // shrunk by nothing: there was nothing to close
  const std::vector<Rate> rates = rates_of(result);
  const auto rate = [&](const std::string& what) {
    const auto found = std::ranges::find(rates, what, [](const Rate& one) { return in_words(one.what); });
    REQUIRE(found != rates.end());
    return std::pair(found->hits, found->of);
  };
  CHECK(rate("a gap that shrunk although nothing is hidden") == std::pair<std::size_t, std::size_t>(1, 10));
  CHECK(rate("a gap that shrunk on held-out trials, given the right name") ==
        std::pair<std::size_t, std::size_t>(4, 5));
  CHECK(rate("a gap closed on held-out trials, given the right name") == std::pair<std::size_t, std::size_t>(3, 5));
  CHECK(rate("nine tenths of what can be closed, given the right name") == std::pair<std::size_t, std::size_t>(3, 4));
}

TEST_CASE("names that were applied are counted by whose they are", "[selftest]") {
  SelftestResult result = result_of(1, 0);
  const auto add = [&](CaseKind kind, double p) {
    result.cases.push_back(injected_case("sensor_yaw", "sensor_yaw", Verdict::named));
    result.cases.back().kind = kind;
    result.cases.back().applied = Look{{"sensor_yaw"}, 0.025, p, {}};
  };
  for (const double p : {0.3, 0.03, 0.02}) add(CaseKind::one, p);
  for (const double p : {0.026, 0.025, 0.001, 0.002}) add(CaseKind::left_out, p);
  result.cases.push_back(injected_case("sensor_yaw", "sensor_yaw", Verdict::named));  // not among those tried
  const std::vector<Rate> rates = rates_of(result);
  const auto rate = [&](const std::string& what) {
    return std::ranges::find(rates, what, [](const Rate& one) { return in_words(one.what); });
  };
  const auto right = rate("applied, the right name: the model passes");
  const auto neighbour = rate("applied, the name of an effect that the catalogue lacks: the model passes");
  REQUIRE((right != rates.end() && neighbour != rates.end()));
  CHECK((right->hits == 2 && right->of == 3));
  CHECK((neighbour->hits == 1 && neighbour->of == 4));
  CHECK(rate("applied, the name of an out-of-catalogue fault: the model passes") == rates.end());
}

TEST_CASE("what the catalogue is made to lack is counted by what it is called", "[selftest]") {
  SelftestResult result = result_of(1, 0);
  const auto add = [&](CaseKind kind, Verdict verdict, const std::string& named, effects::Family family) {
    result.cases.push_back(injected_case("fidgeting", named, verdict));
    result.cases.back().kind = kind;
    result.cases.back().family = family;
  };
  using effects::Family;
  add(CaseKind::left_out, Verdict::none_in_catalogue, "", Family::data);
  result.cases.back().family.reset();
  add(CaseKind::left_out, Verdict::named, "trunk_sway", Family::motion);
  add(CaseKind::left_out, Verdict::named, "soft_zone_edges", Family::optics);
  add(CaseKind::left_out, Verdict::no_disagreement, "", Family::data);
  const std::size_t first = result.cases.size();
  add(CaseKind::one, Verdict::named, "fidgeting", Family::motion);
  add(CaseKind::one, Verdict::named, "sensor_yaw", Family::mounting);
  add(CaseKind::left_out_variant, Verdict::named, "fidgeting", Family::motion);
  result.cases.back().injected = first;
  add(CaseKind::left_out_variant, Verdict::one_of, "", Family::motion);
  result.cases.back().injected = first;
  add(CaseKind::left_out_variant, Verdict::named, "fidgeting", Family::motion);  // whom the whole catalogue misnames
  result.cases.back().injected = first + 1;
  result.cases[1].injected = first;  // of those left out two are told by the whole catalogue, one of them called none
  result.cases[2].injected = first;
  result.cases[3].injected = first + 1;
  const std::vector<Rate> rates = rates_of(result);
  const auto rate = [&](Counted what) {
    const auto found = std::ranges::find(rates, what, &Rate::what);
    REQUIRE(found != rates.end());
    return std::pair(found->hits, found->of);
  };
  using Share = std::pair<std::size_t, std::size_t>;
  CHECK(rate(Counted::left_out_seen) == Share(3, 4));
  CHECK(rate(Counted::left_out_none) == Share(1, 3));
  CHECK(rate(Counted::told_left_out_none) == Share(1, 2));
  CHECK(rate(Counted::left_out_named) == Share(2, 4));
  CHECK(rate(Counted::left_out_named_outside) == Share(1, 4));
  CHECK(rate(Counted::variant_named) == Share(1, 2));
  CHECK(rate(Counted::motion_as_sensor) == Share(1, 6));
}

TEST_CASE("a family counts as said if the named effect is of it or its effects are sure together", "[selftest]") {
  SelftestResult result = result_of(1, 0);
  for (const auto family : {effects::Family::mounting, effects::Family::optics}) {
    result.cases.push_back(injected_case("sensor_yaw", "sensor_tilt", Verdict::one_of));
    result.cases.back().family = family;
  }
  result.cases.push_back(injected_case("sensor_yaw", "sensor_tilt", Verdict::one_of));  // no family is sure
  const std::vector<Rate> rates = rates_of(result);
  const auto right = std::ranges::find(rates, Counted::right_family, &Rate::what);
  const auto wrong = std::ranges::find(rates, Counted::wrong_family, &Rate::what);
  REQUIRE(right != rates.end());
  REQUIRE(wrong != rates.end());
  CHECK(right->hits == 1);
  CHECK(wrong->hits == 1);
  CHECK(right->of == 3);
  CHECK(wrong->of == 3);
}

TEST_CASE("pairs that are taken for each other are listed with what the catalogue says", "[selftest]") {
  SelftestResult result = result_of(1, 0);
  for (int i = 0; i < 8; ++i) {
    const bool swapped = i < 3;
    result.cases.push_back(
        injected_case("soft_zone_edges", swapped ? "fidgeting" : "soft_zone_edges", Verdict::one_of));
    result.cases.push_back(injected_case("fidgeting", i < 1 ? "soft_zone_edges" : "fidgeting", Verdict::one_of));
    result.cases.push_back(injected_case("sensor_yaw", "sensor_yaw", Verdict::named));
  }
  const auto pairs = confused_pairs(result, 0.1);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].first == "fidgeting");
  CHECK(pairs[0].second == "soft_zone_edges");
  CHECK(pairs[0].rate.hits == 4);  // three one way, one the other
  CHECK(pairs[0].rate.of == 16);
  CHECK(pairs[0].expected);
  CHECK(confused_pairs(result, 0.3).empty());
  const std::string text = targets_markdown(result, Geometry::uncertain);
  CHECK(count(text, "| fidgeting, soft_zone_edges | 0.25 (0.07-0.52) | foreseen |") == 1);
}

TEST_CASE("the pictures of a self-test hold its shares", "[selftest]") {
  SelftestResult result = result_of(4, 0);
  for (int i = 0; i < 4; ++i) {
    result.cases.push_back(injected_case("fidgeting", i < 1 ? "sensor_yaw" : "fidgeting", Verdict::one_of));
  }
  const io::GridChart confusion = confusion_chart(result);
  CHECK(confusion.rows == result.hypotheses);
  CHECK(*confusion.cells[2 * 4 + 3].value == Approx(0.25));
  CHECK(confusion.cells[2 * 4 + 2].text == "75");
  CHECK_FALSE(confusion.cells[3 * 4 + 3].value);  // sensor_yaw was never hidden
  const io::LineChart power = power_chart(result, "fidgeting");
  REQUIRE(power.lines[0].points.size() == 1);  // strong ones alone were hidden
  CHECK(power.lines[0].points[0].y == 1.0);
  const std::string page = to_html(selftest_page(result, Geometry::uncertain));
  CHECK(count(page, "<div class=\"charts lines\">") == 2);
}
