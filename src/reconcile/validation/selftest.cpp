#include "reconcile/validation/selftest.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>

#include "core/digest.hpp"
#include "core/parallel.hpp"
#include "effects/catalogue.hpp"
#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/locate.hpp"
#include "reconcile/inference/model_check.hpp"

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
  result.fitted = fitted;
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

/// n of the cases that are asked for, by index, evenly spread.
template <typename Asked>
std::vector<std::size_t> some_of(const std::vector<InjectedCase>& cases, std::size_t n, const Asked& asked) {
  std::vector<std::size_t> all, chosen;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (asked(cases[i])) all.push_back(i);
  }
  n = std::min(n, all.size());
  for (std::size_t k = 0; k < n; ++k) chosen.push_back(all[k * all.size() / n]);
  return chosen;
}

bool has_right_name(const InjectedCase& c) { return c.kind == CaseKind::one && is_named(c, c.truth); }
bool has_name_though(CaseKind kind, const InjectedCase& c) { return c.kind == kind && c.verdict == Verdict::named; }

/// Which datasets are judged on held-out trials, by index.
std::vector<std::size_t> to_verify(const std::vector<InjectedCase>& cases, std::size_t n_right) {
  std::vector<std::size_t> chosen = some_of(
      cases, cases.size(), [](const InjectedCase& c) { return c.kind == CaseKind::nothing && !c.named.empty(); });
  std::ranges::copy(some_of(cases, n_right, has_right_name), std::back_inserter(chosen));
  return chosen;
}

void verify_some(const ReferenceStudy& reference, const SeenRows& seen, const std::vector<InjectedDataset>& injected,
                 const SelftestSettings& settings, const Context& context, std::vector<InjectedCase>& cases) {
  const std::vector<std::size_t> chosen = to_verify(cases, settings.n_verified), trials = all_trials(reference.frame);
  if (chosen.empty() || trials.size() < 2) return;  // of one trial nothing can be held out
  context.begin({Stage::What::searching_anew, {}, chosen.size()});
  std::vector<Claim> claims;
  for (const std::size_t i : chosen) {
    const std::vector<std::string>& named = cases[i].named;
    claims.push_back({{{&reference, injected[cases[i].injected].statistics, named.front(), seen}}, named});
  }
  const Settings& analysis = settings.analysis;
  const Folds folds = usual_folds(sha256(reference.key), trials, reference.shape.kind);
  std::vector<Verification> found =
      verify(claims, folds, {analysis.alpha, analysis.verify_realizations}, context, [&](std::size_t done) {
        context.begin({Stage::What::verified, {}, done, claims.size()});
      });

  for (std::size_t k = 0; k < chosen.size(); ++k) cases[chosen[k]].verification = std::move(found[k]);
}

/// Can the model with the effect named have made the data?
void apply_some(const ReferenceStudy& reference, const FeatureMap& map, const std::vector<InjectedDataset>& injected,
                const SelftestSettings& settings, const Context& context, std::vector<InjectedCase>& cases) {
  std::vector<std::size_t> chosen = some_of(cases, settings.n_verified, has_right_name);
  for (const CaseKind kind : {CaseKind::left_out, CaseKind::out_of_catalogue}) {
    std::ranges::copy(some_of(cases, settings.n_verified, [&](const auto& c) { return has_name_though(kind, c); }),
                      std::back_inserter(chosen));
  }
  if (chosen.empty()) return;
  const Settings& analysis = settings.analysis;
  const double level = level_with(1, analysis.alpha);
  std::vector<PatchedModel> models;
  for (const std::size_t i : chosen)
    models.push_back({std::span(&*cases[i].fitted, 1), injected[cases[i].injected].statistics});
  const std::vector<GlobalP> p = p_with(models, reference, map, level, context, [&](std::size_t n, std::uint32_t in) {
    context.begin({Stage::What::checking_models, {}, n, models.size(), in});
  });

  for (std::size_t k = 0; k < chosen.size(); ++k)
    cases[chosen[k]].applied = Look{cases[chosen[k]].named, level, p[k].p};
}

