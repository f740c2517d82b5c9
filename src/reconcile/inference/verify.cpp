#include "reconcile/inference/verify.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "model/core/parallel.hpp"
#include "model/core/text.hpp"
#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/fit.hpp"
#include "reconcile/inference/locate.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t first_verify_realization = 1U << 24U;  ///< realizations that no table has seen
constexpr std::size_t most_own_scores = 40;  ///< members whose distance to the others makes the noise floor
constexpr double sign_level = 0.05;          ///< of ten trials nine must be better

using Patch = std::vector<EffectSpec>;

/// What a fold found without its trials.
struct FoldPatches {
  Patch patch, placebo;
  std::string names, placebo_name;
};

std::vector<std::size_t> all_but(const std::vector<std::size_t>& held_out, const std::vector<std::size_t>& all) {
  std::vector<std::size_t> others;
  std::ranges::set_difference(all, held_out, std::back_inserter(others));
  return others;
}

/// Finds effects again, step by step, with the given trials only.
class FoldSearch {
 public:
  FoldSearch(std::vector<std::size_t> trials, const VerifySettings& settings, const Context& context)
      : trials_(std::move(trials)), settings_(settings), context_(context) {}

  [[nodiscard]] FoldPatches search(const Claim& claim) {
    FoldPatches found;
    for (const AppliedEffect& step : claim.steps) {
      learn(step);
      const std::vector<double> probabilities = learnt_->probabilities.of(step.observed);
      const std::size_t best = likeliest_hypothesis(probabilities, [](std::size_t) { return true; });
      if (best == 0) break;
      if (found.patch.empty()) find_placebo(claim, probabilities, found);
      found.patch.push_back(fitted(best, step));
      const std::string name = step.reference->table.hypothesis_name(best);
      found.names += (found.names.empty() ? "" : " + ") + name;
      if (name != step.effect) break;  // the later tables are of another model
    }
    if (found.names.empty()) found.names = "nothing";
    return found;
  }

 private:
  /// The table as it looks without the trials that are held out.
  struct Learnt {
    Learnt(const AppliedEffect& step, const std::vector<std::size_t>& trials, const VerifySettings& settings,
           const Context& context)
        : reference(step.reference),
          map(reference->map(trials)),
          probabilities(reference->table, map, step.seen,
                        {.trees = {.trees = settings.trees, .seed = context.seed, .threads = context.threads},
                         .threads = context.threads}),
          fitter(reference->source.scene, reference->table, map, step.seen, context) {}
    Learnt(const Learnt&) = delete;  // the others point to the map
    Learnt& operator=(const Learnt&) = delete;

    const ReferenceStudy* reference;
    FeatureMap map;
    HypothesisProbabilities probabilities;
    EffectFitter fitter;
  };

  /// One is kept: it takes long and much memory, and claims about the same study come one after the other.
  void learn(const AppliedEffect& step) {
    if (!learnt_ || learnt_->reference != step.reference) learnt_.emplace(step, trials_, settings_, context_);
  }
  [[nodiscard]] EffectSpec fitted(std::size_t hypothesis, const AppliedEffect& step) const {
    return learnt_->fitter.fit(hypothesis, step.observed).effect;
  }
  void find_placebo(const Claim& claim, std::span<const double> probabilities, FoldPatches& found) const {
    std::set<effects::Family> families;
    for (const AppliedEffect& step : claim.steps) families.insert(effects::find(step.effect).info.family);
    for (const std::string& rival : claim.rivals) families.insert(effects::find(rival).info.family);
    const AppliedEffect& plain = claim.steps.front();
    const ReferenceTable& table = plain.reference->table;
    const std::size_t other = likeliest_hypothesis(probabilities, [&](std::size_t hypothesis) {
      return !families.contains(effects::find(table.hypothesis_name(hypothesis)).info.family);
    });
    if (other == 0) return;
    found.placebo = {fitted(other, plain)};
    found.placebo_name = table.hypothesis_name(other);
  }

  std::vector<std::size_t> trials_;
  const VerifySettings& settings_;
  const Context& context_;
  std::optional<Learnt> learnt_;
};

