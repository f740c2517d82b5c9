// Rates and pictures of a self-test, from cases made by hand.
#include "reconcile/selftest/selftest.hpp"

#include <algorithm>

#include "reconcile/report/pages.hpp"
#include "reconcile/report/sentences.hpp"
#include "show/report.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

InjectedCase injected(const std::string& truth, const std::string& taken_for, Verdict verdict) {
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
    result.cases.push_back(injected("nothing", "nothing", i < alarms ? Verdict::one_of : Verdict::no_disagreement));
  }
  return result;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

}  // namespace

TEST_CASE("what had no case is neither met nor a number", "[selftest]") {
  const SelftestResult result = result_of(0, 0);
  const std::string text = to_markdown(result);
  CHECK(count(text, "| calibration error of the probabilities | no case |") == 1);
  CHECK(count(text, "| sensor_yaw | no case | no case | no case | no case | no case | no case |") == 1);
  CHECK(count(to_html(selftest_page(result)), "probability and share: no case") == 1);
}

TEST_CASE("what the catalogue is made to lack is counted by what it is called", "[selftest]") {
  SelftestResult result = result_of(1, 0);
  const auto add = [&](CaseKind kind, Verdict verdict, const std::string& named, effects::Family family) {
    result.cases.push_back(injected("fidgeting", named, verdict));
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
  result.cases[1].injected = first;  // of those left out two are told by the whole catalogue, one of them called none
  result.cases[2].injected = first;
  result.cases[3].injected = first + 1;
  const std::vector<Rate> rates = rates_of(result);
  const auto rate = [&](const std::string& what) {
    const auto found = std::ranges::find(rates, what, &Rate::what);
    REQUIRE(found != rates.end());
    return std::pair(found->hits, found->of);
  };
  using Share = std::pair<std::size_t, std::size_t>;
  CHECK(rate("an effect that the catalogue lacks: a disagreement seen") == Share(3, 4));
  CHECK(rate("an effect that the catalogue lacks: called none in the catalogue, given a disagreement") == Share(1, 3));
  CHECK(rate("an effect that the catalogue lacks and the whole one names: called none in the catalogue, given a "
             "disagreement") == Share(1, 2));
  CHECK(rate("an effect that the catalogue lacks: called by one name") == Share(2, 4));
  CHECK(rate("an effect that the catalogue lacks: called by one name of another family") == Share(1, 4));
  CHECK(rate("people's motion, in the catalogue or not: called by a name of optics or electronics") == Share(1, 6));
}

TEST_CASE("a family counts as said if the named effect is of it or its effects are sure together", "[selftest]") {
  SelftestResult result = result_of(1, 0);
  for (const auto family : {effects::Family::mounting, effects::Family::optics}) {
    result.cases.push_back(injected("sensor_yaw", "sensor_tilt", Verdict::one_of));
    result.cases.back().family = family;
  }
  result.cases.push_back(injected("sensor_yaw", "sensor_tilt", Verdict::one_of));  // no family is sure
  const std::vector<Rate> rates = rates_of(result);
  const auto right = std::ranges::find(rates, "the right family, given a disagreement", &Rate::what);
  const auto wrong = std::ranges::find(rates, "one wrong family", &Rate::what);
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
    result.cases.push_back(injected("soft_zone_edges", swapped ? "fidgeting" : "soft_zone_edges", Verdict::one_of));
    result.cases.push_back(injected("fidgeting", i < 1 ? "soft_zone_edges" : "fidgeting", Verdict::one_of));
    result.cases.push_back(injected("sensor_yaw", "sensor_yaw", Verdict::named));
  }
  const auto pairs = confused_pairs(result, 0.1);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].first == "fidgeting");
  CHECK(pairs[0].second == "soft_zone_edges");
  CHECK(pairs[0].rate.hits == 4);  // three one way, one the other
  CHECK(pairs[0].rate.of == 16);
  CHECK(pairs[0].expected);
  CHECK(confused_pairs(result, 0.3).empty());
  const std::string page = to_html(selftest_page(result));
  CHECK(count(page, "25 % (7 % to 52 %, 4 of 16)") == 1);
  CHECK(count(page, "not foreseen") == 0);
}

TEST_CASE("the pictures of a self-test hold its shares", "[selftest]") {
  SelftestResult result = result_of(4, 0);
  for (int i = 0; i < 4; ++i) {
    result.cases.push_back(injected("fidgeting", i < 1 ? "sensor_yaw" : "fidgeting", Verdict::one_of));
  }
  const io::GridChart confusion = confusion_chart(result);
  CHECK(confusion.rows == result.hypotheses);
  CHECK(*confusion.cells[2 * 4 + 3].value == Approx(0.25));
  CHECK(confusion.cells[2 * 4 + 2].text == "75");
  CHECK_FALSE(confusion.cells[3 * 4 + 3].value);  // sensor_yaw was never hidden
  const io::LineChart power = power_chart(result, "fidgeting");
  REQUIRE(power.lines[0].points.size() == 1);  // strong ones alone were hidden
  CHECK(power.lines[0].points[0].y == 1.0);
  const std::string page = to_html(selftest_page(result));
  CHECK(count(page, "<div class=\"charts lines\">") == 2);
}
