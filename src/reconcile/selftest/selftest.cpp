#include "reconcile/selftest/selftest.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "model/core/parallel.hpp"
#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
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
  InjectedCase result;
  result.kind = kind;
  result.truth = injected.truth();
  result.strength = injected.strength;
  result.effects = injected.effects;
  result.verdict = judgement.decision.verdict;
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
  ordered_parallel<InjectedCase>(
      which.size(), threads,
      [&](std::size_t i) {
        const InjectedDataset& one = injected[which[i]];
        InjectedCase result = judged(reference, analyst, one, kind.value_or(one.kind));
        result.injected = which[i];
        return result;
      },
      [&](InjectedCase& one) { cases.push_back(std::move(one)); });
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

void count_nulls(const SelftestResult& result, std::vector<Rate>& rates) {
  Rate alarm{alarm_on_nothing}, named{"a name although nothing is hidden"};
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::nothing) continue;
    alarm.count(c.seen());
    named.count(c.verdict == Verdict::named);
  }
  rates.insert(rates.end(), {alarm, named});
}

void count_injected(const SelftestResult& result, std::vector<Rate>& rates) {
  Rate power{disagreement_seen}, exact{exact_name}, family{"the right family, given a disagreement"},
      named{"a name, given a disagreement"}, right{"the right name, given a name"}, wrong{wrong_name},
      wrong_family{"one wrong family"}, in_set{"the truth in the set, given a disagreement"},
      none{"none in the catalogue, given a disagreement"}, coverage{"parameters within their 90 % intervals"};
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::one) continue;
    power.count(c.seen());
    wrong.count(c.verdict == Verdict::named && !is_named(c, c.truth));
    wrong_family.count(c.family.has_value() && c.family != effects::find(c.truth).info.family);
    coverage.hits += c.n_covered;
    coverage.of += c.n_parameters;
    if (!c.seen()) continue;
    exact.count(is_named(c, c.truth));
    named.count(c.verdict == Verdict::named);
    if (c.verdict == Verdict::named) right.count(is_named(c, c.truth));
    family.count(c.family == effects::find(c.truth).info.family);
    in_set.count(contains(c.named, c.truth));
    none.count(c.verdict == Verdict::none_in_catalogue);
  }
  rates.insert(rates.end(), {power, exact, family, named, right, wrong, wrong_family, in_set, none, coverage});
}

void count_left_out(const SelftestResult& result, std::vector<Rate>& rates) {
  const std::string lacks = "an effect that the catalogue lacks",
                    none_told = "none in the catalogue, given a disagreement";
  // Of those that the whole catalogue doesn't name, others are as good as nested.
  Rate seen{lacks + ": a disagreement seen"}, none{lacks + ": called " + none_told},
      told_none{lacks + " and the whole one names: called " + none_told}, misnamed{lacks + ": called by one name"},
      outside{lacks + ": called by one name of another family"};
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::left_out) continue;
    const bool is_family = c.family == effects::find(c.truth).info.family;
    seen.count(c.seen());
    misnamed.count(c.verdict == Verdict::named);
    outside.count(c.verdict == Verdict::named && !is_family);
    if (!c.seen()) continue;
    none.count(c.verdict == Verdict::none_in_catalogue);
    if (is_named(result.cases[c.injected], c.truth)) told_none.count(c.verdict == Verdict::none_in_catalogue);
  }
  if (seen.of > 0) rates.insert(rates.end(), {seen, none, told_none, misnamed, outside});
}

void count_motion(const SelftestResult& result, std::vector<Rate>& rates) {
  Rate as_sensor{"people's motion, in the catalogue or not: called by a name of optics or electronics"};
  for (const InjectedCase& c : result.cases) {
    const bool is_catalogued = c.kind == CaseKind::one || c.kind == CaseKind::left_out;
    if (!is_catalogued || effects::find(c.truth).info.family != effects::Family::motion) continue;
    const bool is_sensor = c.family == effects::Family::optics || c.family == effects::Family::electronics;
    as_sensor.count(c.verdict == Verdict::named && is_sensor);
  }
  if (as_sensor.of > 0) rates.push_back(as_sensor);
}

void count_pairs(const SelftestResult& result, std::vector<Rate>& rates) {
  Rate one{"two effects, first look: one or both in the set, given a disagreement"},
      none{"two effects, first look: no single effect will do, given a disagreement"},
      wrong{"two effects, first look: one wrong name"};
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::two) continue;
    const auto is_hidden = [&](const std::string& name) {
      return std::ranges::find(c.effects, name, &EffectSpec::name) != c.effects.end();
    };
    const bool any = std::ranges::any_of(c.named, is_hidden);
    wrong.count(c.verdict == Verdict::named && !any);
    if (!c.seen()) continue;
    one.count(any);
    none.count(c.verdict == Verdict::none_in_catalogue);
  }
  if (wrong.of > 0) rates.insert(rates.end(), {one, none, wrong});
}

bool names_other(const std::string& effect, const std::string& other) {
  return contains(effects::find(effect).info.confused_with, other);
}

const std::string& fingerprint_of(const std::string& effect) { return effects::find(effect).info.fingerprint; }

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
  for (std::size_t hypothesis = 0; hypothesis < reference.table.n_hypotheses(); ++hypothesis)
    result.hypotheses.push_back(reference.table.hypothesis_name(hypothesis));
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
  std::vector<Rate> rates;
  count_nulls(result, rates);
  count_injected(result, rates);
  count_left_out(result, rates);
  count_motion(result, rates);
  count_pairs(result, rates);
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
    pairs.push_back({a, b, rate, names_other(a, b) || names_other(b, a), fingerprint_of(a), fingerprint_of(b)});
  }
  std::ranges::stable_sort(pairs, std::ranges::greater{}, [](const ConfusedPair& pair) { return pair.rate.value(); });
  return pairs;
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
  for (std::vector<double>& row : shares) {
    double sum = 0.0;
    for (const double value : row) sum += value;
    for (double& value : row) value = sum > 0.0 ? value / sum : 0.0;
  }
  return shares;
}

}  // namespace pirsim::reconcile