/// Whether the table has the effect both in the variant left out and in others.
bool leaves_others(const Omission& left_out, const ReferenceTable& table) {
  bool covered = false, others = false;
  for (const TableRow& row : table.rows) {
    for (const EffectSpec& effect : row.effects)
      if (effect.name == left_out.effect) (left_out.covers(effect) ? covered : others) = true;
  }
  return covered && others;
}

/// What the catalogue is made to lack, one after the other.
std::vector<std::pair<CaseKind, Omission>> omissions_of(const ReferenceTable& table, LeaveOut leave_out) {
  std::vector<std::pair<CaseKind, Omission>> omissions;
  if (leave_out == LeaveOut::none) return omissions;
  for (const std::string& effect : table.effects) omissions.push_back({CaseKind::left_out, {effect, {}}});
  if (leave_out == LeaveOut::effects) return omissions;
  for (const std::string& effect : table.effects) {
    for (const effects::ChoiceInfo& choice : effects::find(effect).info.choices) {
      if (choice.kind != effects::ChoiceKind::variant) continue;
      for (const std::string& word : choice.words) {
        const Omission variant{effect, {choice.name, word}};
        if (leaves_others(variant, table)) omissions.push_back({CaseKind::left_out_variant, variant});
      }
    }
  }
  return omissions;
}

/// Of datasets with a disagreement: elsewhere no probability is told.
stats::Reliability reliability_of(const SelftestResult& result) {
  stats::Matrix<double> probabilities;
  std::vector<int> labels;
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::one || !c.seen()) continue;
    probabilities.append_row(std::span<const double>(c.probabilities));
    labels.push_back(static_cast<int>(std::ranges::find(result.hypotheses, c.truth) - result.hypotheses.begin()));
  }
  return labels.empty() ? stats::Reliability{} : stats::reliability(probabilities, labels);
}

/// Counts cases.
class Counter {
 public:
  explicit Counter(Counted what, Strength strength = Strength::none) {
    rate_.what = what;
    rate_.strength = strength;
  }
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
    rate.interval = rate.of == 0 ? Interval{0.0, 1.0} : stats::clopper_pearson(rate.hits, rate.of);
    return rate;
  }

 private:
  Rate rate_;
};

void count_nulls(const SelftestResult& result, std::vector<Rate>& rates) {
  Counter alarm(Counted::alarm_on_nothing), named(Counted::name_on_nothing);
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::nothing) continue;
    alarm.count(c.seen());
    named.count(c.verdict == Verdict::named);
  }
  rates.insert(rates.end(), {alarm.rate(), named.rate()});
}

void count_injected(const SelftestResult& result, std::vector<Rate>& rates) {
  Counter power(Counted::seen), exact(Counted::exact_name), named(Counted::any_name), right(Counted::right_of_names),
      family(Counted::right_family), wrong(Counted::wrong_name), wrong_family(Counted::wrong_family),
      in_set(Counted::truth_in_set), none(Counted::none_in_catalogue), coverage(Counted::parameters_covered);
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::one) continue;
    power.count(c.seen());
    wrong.count(c.verdict == Verdict::named && !is_named(c, c.truth));
    wrong_family.count(c.family.has_value() && c.family != effects::find(c.truth).info.family);
    coverage.add(c.n_covered, c.n_parameters);
    if (!c.seen()) continue;
    exact.count(is_named(c, c.truth));
    named.count(c.verdict == Verdict::named);
    if (c.verdict == Verdict::named) right.count(is_named(c, c.truth));
    family.count(c.family == effects::find(c.truth).info.family);
    in_set.count(contains(c.named, c.truth));
    none.count(c.verdict == Verdict::none_in_catalogue);
  }
  rates.insert(rates.end(), {power.rate(), exact.rate(), family.rate(), named.rate(), right.rate(), wrong.rate(),
                             wrong_family.rate(), in_set.rate(), none.rate(), coverage.rate()});
}