/// Datasets of the same realizations (n_realizations x n_statistics): of the plain model, and with each fold's patch or
/// placebo in the trials that the fold holds out. Realizations in which people can't get about with it are left out.
struct HeldOutEnsembles {
  stats::Matrix<float> before, after, placebo;
};

/// None if people can hardly get about with the patches.
std::optional<HeldOutEnsembles> simulate(const ReferenceStudy& reference, const Folds& folds,
                                         const std::vector<FoldPatches>& found, const VerifySettings& settings,
                                         unsigned threads) {
  const int n = reference.shape.n_replicates;
  const auto statistics = [&](const std::vector<Series>& runs) {
    return statistics_of(reference.frame, reference.shape, reference.table.profile, runs);
  };
  const auto in_folds = [&](const SimulatedRealization& realization,
                            Patch FoldPatches::*which) -> std::optional<std::vector<Series>> {
    std::vector<Series> all;
    for (std::size_t f = 0; f < folds.size(); ++f) {
      auto own = realization.with_effects(found[f].*which, 0, n, folds[f]);
      // A placebo with which people can't get about explains nothing: the plain model is taken in that fold.
      if (!own && which == &FoldPatches::placebo) own = realization.with_effects({}, 0, n, folds[f]);
      if (!own) return std::nullopt;
      std::ranges::move(*own, std::back_inserter(all));
    }
    return all;
  };
  using Rows = std::vector<std::vector<float>>;  // before, after, placebo
  HeldOutEnsembles all;
  ordered_parallel<Rows>(
      std::max(settings.n_realizations, static_cast<std::uint32_t>(std::ceil(1.0 / settings.alpha))), threads,
      [&](std::size_t i) -> Rows {
        const SimulatedRealization realization(reference.source, reference.frame,
                                               first_verify_realization + static_cast<std::uint32_t>(i), n);
        const auto after = in_folds(realization, &FoldPatches::patch);
        if (!after) return {};
        return {statistics(realization.plain(0, n)), statistics(*after),
                statistics(*in_folds(realization, &FoldPatches::placebo))};
      },
      [&](Rows& rows) {
        if (rows.empty()) return;
        all.before.append_row(rows[0]);
        all.after.append_row(rows[1]);
        all.placebo.append_row(rows[2]);
      });
  if (all.after.rows() < 2) return std::nullopt;
  return all;
}

/// Mean energy score of an ensemble's own members, each against the others.
double own_score(const stats::Matrix<double>& ensemble) {
  double sum = 0.0;
  const std::size_t n = std::min(most_own_scores, ensemble.rows());
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::size_t> others = stats::numbers_to(ensemble.rows());
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    sum += stats::energy_score(ensemble.select_rows(others), ensemble.row(i)) / static_cast<double>(n);
  }
  return sum;
}

/// Adds one trial's cells to a gap.
void add_cells(const StudyFrame& frame, const stats::Matrix<float>& ensemble, std::span<const float> measured,
               std::size_t trial, Gap& gap) {
  for (std::size_t sensor = 0; sensor < frame.sensors.size(); ++sensor) {
    const double real = seconds_of(DatasetStatistics(frame, measured), trial, sensor);
    const std::vector<double> seconds = seconds_of(frame, ensemble, trial, sensor);
    if (std::isnan(real) || seconds.empty()) continue;
    gap.area_s += stats::area_between(seconds, std::span(&real, 1));
    gap.cells_outside += real < stats::quantile(seconds, 0.025) || real > stats::quantile(seconds, 0.975) ? 1 : 0;
    ++gap.n_cells;
  }
}

/// Scores of the held-out trials, one after the other.
class Judge {
 public:
  Judge(const AppliedEffect& plain, const HeldOutEnsembles& ensembles, double alpha, const Context& context)
      : reference_(*plain.reference),
        measured_(plain.observed),
        ensembles_(ensembles),
        alpha_(alpha),
        context_(context) {}

