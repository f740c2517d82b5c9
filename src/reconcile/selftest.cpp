#include "pirsim/reconcile/selftest.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pirsim/core/parallel.hpp"
#include "pirsim/effects/catalogue.hpp"
#include "pirsim/reconcile/analyst.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t first_planted_world = 1U << 25U;  ///< worlds that no table has seen
constexpr std::uint32_t most_draws = 200;                 ///< for parameters of the strength wanted

/// Distance from off in [0, 1] of what the prior allows, on the scale on which the prior is flat.
double strength_of(const effects::ParameterInfo& info, double value) {
  const auto flat = [&](double v) {
    return info.scale == effects::Scale::logarithmic ? std::log(std::clamp(v, info.low, info.high)) : v;
  };
  const double off = flat(std::clamp(info.off, info.low, info.high));
  const double most = std::max(flat(info.high) - off, off - flat(info.low));
  return most > 0.0 ? std::abs(flat(value) - off) / most : 0.5;
}

bool has_strength(const effects::Effect& effect, const EffectSpec& spec, Strength wanted) {
  if (effect.info.parameters.empty()) return true;
  const effects::ParameterInfo& first = effect.info.parameters.front();
  if (first.low == first.high) return true;
  const double third = 3.0 * strength_of(first, spec.parameters.at(first.name));
  const auto which = static_cast<Strength>(1 + std::min(2, static_cast<int>(third)));
  return which == wanted;
}

/// What is to be planted: in the order of the result.
struct Plan {
  const effects::Effect* effect = nullptr;  ///< null: nothing
  Strength strength = Strength::none;
};

std::vector<Plan> plans_of(const Laboratory& lab, const SelftestSettings& settings) {
  std::vector<Plan> plans(settings.n_nulls);
  for (const std::string& name : lab.table.effects) {
    for (const Strength strength : {Strength::weak, Strength::medium, Strength::strong}) {
      plans.insert(plans.end(), settings.n_planted, Plan{&effects::find(name), strength});
    }
  }
  return plans;
}

std::optional<std::vector<Series>> plant(const SimulatedWorld& world, const Plan& plan, std::uint64_t seed,
                                         std::uint32_t index, int n_replicates, EffectSpec& effect) {
  if (plan.effect == nullptr) return world.plain(0, n_replicates);
  for (std::uint32_t draw = 0; draw < most_draws; ++draw) {
    Stream stream({seed, index, draw, Purpose::sealed_answer});
    effect = effects::draw_from_prior(*plan.effect, world.world().scene, world.world().script, stream);
    if (!has_strength(*plan.effect, effect, plan.strength)) continue;
    auto data = world.with_effects(std::span(&effect, 1), 0, n_replicates);
    if (data) return data;
  }
  return std::nullopt;
}

void check_coverage(const FittedEffect& fitted, const EffectSpec& truth, PlantedCase& result) {
  for (const FittedParameter& parameter : fitted.parameters) {
    ++result.n_parameters;
    result.n_covered += parameter.interval.contains(truth.parameters.at(parameter.name)) ? 1 : 0;
  }
}

std::optional<PlantedCase> run_case(const Laboratory& lab, const Analyst& analyst, const Plan& plan,
                                    const SelftestSettings& settings, std::uint32_t index) {
  const SimulatedWorld world(lab.source, lab.frame, first_planted_world + index, settings.n_replicates);
  PlantedCase result;
  const auto data = plant(world, plan, settings.analysis.seed, index, settings.n_replicates, result.effect);
  if (!data) return std::nullopt;
  const Outcome outcome = analyst.analyse(statistics_of(lab.frame, lab.shape, lab.table.profile, *data));
  result.truth = plan.effect == nullptr ? "nothing" : plan.effect->info.name;
  result.strength = plan.strength;
  result.verdict = outcome.verdict;
  result.named = outcome.named;
  result.p = outcome.location.p;
  const auto best = std::ranges::max_element(outcome.candidates, {}, [](const auto& c) { return c.score.probability; });
  const bool nothing = best == outcome.candidates.end() || outcome.nothing.probability >= best->score.probability;
  result.likeliest = nothing ? "nothing" : best->score.entry;
  if (result.verdict == Verdict::named && result.named.front() == result.truth) {
    check_coverage(outcome.fits.front(), result.effect, result);
  }
  return result;
}

bool family_is(const std::vector<std::string>& effects, const std::string& truth) {
  return !effects.empty() && std::ranges::all_of(effects, [&](const std::string& effect) {
    return effects::find(effect).info.family == effects::find(truth).info.family;
  });
}

/// Counts cases.
class Counter {
 public:
  explicit Counter(std::string what) { rate_.what = std::move(what); }
  void count(bool hit) {
    ++rate_.of;
    rate_.hits += hit ? 1 : 0;
  }
  void add(std::size_t hits, std::size_t of) {
    rate_.hits += hits;
    rate_.of += of;
  }
  [[nodiscard]] Rate rate() const {
    Rate rate = rate_;
    rate.interval = rate.of == 0 ? stats::Interval{0.0, 1.0} : stats::clopper_pearson(rate.hits, rate.of);
    return rate;
  }

