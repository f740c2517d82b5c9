#include "reconcile/inference/analyst.hpp"

#include "support/catch.hpp"

using namespace pirsim::reconcile;

namespace {

HypothesisScore score(double p, double probability, double least_p = 0.0) {
  return {.probability = probability, .p = p, .least_p = least_p};
}

/// The model as it is, then three effects; all effects likely, none by far.
std::vector<HypothesisScore> scores(double plain, double p1, double p2, double p3) {
  return {score(plain, 0.0), score(p1, 0.6), score(p2, 0.6), score(p3, 0.6)};
}

}  // namespace

TEST_CASE("a model that is not refused has no disagreement whatever the effects say", "[reconcile]") {
  CHECK(decide(0.3, scores(0.0, 0.9, 0.0, 0.0), {0.05}) == Decision{});
}

TEST_CASE("one surviving effect is named", "[reconcile]") {
  CHECK(decide(0.001, scores(0.0, 0.01, 0.4, 0.05), {0.05}) == Decision{Verdict::named, {2}});
}

TEST_CASE("while people may have been miscounted, no sensor is blamed", "[reconcile]") {
  std::vector<HypothesisScore> all = scores(0.0, 0.01, 0.4, 0.2);
  all[1].hypothesis = "range_scale";
  all[2].hypothesis = "missed_triggers";
  all[3].hypothesis = "people_miscounted";
  all[2].probability = 0.95;
  all[3].probability = 0.04;
  CHECK(decide(0.001, all, {0.05}) == Decision{Verdict::one_of, {2, 3}});
  all[2].hypothesis = "labels_swapped";  // of the books, as the counts are
  CHECK(decide(0.001, all, {0.05}) == Decision{Verdict::named, {2, 3}});
  all[2].hypothesis = "missed_triggers";
  all[3].p = 0.01;
  CHECK(decide(0.001, all, {0.05}) == Decision{Verdict::named, {2}});
}

TEST_CASE("effects that survive while likelier ones are ruled out are none of the catalogue", "[reconcile]") {
  std::vector<HypothesisScore> unlikely = scores(0.0, 0.01, 0.4, 0.05);
  unlikely[2].probability = 0.2;
  CHECK(decide(0.001, unlikely, {0.05}) == Decision{Verdict::none_in_catalogue, {}});
  unlikely[3] = score(0.3, 0.35);  // together they are more probable than not
  CHECK(decide(0.001, unlikely, {0.05}) == Decision{Verdict::one_of, {2, 3}});
  unlikely[3].probability = 0.25;
  CHECK(decide(0.001, unlikely, {0.05}).verdict == Verdict::none_in_catalogue);
  unlikely[0].p = 0.1;  // while the model as it is survives, nothing is known for sure
  CHECK(decide(0.001, unlikely, {0.05}) == Decision{Verdict::one_of, {2, 3, 0}});
}

TEST_CASE("several surviving effects are one of them, the one that fits best first", "[reconcile]") {
  CHECK(decide(0.001, scores(0.0, 0.1, 0.4, 0.0), {0.05}) == Decision{Verdict::one_of, {2, 1}});
  CHECK(decide(0.001, scores(0.0, 0.1, 0.4, 0.2), {0.05}) == Decision{Verdict::one_of, {2, 3, 1}});
}

TEST_CASE("several effects that explain little of held-out trials become one of them", "[reconcile]") {
  const auto judged = [](Verdict verdict, std::optional<double> share_closed) {
    Outcome outcome;
    outcome.verdict = verdict;
    outcome.named = {"cat", "fan"};
    outcome.fits.resize(2);
    outcome.candidates.resize(1);
    outcome.candidates.front().named_together = true;
    if (share_closed) outcome.verification.emplace().share_closed = *share_closed;
    const bool taken_back = take_back_several(outcome);
    CHECK(taken_back == (outcome.verdict != verdict));
    CHECK(outcome.named.size() == 2);
    CHECK(outcome.fits.empty() == taken_back);
    CHECK(outcome.candidates.front().named_together != taken_back);
    return outcome.verdict;
  };
  CHECK(judged(Verdict::several, 0.15) == Verdict::one_of);
  CHECK(judged(Verdict::several, -0.5) == Verdict::one_of);
  CHECK(judged(Verdict::several, 0.16) == Verdict::several);
  CHECK(judged(Verdict::several, std::nullopt) == Verdict::several);  // nothing could be held out
  CHECK(judged(Verdict::named, 0.1) == Verdict::named);
}

TEST_CASE("an effect that is as good as certain is ruled out at two fifths of the level only", "[reconcile]") {
  std::vector<HypothesisScore> certain = scores(0.0, 0.0, 0.03, 0.0);
  CHECK(decide(0.001, certain, {0.05}).verdict == Verdict::none_in_catalogue);
  certain[2].probability = 0.995;
  CHECK(decide(0.001, certain, {0.05}) == Decision{Verdict::named, {2}});
  certain[2].p = 0.02;
  CHECK(decide(0.001, certain, {0.05}).verdict == Verdict::none_in_catalogue);
  // With 48 calibration rows no p is below 0.041: who has that one is stranger than all of them.
  certain[2] = score(2.0 / 49.0, 0.995, 2.0 / 49.0);
  CHECK(decide(0.001, certain, {0.05}).verdict == Verdict::none_in_catalogue);
  certain[2].p = 0.06;
  certain[2].least_p = 0.2;  // and with eight of them the level itself is what it was
  CHECK(decide(0.001, certain, {0.05}).verdict == Verdict::named);
  certain[0] = score(0.03, 0.995);  // the model as it is has no such privilege
  certain[2].p = 0.0;
  CHECK(decide(0.001, certain, {0.05}).verdict == Verdict::none_in_catalogue);
}