  void add_trial(std::size_t trial, Verification& result) {
    const FeatureMap map = reference_.map({trial});
    if (map.envelope_columns().empty()) return;
    const auto tested = [&](const stats::Matrix<float>& all) {
      return tested_features(map, map.features(all, context_.threads));
    };
    const std::vector<double> real = tested_features(map, map.features(measured_));
    const stats::Matrix<double> after = tested(ensembles_.after);
    const double score_before = stats::energy_score(tested(ensembles_.before), real);
    const double score_after = stats::energy_score(after, real);
    result.before.energy_score += score_before;
    result.after.energy_score += score_after;
    result.placebo += stats::energy_score(tested(ensembles_.placebo), real);
    result.noise_floor += own_score(after);
    drops_.push_back(score_before - score_after);
    add_cells(reference_.frame, ensembles_.before, measured_, trial, result.before);
    add_cells(reference_.frame, ensembles_.after, measured_, trial, result.after);
  }

  /// Means, intervals and tests over all trials that were added.
  void sum_up(const std::vector<std::size_t>& held_out, Verification& result) const {
    const auto n = static_cast<double>(drops_.size());
    for (double* sum : {&result.before.energy_score, &result.after.energy_score, &result.placebo, &result.noise_floor})
      *sum /= n;
    for (Gap* gap : {&result.before, &result.after})
      gap->area_s /= static_cast<double>(std::max<std::size_t>(1, gap->n_cells));
    const FeatureMap map = reference_.map(held_out);
    const auto test = [&](const stats::Matrix<float>& ensemble, Gap& gap) {
      const Location seen = locate(reference_.frame, map, ensemble, measured_, alpha_, context_);
      gap.p = seen.p;
      gap.least_p = seen.least_p();
    };
    test(ensembles_.before, result.before);
    test(ensembles_.after, result.after);
    result.n_trials = drops_.size();
    result.n_better = static_cast<std::size_t>(std::ranges::count_if(drops_, [](double d) { return d > 0.0; }));
    const auto worse = std::ranges::count_if(drops_, [](double d) { return d < 0.0; });
    result.sign_p = stats::sign_test_greater(result.n_better, static_cast<std::size_t>(worse));
    const double closable = result.before.energy_score - result.noise_floor;
    if (closable > 0.0) result.share_closed = (result.before.energy_score - result.after.energy_score) / closable;
    if (drops_.size() > 1) result.gain = stats::mean_interval(drops_);
  }

 private:
  const ReferenceStudy& reference_;
  std::span<const float> measured_;
  const HeldOutEnsembles& ensembles_;
  double alpha_;
  const Context& context_;
  std::vector<double> drops_;
};

Verification judge_claim(const Claim& claim, const Folds& folds, const std::vector<std::size_t>& held_out,
                         const std::vector<FoldPatches>& found, const VerifySettings& settings,
                         const Context& context) {
  const AppliedEffect& plain = claim.steps.front();
  Verification result;
  result.n_folds = folds.size();
  for (const FoldPatches& fold : found) {
    result.names.push_back(fold.names);
    result.patches.push_back(fold.patch);
    if (result.placebo_effect.empty()) result.placebo_effect = fold.placebo_name;
  }
  const std::optional<HeldOutEnsembles> ensembles = simulate(*plain.reference, folds, found, settings, context.threads);
  if (!ensembles) return result;
  Judge judge(plain, *ensembles, settings.alpha, context);
  for (const std::size_t trial : held_out) judge.add_trial(trial, result);
  judge.sum_up(held_out, result);
  decide(result, plain.reference->shape.kind, settings.alpha);
  return result;
}

}  // namespace

void decide(Verification& result, Measured::Kind kind, double alpha) {
  const bool enough_signs = kind == Measured::Kind::series || result.sign_p <= sign_level;  // sums say little a trial
  result.shrunk = result.gain.low > 0.0 && result.placebo > result.after.energy_score && enough_signs;
  result.refused = result.before.p <= alpha;
  result.closed = result.shrunk && result.refused && result.after.p > alpha;
}