void count_verified(const SelftestResult& result, std::vector<Rate>& rates) {
  constexpr double nearly_all = 0.9;
  Counter shrunk(Counted::shrunk), closed(Counted::closed), most(Counted::most_closed),
      on_nulls(Counted::shrunk_on_nothing);
  for (const InjectedCase& c : result.cases) {
    if (c.kind == CaseKind::nothing) on_nulls.count(c.verification && c.verification->shrunk);
    if (c.kind != CaseKind::one || !c.verification) continue;
    shrunk.count(c.verification->shrunk);
    closed.count(c.verification->closed);
    const Verification& v = *c.verification;
    const bool nothing_to_close = v.n_trials > 0 && v.before.energy_score <= v.noise_floor;
    if (!nothing_to_close) most.count(v.share_closed >= nearly_all);
  }
  if (shrunk.rate().of > 0) rates.insert(rates.end(), {shrunk.rate(), closed.rate(), most.rate(), on_nulls.rate()});
}

void count_applied(const SelftestResult& result, std::vector<Rate>& rates) {
  constexpr std::array<std::pair<CaseKind, Counted>, 3> kinds{
      {{CaseKind::one, Counted::right_passes},
       {CaseKind::left_out, Counted::left_out_passes},
       {CaseKind::out_of_catalogue, Counted::out_of_catalogue_passes}}};
  for (const auto& [kind, what] : kinds) {
    Counter passes(what);

    for (const InjectedCase& c : result.cases) {
      if (c.kind == kind && c.applied) passes.count(c.applied->passes());
    }
    if (passes.rate().of > 0) rates.push_back(passes.rate());
  }
}

void count_out_of_catalogue(const SelftestResult& result, std::vector<Rate>& rates) {
  Counter seen(Counted::out_of_catalogue_seen), none(Counted::out_of_catalogue_none),
      misnamed(Counted::out_of_catalogue_named);
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::out_of_catalogue) continue;
    seen.count(c.seen());
    misnamed.count(c.verdict == Verdict::named);
    if (c.seen()) none.count(c.verdict == Verdict::none_in_catalogue);
  }
  if (seen.rate().of > 0) rates.insert(rates.end(), {seen.rate(), none.rate(), misnamed.rate()});
}

void count_left_out(const SelftestResult& result, std::vector<Rate>& rates) {
  Counter seen(Counted::left_out_seen), none(Counted::left_out_none), told_none(Counted::told_left_out_none),
      misnamed(Counted::left_out_named), outside(Counted::left_out_named_outside);
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
  if (seen.rate().of > 0)
    rates.insert(rates.end(), {seen.rate(), none.rate(), told_none.rate(), misnamed.rate(), outside.rate()});
}

void count_variants(const SelftestResult& result, std::vector<Rate>& rates) {
  Counter named(Counted::variant_named);
  for (const InjectedCase& c : result.cases) {
    if (c.kind == CaseKind::left_out_variant && is_named(result.cases[c.injected], c.truth))
      named.count(is_named(c, c.truth));
  }
  if (named.rate().of > 0) rates.push_back(named.rate());
}

void count_motion(const SelftestResult& result, std::vector<Rate>& rates) {
  Counter as_sensor(Counted::motion_as_sensor);
  for (const InjectedCase& c : result.cases) {
    const bool is_catalogued = c.kind == CaseKind::one || c.kind == CaseKind::left_out;
    if (!is_catalogued || effects::find(c.truth).info.family != effects::Family::motion) continue;
    const bool is_sensor = c.family == effects::Family::optics || c.family == effects::Family::electronics;
    as_sensor.count(c.verdict == Verdict::named && is_sensor);
  }
  if (as_sensor.rate().of > 0) rates.push_back(as_sensor.rate());
}

void count_beyond(const SelftestResult& result, std::vector<Rate>& rates) {
  Counter exact(Counted::beyond_exact), wrong(Counted::beyond_wrong);
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::beyond_prior) continue;
    wrong.count(c.verdict == Verdict::named && !is_named(c, c.truth));
    if (c.seen()) exact.count(is_named(c, c.truth));
  }
  if (wrong.rate().of > 0) rates.insert(rates.end(), {exact.rate(), wrong.rate()});
}

