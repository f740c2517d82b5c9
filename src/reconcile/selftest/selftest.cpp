#include "reconcile/selftest/selftest.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "model/core/parallel.hpp"
#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {
namespace {

template <typename Item, typename Value, typename Of = std::identity>
bool contains(const std::vector<Item>& items, const Value& value, Of of = {}) {
  return std::ranges::find(items, value, of) != items.end();
}

bool is_named(const InjectedCase& c, const std::string& effect) {
  return c.verdict == Verdict::named && c.named.front() == effect;
}

void check_coverage(const FittedEffect& fitted, const EffectSpec& truth, InjectedCase& result) {
  for (const FittedParameter& parameter : fitted.parameters) {
    const auto true_value = truth.parameters.find(parameter.name);
    if (true_value == truth.parameters.end()) continue;  // of another kind
    ++result.n_parameters;
    result.n_covered += parameter.interval.contains(true_value->second) ? 1 : 0;
  }
}

InjectedCase judged(const ReferenceStudy& reference, const Analyst& analyst, const InjectedDataset& injected,
                    CaseKind kind) {
  const Judgement judgement = analyst.judge(injected.statistics);
  InjectedCase result{kind, injected.truth(), injected.strength, injected.effects, judgement.decision.verdict};
  for (const std::size_t hypothesis : judgement.decision.kept) {
    if (hypothesis > 0) result.named.push_back(reference.table.hypothesis_name(hypothesis));
  }
  result.p = judgement.p;
  for (const HypothesisScore& score : judgement.scores) result.probabilities.push_back(score.probability);
  const auto best = std::ranges::max_element(judgement.scores, {}, &HypothesisScore::probability);
  result.likeliest = best->hypothesis;
  if (!result.named.empty() && judgement.family.is_sure()) result.family = judgement.family.family;
  if (result.verdict != Verdict::named) return result;
  const FittedEffect fitted = analyst.fit(hypothesis_of(reference.table, result.named.front()), injected.statistics);
  if (analyst.takes_back(fitted, result.p)) {
    result.verdict = Verdict::one_of;
    return result;
  }
  result.named.resize(1);
  result.family = effects::find(result.named.front()).info.family;
  if (kind == CaseKind::one && is_named(result, result.truth)) {
    check_coverage(fitted, injected.effects.front(), result);
  }
  return result;
}

/// which: of the injected datasets, by index.
void judge_all(const ReferenceStudy& reference, const Analyst& analyst, const std::vector<InjectedDataset>& injected,
               const std::vector<std::size_t>& which, std::optional<CaseKind> kind, unsigned threads,
               std::vector<InjectedCase>& cases) {
  const auto case_of = [&](std::size_t i) {
    const InjectedDataset& one = injected[which[i]];
    InjectedCase result = judged(reference, analyst, one, kind.value_or(one.kind));
    result.injected = which[i];
    return result;
  };
  std::ranges::move(in_parallel<InjectedCase>(which.size(), threads, case_of), std::back_inserter(cases));
}

/// Of datasets with a disagreement: elsewhere no probability is told.
stats::Reliability reliability_of(const SelftestResult& result) {
  stats::Matrix<double> probabilities;
  std::vector<int> labels;
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::one || !c.seen()) continue;
    probabilities.append_row(c.probabilities);
    labels.push_back(static_cast<int>(std::ranges::find(result.hypotheses, c.truth) - result.hypotheses.begin()));
  }
  return labels.empty() ? stats::Reliability{} : stats::reliability(probabilities, labels);
}

bool names_other(const std::string& effect, const std::string& other) {
  return contains(effects::find(effect).info.confused_with, other);
}

}  // namespace