Folds usual_folds(std::string_view digest, std::vector<std::size_t> trials, Measured::Kind kind) {
  constexpr std::size_t usual = 5;
  const std::size_t n_folds = kind == Measured::Kind::sums ? trials.size() : usual;
  return folds_of(digest, std::move(trials), n_folds);
}

Folds folds_of(std::string_view digest, std::vector<std::size_t> trials, std::size_t n_folds) {
  std::uint64_t seed = 0;
  for (const char c : digest.substr(0, 16)) {
    seed = seed * 16 + static_cast<std::uint64_t>(c <= '9' ? c - '0' : c - 'a' + 10);
  }
  Stream stream({seed, 0, 0, Purpose::analysis});
  for (std::size_t i = trials.size(); i > 1; --i)
    std::swap(trials[i - 1], trials[stream.index(static_cast<std::uint32_t>(i))]);
  Folds folds(std::min(n_folds, trials.size()));
  for (std::size_t i = 0; i < trials.size(); ++i) folds[i % folds.size()].push_back(trials[i]);
  for (auto& fold : folds) std::ranges::sort(fold);
  return folds;
}

std::vector<std::size_t> holdout_of(const std::string& asked, const StudyFrame& frame, const Measured& measured) {
  if (asked.empty()) return {};
  constexpr std::size_t fewest = 2;
  const std::vector<std::size_t> all = measured.trials();
  std::vector<std::size_t> trials;
  double share = 0.0;
  const auto [end, fault] = std::from_chars(asked.data(), asked.data() + asked.size(), share);
  const bool is_number = fault == std::errc() && end == asked.data() + asked.size();
  if (is_number && !(share > 0.0 && share < 1.0) && std::ranges::find(frame.trials, asked) == frame.trials.end())
    throw Error(ErrorCode::usage, "--holdout: '" + asked + "' is not a share between 0 and 1");
  if (is_number && share > 0.0 && share < 1.0) {
    const auto n = static_cast<std::size_t>(std::lround(share * static_cast<double>(all.size())));
    for (const auto& fold : folds_of(measured.digest, all, all.size())) {
      if (trials.size() < std::max(n, fewest)) trials.push_back(fold.front());
    }
  } else {
    std::istringstream names(asked);
    for (std::string name; std::getline(names, name, ',');) {
      const auto known = std::ranges::find(frame.trials, name);
      if (known == frame.trials.end()) {
        throw Error(ErrorCode::usage, "--holdout: '" + name +
                                          "' is neither a trial of the study nor a share between 0 and 1" +
                                          near_or_all(name, frame.trials));
      }
      trials.push_back(static_cast<std::size_t>(known - frame.trials.begin()));
      if (!std::ranges::binary_search(all, trials.back()))
        throw Error(ErrorCode::usage, "--holdout: nothing of trial '" + name + "' was measured");
    }
  }
  std::ranges::sort(trials);
  trials.erase(std::unique(trials.begin(), trials.end()), trials.end());
  if (trials.size() < fewest || trials.size() + fewest > all.size()) {
    throw Error(ErrorCode::usage, "--holdout: of " + std::to_string(all.size()) + " measured trials, " +
                                      std::to_string(trials.size()) + " would be held out; two or more must be, and " +
                                      "two or more left");
  }
  return trials;
}

std::vector<Verification> verify(std::span<const Claim> claims, const Folds& folds, const VerifySettings& settings,
                                 const Context& context) {
  std::vector<std::vector<FoldPatches>> found(claims.size());
  std::vector<std::size_t> held_out;
  for (const auto& fold : folds) {
    held_out.insert(held_out.end(), fold.begin(), fold.end());
    FoldSearch search(all_but(fold, all_trials(claims.front().steps.front().reference->frame)), settings, context);
    for (std::size_t i = 0; i < claims.size(); ++i) found[i].push_back(search.search(claims[i]));
  }
  std::ranges::sort(held_out);
  std::vector<Verification> results;
  for (std::size_t i = 0; i < claims.size(); ++i)
    results.push_back(judge_claim(claims[i], folds, held_out, found[i], settings, context));
  return results;
}

}  // namespace pirsim::reconcile