void count_pairs(const SelftestResult& result, std::vector<Rate>& rates) {
  Counter one(Counted::pair_in_set), none(Counted::pair_none), wrong(Counted::pair_wrong);
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::two) continue;
    const auto is_hidden = [&](const std::string& name) {
      return std::ranges::any_of(c.effects, [&](const EffectSpec& effect) { return effect.name == name; });
    };
    const bool any = std::ranges::any_of(c.named, is_hidden);
    wrong.count(c.verdict == Verdict::named && !any);
    if (!c.seen()) continue;
    one.count(any);
    none.count(c.verdict == Verdict::none_in_catalogue);
  }
  if (wrong.rate().of > 0) rates.insert(rates.end(), {one.rate(), none.rate(), wrong.rate()});
}

}  // namespace

std::string_view name(CaseKind kind) noexcept {
  constexpr std::array<std::string_view, 7> names{"nothing",          "one", "beyond_prior",    "left_out",
                                                  "left_out_variant", "two", "out_of_catalogue"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view name(Strength strength) noexcept {
  constexpr std::array<std::string_view, 5> names{"none", "weak", "medium", "strong", "beyond"};
  return names[static_cast<std::size_t>(strength)];
}

SelftestResult judge(const ReferenceStudy& reference, const std::vector<InjectedDataset>& injected,
                     const SelftestSettings& settings, const Context& context) {
  const Settings& analysis = settings.analysis;
  const auto view = reference.view(all_trials(reference.frame), context.threads);
  const auto analyst_without = [&](const Omission& left_out) {
    return Analyst(view, {analysis.alpha, analysis.trees, left_out}, context);
  };
  SelftestResult result;
  for (std::size_t hypothesis = 0; hypothesis < reference.table.n_hypotheses(); ++hypothesis)
    result.hypotheses.push_back(reference.table.hypothesis_name(hypothesis));
  context.begin({Stage::What::judging});
  std::vector<std::size_t> all(injected.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  judge_all(reference, analyst_without({}), injected, all, {}, context.threads, result.cases);
  result.reliability = reliability_of(result);
  if (settings.n_verified > 0)
    verify_some(reference, seen_rows(*view, analysis.alpha), injected, settings, context, result.cases);
  for (const auto& [kind, omission] : omissions_of(reference.table, settings.leave_out)) {
    const std::string& variant = omission.variant.word;
    context.begin({Stage::What::judging_without, {omission.effect + (variant.empty() ? "" : " " + variant)}});
    std::vector<std::size_t> own;
    for (const std::size_t i : all) {
      if (injected[i].kind == CaseKind::one && omission.covers(injected[i].effects.front())) own.push_back(i);
    }
    judge_all(reference, analyst_without(omission), injected, own, kind, context.threads, result.cases);
  }
  apply_some(reference, view->map(), injected, settings, context, result.cases);
  return result;
}

SelftestResult selftest(const SceneSpec& scene, const ScriptSpec& script, const SelftestSettings& settings,
                        const Context& context) {
  const ReferenceStudy reference = make_reference_study(
      scene, script, settings.analysis,
      [&](const StudyFrame& frame, std::span<const Series> pilot) {
        return full_shape(frame, settings.kind, settings.n_replicates, pilot);
      },
      context);
  return judge(reference, inject(reference, settings, context), settings, context);
}

std::vector<Rate> rates_of(const SelftestResult& result) {
  std::vector<Rate> rates;
  count_nulls(result, rates);
  count_injected(result, rates);
  count_verified(result, rates);
  count_applied(result, rates);
  count_left_out(result, rates);
  count_variants(result, rates);
  count_motion(result, rates);
  count_out_of_catalogue(result, rates);
  count_beyond(result, rates);
  count_pairs(result, rates);
  return rates;
}

std::vector<Rate> power_of(const SelftestResult& result, const std::string& effect) {
  std::vector<Rate> rates;
  for (const Strength strength : {Strength::weak, Strength::medium, Strength::strong}) {
    Counter seen(Counted::seen, strength), found(Counted::seen_and_in_set, strength);
    for (const InjectedCase& c : result.cases) {
      if (c.kind != CaseKind::one || c.truth != effect || c.strength != strength) continue;
      seen.count(c.seen());
      found.count(contains(c.named, effect));
    }
    rates.push_back(seen.rate());
    rates.push_back(found.rate());
  }
  return rates;
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
