#include "pirsim/reconcile/verify.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pirsim/core/parallel.hpp"
#include "pirsim/effects/catalogue.hpp"
#include "pirsim/reconcile/analyst.hpp"
#include "pirsim/stats/envelope.hpp"
#include "pirsim/stats/scores.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t first_verify_world = 1U << 24U;  ///< worlds that no table has seen
constexpr std::size_t most_members = 200;                ///< of an ensemble

using Patch = std::vector<EffectSpec>;  ///< empty: the plain model

/// Datasets of several patched models in the same worlds.
std::vector<stats::Matrix<float>> simulate(const WorldSource& source, const StudyFrame& frame, const DataShape& shape,
                                           const Profile& profile, const std::vector<Patch>& patches,
                                           const VerifySettings& settings) {
  using Rows = std::vector<std::vector<float>>;  // of one world, empty where people couldn't get about
  std::vector<stats::Matrix<float>> all(patches.size());
  ordered_parallel<Rows>(
      settings.n_worlds, settings.threads,
      [&](std::size_t i) {
        const SimulatedWorld world(source, frame, first_verify_world + static_cast<std::uint32_t>(i),
                                   shape.n_replicates);
        Rows rows;
        for (const Patch& patch : patches) {
          const auto data = world.with_effects(patch, 0, shape.n_replicates);
          rows.push_back(data ? statistics_of(frame, shape, profile, *data) : std::vector<float>{});
        }
        return rows;
      },
      [&](Rows& rows) {
        for (std::size_t p = 0; p < rows.size(); ++p) {
          if (!rows[p].empty()) all[p].append_row(std::span<const float>(rows[p]));
        }
      });
  return all;
}

/// What one trial's data look like: scaled features that the global test looks at.
class TrialView {
 public:
  TrialView(const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge, const stats::Matrix<float>& plain,
            std::size_t trial)
      : map_(frame, knowledge, plain, {trial}) {}
  [[nodiscard]] bool empty() const { return map_.envelope_columns().empty(); }
  [[nodiscard]] std::vector<double> look(std::span<const float> statistics) const {
    const std::vector<float> features = map_.features(statistics);
    std::vector<double> values;
    for (const std::size_t column : map_.envelope_columns()) values.push_back(static_cast<double>(features[column]));
    return values;
  }
  [[nodiscard]] stats::Matrix<double> look(const stats::Matrix<float>& datasets) const {
    stats::Matrix<double> all;
    for (std::size_t row = 0; row < std::min(datasets.rows(), most_members); ++row) {
      all.append_row(std::span<const double>(look(datasets.row(row))));
    }
    return all;
  }

 private:
  FeatureMap map_;
};

/// Mean energy score of an ensemble's own members, each against the others.
double own_score(const stats::Matrix<double>& ensemble) {
  double sum = 0.0;
  constexpr std::size_t tried = 20;
  const std::size_t n = std::min(tried, ensemble.rows());
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::size_t> others;
    for (std::size_t row = 0; row < ensemble.rows(); ++row) {
      if (row != i) others.push_back(row);
    }
    sum += stats::energy_score(ensemble.select_rows(others), ensemble.row(i)) / static_cast<double>(n);
  }
  return sum;
}

/// Adds one trial's cells to a gap.
void add_cells(const StudyFrame& frame, const stats::Matrix<float>& ensemble, std::span<const float> measured,
               std::size_t trial, Gap& gap) {
  for (std::size_t sensor = 0; sensor < frame.sensors.size(); ++sensor) {
    const std::size_t column = cell_index(frame, trial, sensor, CellStatistic::seconds);
    if (std::isnan(measured[column])) continue;
    std::vector<double> seconds;
    for (std::size_t row = 0; row < ensemble.rows(); ++row)
      seconds.push_back(static_cast<double>(ensemble(row, column)));
    const auto real = static_cast<double>(measured[column]);
    gap.area_s += stats::area_between(seconds, std::span(&real, 1));
    gap.cells_outside += real < stats::quantile(seconds, 0.025) || real > stats::quantile(seconds, 0.975) ? 1 : 0;
    ++gap.n_cells;
  }
}

/// p of the global test over held-out trials, each foretold by the model of its fold.
double global_p(const std::vector<stats::Matrix<double>>& ensembles, const std::vector<std::vector<double>>& observed,
                std::uint64_t seed, unsigned threads) {
  std::size_t n = most_members;
  for (const auto& ensemble : ensembles) n = std::min(n, ensemble.rows());
  stats::Matrix<double> joined;
  for (std::size_t row = 0; row < n; ++row) {
    std::vector<double> values;
    for (const auto& ensemble : ensembles)
      values.insert(values.end(), ensemble.row(row).begin(), ensemble.row(row).end());
    joined.append_row(std::span<const double>(values));
  }
  std::vector<double> real;
  for (const auto& values : observed) real.insert(real.end(), values.begin(), values.end());
  return stats::global_envelope_test(
             real, joined, {0.05, stats::PointwiseRank::continuous, stats::Alternative::two_sided, seed, threads})
      .p;
}