std::string_view name(CaseKind kind) noexcept {
  constexpr std::array<std::string_view, 4> names{"nothing", "one", "left_out", "two"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view name(Strength strength) noexcept {
  constexpr std::array<std::string_view, 4> names{"none", "weak", "medium", "strong"};
  return names[static_cast<std::size_t>(strength)];
}

SelftestResult judge(const ReferenceStudy& reference, const std::vector<InjectedDataset>& injected,
                     const SelftestSettings& settings, const Context& context) {
  const Settings& analysis = settings.analysis;
  const auto view = reference.view(all_trials(reference.frame), context.threads);
  const auto analyst_without = [&](const std::string& left_out) {
    return Analyst(view, {analysis.alpha, analysis.trees, left_out}, context);
  };
  SelftestResult result;
  result.hypotheses = reference.table.hypotheses();
  context.begin("judging");
  std::vector<std::size_t> all = stats::numbers_to(injected.size());
  judge_all(reference, analyst_without({}), injected, all, {}, context.threads, result.cases);
  result.reliability = reliability_of(result);
  if (settings.leave_out == LeaveOut::none) return result;
  for (const std::string& effect : reference.table.effects) {
    context.begin("judging by a catalogue that lacks " + effect);
    std::vector<std::size_t> own;
    for (const std::size_t i : all) {
      if (injected[i].kind == CaseKind::one && injected[i].effects.front().name == effect) own.push_back(i);
    }
    judge_all(reference, analyst_without(effect), injected, own, CaseKind::left_out, context.threads, result.cases);
  }
  return result;
}

SelftestResult selftest(const SceneSpec& scene, const ScriptSpec& script, const SelftestSettings& settings,
                        const Context& context) {
  const ReferenceStudy reference =
      make_full_study(scene, script, settings.analysis, settings.kind, settings.n_replicates, context);
  return judge(reference, inject(reference, settings, context), settings, context);
}

std::vector<Rate> rates_of(const SelftestResult& result) {
  using Case = InjectedCase;
  std::vector<Rate> rates;
  const auto count = [&](CaseKind kind, std::string what, const auto& is_asked, const auto& is_hit) {
    Rate& rate = rates.emplace_back(Rate{std::move(what)});
    for (const Case& c : result.cases) {
      if (c.kind == kind && is_asked(c)) rate.count(is_hit(c));
    }
  };
  const auto any = [](const Case&) { return true; };
  const auto seen = [](const Case& c) { return c.seen(); };
  const auto named = [](const Case& c) { return c.verdict == Verdict::named; };
  const auto none = [](const Case& c) { return c.verdict == Verdict::none_in_catalogue; };
  const auto right = [](const Case& c) { return is_named(c, c.truth); };
  const auto right_family = [](const Case& c) { return c.family == effects::find(c.truth).info.family; };
  count(CaseKind::nothing, alarm_on_nothing, any, seen);
  count(CaseKind::nothing, "a name although nothing is hidden", any, named);

  count(CaseKind::one, disagreement_seen, any, seen);
  count(CaseKind::one, exact_name, seen, right);
  count(CaseKind::one, "the right family, given a disagreement", seen, right_family);
  count(CaseKind::one, "a name, given a disagreement", seen, named);
  count(CaseKind::one, "the right name, given a name", named, right);
  count(CaseKind::one, wrong_name, any, [&](const Case& c) { return named(c) && !right(c); });
  count(CaseKind::one, "one wrong family", any, [&](const Case& c) { return c.family && !right_family(c); });
  count(CaseKind::one, "the truth in the set, given a disagreement", seen,
        [](const Case& c) { return contains(c.named, c.truth); });
  count(CaseKind::one, "none in the catalogue, given a disagreement", seen, none);
  Rate& coverage = rates.emplace_back(Rate{"parameters within their 90 % intervals"});
  for (const Case& c : result.cases) {
    if (c.kind != CaseKind::one) continue;
    coverage.hits += c.n_covered;
    coverage.of += c.n_parameters;
  }

  if (contains(result.cases, CaseKind::left_out, &Case::kind)) {
    const std::string lacks = "an effect that the catalogue lacks",
                      none_told = "none in the catalogue, given a disagreement";
    count(CaseKind::left_out, lacks + ": a disagreement seen", any, seen);
    count(CaseKind::left_out, lacks + ": called " + none_told, seen, none);
    // Of those that the whole catalogue doesn't name, others are as good as nested.
    count(
        CaseKind::left_out, lacks + " and the whole one names: called " + none_told,
        [&](const Case& c) { return c.seen() && right(result.cases[c.injected]); }, none);
    count(CaseKind::left_out, lacks + ": called by one name", any, named);
    count(CaseKind::left_out, lacks + ": called by one name of another family", any,
          [&](const Case& c) { return named(c) && !right_family(c); });
  }

  Rate as_sensor{"people's motion, in the catalogue or not: called by a name of optics or electronics"};
  for (const Case& c : result.cases) {
    const bool is_catalogued = c.kind == CaseKind::one || c.kind == CaseKind::left_out;
    if (!is_catalogued || effects::find(c.truth).info.family != effects::Family::motion) continue;
    const bool is_sensor = c.family == effects::Family::optics || c.family == effects::Family::electronics;
    as_sensor.count(named(c) && is_sensor);
  }
  if (as_sensor.of > 0) rates.push_back(as_sensor);

  if (contains(result.cases, CaseKind::two, &Case::kind)) {
    const auto in_set = [](const Case& c) {
      return std::ranges::any_of(c.named,
                                 [&](const auto& name) { return contains(c.effects, name, &EffectSpec::name); });
    };
    const std::string two = "two effects, first look: ";
    count(CaseKind::two, two + "one or both in the set, given a disagreement", seen, in_set);
    count(CaseKind::two, two + "no single effect will do, given a disagreement", seen, none);
    count(CaseKind::two, two + "one wrong name", any, [&](const Case& c) { return named(c) && !in_set(c); });
  }
  return rates;
}

std::vector<Rate> power_of(const SelftestResult& result, const std::string& effect) {
  std::vector<Rate> rates;
  for (const Strength strength : {Strength::weak, Strength::medium, Strength::strong}) {
    Rate seen{disagreement_seen}, found{"seen and in the set"};
    for (const InjectedCase& c : result.cases) {
      if (c.kind != CaseKind::one || c.truth != effect || c.strength != strength) continue;
      seen.count(c.seen());
      found.count(contains(c.named, effect));
    }
    rates.insert(rates.end(), {seen, found});
  }
  return rates;
}

std::vector<ConfusedPair> confused_pairs(const SelftestResult& result, double least_share) {
  std::map<std::string, std::size_t> cases;
  std::map<std::pair<std::string, std::string>, std::size_t> taken;  // in alphabetical order
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::one || !c.seen()) continue;
    ++cases[c.truth];
    if (c.likeliest != c.truth && c.likeliest != "nothing") ++taken[std::minmax(c.truth, c.likeliest)];
  }
  constexpr std::size_t fewest_cases = 3;
  std::vector<ConfusedPair> pairs;
  for (const auto& [names, hits] : taken) {
    const auto& [a, b] = names;
    const Rate rate{"taken for each other", hits, cases[a] + cases[b]};
    if (hits < fewest_cases || rate.value() < least_share) continue;
    pairs.push_back({a, b, rate, names_other(a, b) || names_other(b, a)});
  }
  std::ranges::stable_sort(pairs, std::ranges::greater{}, [](const ConfusedPair& pair) { return pair.rate.value(); });
  return pairs;
}

std::vector<std::vector<double>> shares_of_rows(std::vector<std::vector<double>> counts) {
  for (std::vector<double>& row : counts) {
    const double sum = std::accumulate(row.begin(), row.end(), 0.0);
    for (double& value : row) value = sum > 0.0 ? value / sum : 0.0;
  }
  return counts;
}

std::vector<std::vector<double>> confusion_of(const SelftestResult& result) {
  const std::size_t n = result.hypotheses.size();
  std::vector<std::vector<double>> shares(n, std::vector<double>(n, 0.0));
  const auto index = [&](const std::string& hypothesis) {
    return static_cast<std::size_t>(std::ranges::find(result.hypotheses, hypothesis) - result.hypotheses.begin());
  };
  for (const InjectedCase& c : result.cases) {
    if (c.kind == CaseKind::nothing || (c.kind == CaseKind::one && c.seen())) {
      shares[index(c.truth)][index(c.likeliest)] += 1.0;
    }
  }
  return shares_of_rows(std::move(shares));
}

}  // namespace pirsim::reconcile
