#include "pirsim/stats/decision.hpp"

#include "pirsim/core/error.hpp"
#include "support/catch.hpp"

using namespace pirsim::stats;

namespace {

/// Effects 0 and 1 are of family 7, effect 2 of family 8.
const std::vector<int> families{7, 7, 8};

/// All of them likely, none by far.
std::vector<Candidate> singles(double p0, double p1, double p2) {
  return {{{0}, p0, 0.6}, {{1}, p1, 0.6}, {{2}, p2, 0.6}};
}

const std::vector<Candidate> pairs{{{0, 1}, 0.01}, {{0, 2}, 0.3}, {{1, 2}, 0.6}};

}  // namespace

TEST_CASE("a model that is not refused has no disagreement whatever the effects say", "[stats]") {
  CHECK(decide(0.3, singles(0.9, 0.0, 0.0), pairs, families, {0.05}) == Decision{});
}

TEST_CASE("one surviving effect is named", "[stats]") {
  const Decision decision = decide(0.001, singles(0.01, 0.4, 0.05), pairs, families, {0.05});
  CHECK(decision == Decision{Verdict::named, {1}, {1}, 7});
}

TEST_CASE("one surviving effect that is not likely is not named", "[stats]") {
  std::vector<Candidate> candidates = singles(0.01, 0.4, 0.05);
  candidates[1].probability = 0.2;
  CHECK(decide(0.001, candidates, pairs, families, {0.05}) == Decision{Verdict::one_of, {1}, {1}, 7});
}

TEST_CASE("several surviving effects are one of them with the family if it is one", "[stats]") {
  CHECK(decide(0.001, singles(0.1, 0.4, 0.0), pairs, families, {0.05}) == Decision{Verdict::one_of, {1, 0}, {}, 7});
  CHECK(decide(0.001, singles(0.1, 0.4, 0.2), pairs, families, {0.05}) ==
        Decision{Verdict::one_of, {1, 2, 0}, {}, std::nullopt});
}

TEST_CASE("combinations are looked at only when no single effect survives", "[stats]") {
  CHECK(decide(0.001, singles(0.0, 0.0, 0.0), pairs, families, {0.05}) ==
        Decision{Verdict::several, {2, 1}, {2}, std::nullopt});
  CHECK(decide(0.001, singles(0.0, 0.0, 0.0), pairs, families, {0.7}).verdict == Verdict::none_in_catalogue);
  CHECK(decide(0.001, singles(0.0, 0.0, 0.0), {}, families, {0.05}).verdict == Verdict::none_in_catalogue);
  CHECK_THROWS_AS(decide(0.5, std::vector<Candidate>{{{3}, 0.1}}, {}, families, {0.05}), pirsim::Error);
}

TEST_CASE("no effect is named while the model as it is can't be ruled out", "[stats]") {
  std::vector<Candidate> candidates = singles(0.4, 0.0, 0.0);
  candidates.push_back({{}, 0.2});
  CHECK(decide(0.04, candidates, pairs, families, {0.05}) == Decision{Verdict::one_of, {0, 3}, {}, 7});
  candidates[0].p = 0.0;
  CHECK(decide(0.04, candidates, pairs, families, {0.05}) == Decision{Verdict::one_of, {3}, {}, std::nullopt});
}

TEST_CASE("an effect that is far likelier than the other survivors is named with them behind it", "[stats]") {
  std::vector<Candidate> candidates = singles(0.4, 0.1, 0.2);
  candidates[1].probability = 0.9;
  candidates[0].probability = 0.1;
  CHECK(decide(0.01, candidates, pairs, families, {0.05, 0.85}) == Decision{Verdict::named, {1, 0, 2}, {1}, 7});
  CHECK(decide(0.01, candidates, pairs, families, {0.05, 0.95}).verdict == Verdict::one_of);
  candidates.push_back({{}, 0.2});  // but not while the model as it is survives
  CHECK(decide(0.01, candidates, pairs, families, {0.05, 0.85}).verdict == Verdict::one_of);
  candidates.back().p = 0.01;
  candidates[1].p = 0.01;  // nor if the likeliest is refused itself
  CHECK(decide(0.01, candidates, pairs, families, {0.05, 0.85}).verdict == Verdict::one_of);
}