void finish(Gap& gap, std::size_t n_trials) {
  gap.energy_score /= static_cast<double>(n_trials);
  if (gap.n_cells > 0) gap.area_s /= static_cast<double>(gap.n_cells);
}

}  // namespace

std::vector<std::size_t> folds_of(std::string_view digest, std::size_t n_trials, std::size_t n_folds) {
  std::uint64_t seed = 0;
  for (const char c : digest.substr(0, 16)) {
    seed = seed * 16 + static_cast<std::uint64_t>(c <= '9' ? c - '0' : c - 'a' + 10);
  }
  Stream stream({seed, 0, 0, Purpose::analysis});
  std::vector<std::size_t> order(n_trials), folds(n_trials);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = n_trials; i > 1; --i)
    std::swap(order[i - 1], order[stream.index(static_cast<std::uint32_t>(i))]);
  for (std::size_t i = 0; i < n_trials; ++i) folds[order[i]] = i % n_folds;
  return folds;
}

Verification verify(const WorldSource& source, const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge,
                    const DataShape& shape, const ReferenceTable& table, std::span<const float> measured,
                    const Outcome& outcome, const VerifySettings& settings) {
  Verification result;
  const std::size_t n_trials = frame.trials.size();
  if (n_trials < 2) return result;  // nothing can be held out
  result.n_folds = std::min(settings.n_folds, n_trials);
  const std::vector<std::size_t> fold_of = folds_of(settings.digest, n_trials, result.n_folds);
  const auto family = [&](std::size_t entry) { return effects::find(table.effects[entry - 1]).info.family; };
  const effects::Family named_family = effects::find(outcome.named.front()).info.family;

  std::vector<Patch> patches{{}};  // the plain model, then patch and placebo of every fold
  for (std::size_t f = 0; f < result.n_folds; ++f) {
    std::vector<std::size_t> trials;
    for (std::size_t t = 0; t < n_trials; ++t) {
      if (fold_of[t] != f) trials.push_back(t);
    }
    const Analyst analyst(frame, knowledge, table, trials,
                          {settings.alpha, settings.seed, settings.threads, settings.trees});
    const std::size_t best = analyst.likeliest(measured, [](std::size_t) { return true; });
    const std::size_t other = analyst.likeliest(measured, [&](std::size_t e) { return family(e) != named_family; });
    result.names.push_back(table.entry_name(best));
    patches.push_back(best == 0 ? Patch{} : Patch{analyst.fit(best, measured).effect});
    patches.push_back(other == 0 ? Patch{} : Patch{analyst.fit(other, measured).effect});
    if (f == 0 && other != 0) result.placebo_effect = table.entry_name(other);
  }
  const auto ensembles = simulate(source, frame, shape, table.profile, patches, settings);

  std::vector<double> drops;
  std::vector<stats::Matrix<double>> seen_before, seen_after;
  std::vector<std::vector<double>> seen_real;
  const stats::Matrix<float> plain = table.statistics.select_rows(rows_of(table, 0, Part::training));
  for (std::size_t t = 0; t < n_trials; ++t) {
    const TrialView view(frame, knowledge, plain, t);
    if (view.empty()) continue;
    const auto& after = ensembles[1 + 2 * fold_of[t]];
    const auto& placebo = ensembles[2 + 2 * fold_of[t]];
    const std::vector<double> real = view.look(measured);
    seen_before.push_back(view.look(ensembles[0]));
    seen_after.push_back(view.look(after));
    seen_real.push_back(real);
    const double score_before = stats::energy_score(seen_before.back(), real);
    const double score_after = stats::energy_score(seen_after.back(), real);
    result.before.energy_score += score_before;
    result.after.energy_score += score_after;
    result.placebo += stats::energy_score(view.look(placebo), real);
    result.noise_floor += own_score(seen_after.back());
    drops.push_back(score_before - score_after);
    add_cells(frame, ensembles[0], measured, t, result.before);
    add_cells(frame, after, measured, t, result.after);
  }
  finish(result.before, drops.size());
  finish(result.after, drops.size());
  result.placebo /= static_cast<double>(drops.size());
  result.noise_floor /= static_cast<double>(drops.size());
  result.before.p = global_p(seen_before, seen_real, settings.seed, settings.threads);
  result.after.p = global_p(seen_after, seen_real, settings.seed, settings.threads);
  if (drops.size() > 1) {
    result.gain = stats::block_bootstrap(drops.size(),
                                         [&](std::span<const std::size_t> blocks) {
                                           double sum = 0.0;
                                           for (const std::size_t block : blocks)
                                             sum += drops[block] / static_cast<double>(blocks.size());
                                           return sum;
                                         },
                                         {0.95, 2000, stats::BootstrapKind::bca, settings.seed, settings.threads});
  }
  const double closable = result.before.energy_score - result.noise_floor;
  if (closable > 0.0) result.share_closed = (result.before.energy_score - result.after.energy_score) / closable;
  result.shrunk = result.gain.low > 0.0 && result.placebo > result.after.energy_score;
  result.closed = result.shrunk && result.after.p > settings.alpha;
  return result;
}

}  // namespace pirsim::reconcile
