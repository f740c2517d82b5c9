// The global test of a model with effects applied, on a shortened Study A.
#include "reconcile/inference/model_check.hpp"

#include "reconcile/ensemble/realization.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

constexpr double level = 0.1;

const ReferenceStudy& three_trials() {
  static const ReferenceStudy reference = [] {
    Settings settings;
    settings.table = {60, 60, 60, {"false_triggers"}};
    return make_full_study(test::shipped_scene("meeting_room.gltf"), test::short_study({"S1", "S4", "S8"}, 60.0),
                           settings, Measured::Kind::series, 1);
  }();
  return reference;
}

std::vector<float> injected_at(std::uint32_t realization, const std::vector<EffectSpec>& effects) {
  const ReferenceStudy& reference = three_trials();
  const SimulatedRealization fresh(reference.source, reference.frame, 500000 + realization, 1);
  return statistics_of(reference.frame, reference.shape, reference.table.profile, *fresh.with_effects(effects, 0, 1));
}

/// As if it had been fitted, with these values equally likely.
FittedEffect false_triggers(double rate_per_s, std::vector<double> equally_likely) {
  FittedEffect fitted;
  fitted.effect = {"false_triggers", {{"rate_per_s", rate_per_s}}, {}, {}};
  FittedParameter rate;
  rate.name = "rate_per_s";
  rate.value = rate_per_s;
  rate.equally_likely = std::move(equally_likely);
  fitted.parameters = {rate};
  return fitted;
}

std::vector<double> p_of(std::span<const PatchedModel> models, unsigned threads = 0) {
  const ReferenceStudy& reference = three_trials();
  std::vector<double> p;
  for (const GlobalP& one : p_with(models, reference, reference.map(all_trials(reference.frame)), level, {1, threads}))
    p.push_back(one.p);
  return p;
}

double p_of(const std::vector<FittedEffect>& applied, std::span<const float> observed, unsigned threads = 0) {
  const PatchedModel model{applied, observed};
  return p_of(std::span(&model, 1), threads).front();
}

}  // namespace

TEST_CASE("a model passes with what made the data applied, and no other", "[reconcile][seconds][model-check]") {
  const FittedEffect right = false_triggers(0.1, {});
  int right_passes = 0;
  constexpr int n = 4;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::vector<float> observed = injected_at(i, {right.effect});
    right_passes += p_of({right}, observed) > level ? 1 : 0;
    CHECK(p_of({}, observed) <= level);
  }
  CHECK(right_passes >= n - 1);  // each fails with probability 0.1: two of four once in 19 choices of seeds
  CHECK(p_of({right}, injected_at(100, {})) <= level);
}

TEST_CASE("right models fail as often as the level says, and oftener if their rooms are all alike",
          "[reconcile][seconds][model-check]") {
  constexpr std::uint32_t n = 40;
  const FittedEffect right = false_triggers(0.02, {});
  std::vector<std::vector<float>> observed;
  for (std::uint32_t i = 0; i < n; ++i) observed.push_back(injected_at(1000 + i, {right.effect}));
  std::vector<PatchedModel> models;
  for (const std::vector<float>& one : observed) models.push_back({std::span(&right, 1), one});
  const auto n_refused = [&](const ReferenceStudy& reference) {
    return std::ranges::count_if(p_with(models, reference, reference.map(all_trials(reference.frame)), level, {}),
                                 [](const GlobalP& of) { return of.p <= level; });
  };
  // 4 expected, standard error 1.9: more than 9 once in 200 seeds.
  CHECK(n_refused(three_trials()) <= 9);
  ReferenceStudy alike = three_trials();
  alike.source.nuisance = {0.0, 0.0, 0.0, 0.0, 0.0};
  CHECK(n_refused(alike) > 9);
}

TEST_CASE("what a fit doesn't know for sure widens what the model can have made", "[reconcile][seconds][model-check]") {
  const std::vector<float> observed = injected_at(3, {false_triggers(0.1, {}).effect});
  CHECK(p_of({false_triggers(0.01, {})}, observed) <= level);
  CHECK(p_of({false_triggers(0.01, {0.01, 0.05, 0.1, 0.2})}, observed) > level);
}

TEST_CASE("a model's p is the same on any number of threads", "[reconcile][seconds][model-check]") {
  const std::vector<float> observed = injected_at(7, {});
  const std::vector<FittedEffect> applied{false_triggers(0.01, {0.005, 0.01, 0.02})};
  CHECK(p_of(applied, observed, 1) == p_of(applied, observed, 3));
}

TEST_CASE("what is said of a model doesn't depend on those that are looked at beside it",
          "[reconcile][seconds][model-check]") {
  FittedEffect taller;
  taller.effect = {"body_size", {{"scale", 1.1}}, {}, {}};
  const std::vector<FittedEffect> right{false_triggers(0.1, {0.08, 0.1, 0.12})}, wrong{false_triggers(0.01, {})},
      traced_anew{taller};
  const std::vector<float> observed = injected_at(5, {right.front().effect});
  const std::vector<PatchedModel> all{{wrong, observed}, {right, observed}, {traced_anew, observed}, {{}, observed}};
  const std::vector<double> together = p_of(all);
  for (std::size_t i = 0; i < all.size(); ++i) CHECK(together[i] == p_of(std::span(&all[i], 1)).front());
  CHECK(together[1] > level);
  CHECK(together[0] <= level);
}

TEST_CASE("the level is halved with every effect applied", "[reconcile]") {
  CHECK(level_with(0, 0.05) == 0.05);
  CHECK(level_with(1, 0.05) == 0.025);
  CHECK(level_with(3, 0.08) == 0.01);
}