 private:
  Rate rate_;
};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

std::string_view name(Strength strength) noexcept {
  constexpr std::array<std::string_view, 4> names{"none", "weak", "medium", "strong"};
  return names[static_cast<std::size_t>(strength)];
}

SelftestResult selftest(const SceneSpec& scene, const ScriptSpec& script, const SelftestSettings& settings,
                        const Observer& observer) {
  const Laboratory lab = make_laboratory(
      scene, script, settings.analysis,
      [&](const StudyFrame& frame, std::span<const Series> pilot) {
        return full_shape(frame, settings.kind, settings.n_replicates, pilot);
      },
      observer);
  if (observer.stage) observer.stage("training");
  const Settings& analysis = settings.analysis;
  const Analyst analyst(lab.frame, lab.knowledge, lab.table, all_trials(lab.frame),
                        {analysis.alpha, analysis.seed, analysis.threads, analysis.trees});
  if (observer.stage) observer.stage("planted datasets");
  const std::vector<Plan> plans = plans_of(lab, settings);
  SelftestResult result;
  for (std::size_t entry = 0; entry < lab.table.n_entries(); ++entry)
    result.entries.push_back(lab.table.entry_name(entry));
  result.calibration_error = analyst.namer().reliability().expected_calibration_error;
  std::uint32_t done = 0;
  ordered_parallel<std::optional<PlantedCase>>(
      plans.size(), analysis.threads,
      [&](std::size_t i) { return run_case(lab, analyst, plans[i], settings, static_cast<std::uint32_t>(i)); },
      [&](std::optional<PlantedCase>& planted) {
        if (planted) result.cases.push_back(std::move(*planted));
        if (observer.progress) observer.progress(++done, static_cast<std::uint32_t>(plans.size()));
      });
  return result;
}

std::vector<Rate> rates_of(const SelftestResult& result) {
  Counter alarm("a disagreement although nothing is hidden"), null_name("a name although nothing is hidden"),
      power("a disagreement seen"), exact("exactly the right name, given a disagreement"),
      family("the right family, given a disagreement"), wrong("one wrong name"),
      in_set("the truth in the set, given a disagreement"), none("none in the catalogue, given a disagreement"),
      coverage("parameters within their 90 % intervals");
  for (const PlantedCase& c : result.cases) {
    const bool seen = c.verdict != Verdict::no_disagreement;
    if (c.truth == "nothing") {
      alarm.count(seen);
      null_name.count(c.verdict == Verdict::named);
      continue;
    }
    power.count(seen);
    wrong.count(c.verdict == Verdict::named && c.named.front() != c.truth);
    coverage.add(c.n_covered, c.n_parameters);
    if (!seen) continue;
    exact.count(c.verdict == Verdict::named && c.named.front() == c.truth);
    family.count(family_is(c.named, c.truth));
    in_set.count(contains(c.named, c.truth));
    none.count(c.verdict == Verdict::none_in_catalogue);
  }
  return {alarm.rate(), null_name.rate(), power.rate(), exact.rate(),   family.rate(),
          wrong.rate(), in_set.rate(),    none.rate(),  coverage.rate()};
}

std::vector<Rate> power_of(const SelftestResult& result, const std::string& effect) {
  std::vector<Rate> rates;
  for (const Strength strength : {Strength::weak, Strength::medium, Strength::strong}) {
    Counter seen(std::string(name(strength)) + ": seen"), found(std::string(name(strength)) + ": seen and in the set");
    for (const PlantedCase& c : result.cases) {
      if (c.truth != effect || c.strength != strength) continue;
      seen.count(c.verdict != Verdict::no_disagreement);
      found.count(contains(c.named, effect));
    }
    rates.push_back(seen.rate());
    rates.push_back(found.rate());
  }
  return rates;
}

std::vector<std::vector<double>> confusion_of(const SelftestResult& result) {
  const std::size_t n = result.entries.size();
  std::vector<std::vector<double>> shares(n, std::vector<double>(n, 0.0));
  const auto index = [&](const std::string& entry) {
    return static_cast<std::size_t>(std::ranges::find(result.entries, entry) - result.entries.begin());
  };
  for (const PlantedCase& c : result.cases) {
    if (c.truth != "nothing" && c.verdict == Verdict::no_disagreement) continue;
    shares[index(c.truth)][index(c.likeliest)] += 1.0;
  }
  for (std::vector<double>& row : shares) {
    double sum = 0.0;
    for (const double value : row) sum += value;
    for (double& value : row) value = sum > 0.0 ? value / sum : 0.0;
  }
  return shares;
}

}  // namespace pirsim::reconcile