TEST_CASE("who would be named but only resembles what made the data is told apart", "[reconcile]") {
  std::vector<HypothesisScore> one = scores(0.0, 0.0, 0.4, 0.0);
  one[2].p_own = 0.026;
  CHECK(decide(0.001, one, {0.05}) == Decision{Verdict::named, {2}});
  one[2].p_own = 0.025;
  CHECK(decide(0.001, one, {0.05}) == Decision{Verdict::none_in_catalogue, {}, 2});
  one[3].p = 0.3;  // where two can't be told apart nothing is named anyway
  CHECK(decide(0.001, one, {0.05}) == Decision{Verdict::one_of, {2, 3}});
}

TEST_CASE("where nothing survives the catalogue lacks it", "[reconcile]") {
  CHECK(decide(0.001, scores(0.0, 0.0, 0.0, 0.0), {0.05}) == Decision{Verdict::none_in_catalogue, {}});
  CHECK(decide(0.001, scores(0.0, 0.1, 0.4, 0.2), {0.5}).verdict == Verdict::none_in_catalogue);
}

TEST_CASE("no effect is named while the model as it is can't be ruled out", "[reconcile]") {
  CHECK(decide(0.04, scores(0.2, 0.4, 0.0, 0.0), {0.05}) == Decision{Verdict::one_of, {1, 0}});
  CHECK(decide(0.04, scores(0.2, 0.0, 0.0, 0.0), {0.05}) == Decision{Verdict::one_of, {0}});
}

TEST_CASE("an effect that is far likelier than the other survivors is named with them behind it", "[reconcile]") {
  std::vector<HypothesisScore> unequal = scores(0.0, 0.4, 0.1, 0.2);
  unequal[2].probability = 0.9;
  unequal[1].probability = 0.1;
  CHECK(decide(0.01, unequal, {0.05, 0.85}) == Decision{Verdict::named, {2, 1, 3}});
  CHECK(decide(0.01, unequal, {0.05, 0.95}).verdict == Verdict::one_of);
  unequal[0].p = 0.2;  // but not while the model as it is survives
  CHECK(decide(0.01, unequal, {0.05, 0.85}).verdict == Verdict::one_of);
  unequal[0].p = 0.01;
  unequal[2].p = 0.01;  // nor if the likeliest is refused itself
  CHECK(decide(0.01, unequal, {0.05, 0.85}).verdict == Verdict::one_of);
}

TEST_CASE("a relative that does twice as well in a name's place takes it back, one that merely passes doesn't",
          "[reconcile]") {
  const Look named{{"sensor_tilt"}, 0.025, 0.3, {}};
  const std::vector<Look> passing{{{"sensor_yaw"}, 0.025, 0.2, {}}, {{"sensor_height"}, 0.025, 0.59, {}}};
  CHECK(better_relative(passing, named) == nullptr);
  CHECK(better_relative({}, named) == nullptr);
  const std::vector<Look> better{{{"sensor_yaw"}, 0.025, 0.2, {}}, {{"sensor_height"}, 0.025, 0.6, {}}};
  REQUIRE(better_relative(better, named) != nullptr);
  CHECK(better_relative(better, named)->applied.front() == "sensor_height");
  const std::vector<Look> both_fail{{{"sensor_yaw"}, 0.025, 0.02, {}}};
  CHECK(better_relative(both_fail, {{"sensor_tilt"}, 0.025, 0.005, {}}) == nullptr);
}

TEST_CASE("what comes nearest is likely and passes when it is applied", "[reconcile]") {
  HypothesisScore dropped{"labels_swapped", 0.98};
  CHECK(comes_nearest(dropped, {{"labels_swapped"}, 0.025, 0.3, {}}));
  CHECK_FALSE(comes_nearest(dropped, {{"labels_swapped"}, 0.025, 0.02, {}}));
  dropped.probability = 0.8;
  CHECK_FALSE(comes_nearest(dropped, {{"labels_swapped"}, 0.025, 0.3, {}}));
}

TEST_CASE("while the counts may be wrong nothing else is tried", "[reconcile]") {
  Candidate counts;
  counts.score = {"people_miscounted", 0.1, 0.2, 0.2, 0.3};
  Candidate other;
  other.score = {"blind_field", 0.9, 0.0, 0.0, 0.3};
  CHECK(counts_in_doubt(std::vector{other, counts}, 0.05));
  CHECK_FALSE(counts_in_doubt(std::vector{other}, 0.05));
  counts.score.p = 0.01;
  CHECK_FALSE(counts_in_doubt(std::vector{other, counts}, 0.05));
}
