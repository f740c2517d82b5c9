#include "reconcile/inference/fit.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "reconcile/inference/flat_scale.hpp"
#include "reconcile/inference/locate.hpp"
#include "reconcile/inference/point_estimate.hpp"

namespace pirsim::reconcile {
namespace {

using effects::ParameterInfo;

constexpr double confidence = 0.9;
constexpr double accepted_share = 0.3;
constexpr std::size_t fewest_accepted = 40;    ///< or all, in a small table
constexpr std::size_t fewest_neighbours = 80;  ///< whose intervals are tried; or all

/// The posterior at an estimate, from these held-back datasets.
stats::AbcPosterior posterior_of(const PointEstimator& estimator, std::span<const double> estimate,
                                 const std::vector<std::size_t>& rows) {
  const auto n = static_cast<double>(rows.size());
  const double share = std::clamp(static_cast<double>(fewest_accepted) / n, accepted_share, 1.0);
  return stats::abc_posterior(estimator.parameters().select_rows(rows), estimator.estimates().select_rows(rows),
                              estimate, {share, estimator.bounds()});
}

/// Those of these datasets whose estimates lie nearest to the measured one, by the estimates' own scatter.
std::vector<std::size_t> nearest_of(const PointEstimator& estimator, std::span<const double> estimate,
                                    const std::vector<std::size_t>& rows) {
  const stats::Matrix<double> estimates = estimator.estimates().select_rows(rows);
  std::vector<std::pair<double, std::size_t>> near(rows.size());
  for (std::size_t i = 0; i < near.size(); ++i) near[i].second = rows[i];
  for (std::size_t p = 0; p < estimate.size(); ++p) {
    std::vector<double> values;
    for (std::size_t i = 0; i < estimates.rows(); ++i) values.push_back(estimates(i, p));
    const double scatter = stats::quantile(values, 0.84) - stats::quantile(values, 0.16) + 1e-12;
    for (std::size_t i = 0; i < near.size(); ++i)
      near[i].first += std::pow((estimates(i, p) - estimate[p]) / scatter, 2);
  }
  std::ranges::sort(near);
  near.resize(std::min(near.size(), std::max(fewest_neighbours, near.size() / 4)));
  std::vector<std::size_t> nearest;
  for (const auto& [distance, row] : near) nearest.push_back(row);
  return nearest;
}

std::vector<std::size_t> without(std::vector<std::size_t> rows, std::size_t row) {
  std::erase(rows, row);
  return rows;
}

/// How far beyond its interval's ends, as a share of the way from the median, a known truth lies.
double reach(const stats::AbcPosterior& posterior, std::size_t parameter, double truth) {
  const Interval interval = posterior.interval(parameter, confidence);
  const double median = posterior.quantile(parameter, 0.5);
  const double half = truth < median ? median - interval.low : interval.high - median;
  return std::abs(truth - median) / std::max(half, 1e-12);
}

/// (n_parameters) By how much intervals must be stretched about their medians so that of these datasets near the
/// measured one `confidence` lie in theirs: a conformal interval, the posterior being the measure of strangeness.
std::vector<double> widening_of(const PointEstimator& estimator, std::span<const double> estimate,
                                const std::vector<std::size_t>& rows) {
  const std::size_t n = estimator.infos().size();
  std::vector<std::vector<double>> reaches(n);
  for (const std::size_t row : nearest_of(estimator, estimate, rows)) {
    const stats::AbcPosterior own = posterior_of(estimator, estimator.estimates().row(row), without(rows, row));
    for (std::size_t p = 0; p < n; ++p) reaches[p].push_back(reach(own, p, estimator.parameters()(row, p)));
  }
  std::vector<double> widening;
  for (std::vector<double>& values : reaches) {
    std::ranges::sort(values);
    const auto rank = static_cast<std::size_t>(std::ceil(confidence * static_cast<double>(values.size() + 1)));
    widening.push_back(values[std::min(rank, values.size()) - 1]);
  }
  return widening;
}

}  // namespace

struct EffectFitter::Learnt {
  std::once_flag once;
  std::optional<PointEstimator> estimator;
};

EffectFitter::EffectFitter(const SceneSpec& scene, const ReferenceTable& table, const FeatureMap& map,
                           std::vector<std::vector<std::size_t>> held_back, const Context& context, Omission left_out)
    : scene_(&scene),
      table_(&table),
      map_(&map),
      held_back_(std::move(held_back)),
      threads_(context.threads),
      left_out_(std::move(left_out)),
      learnt_(std::make_unique<Learnt[]>(table.n_hypotheses())) {}
EffectFitter::~EffectFitter() = default;
EffectFitter::EffectFitter(EffectFitter&&) noexcept = default;
EffectFitter& EffectFitter::operator=(EffectFitter&&) noexcept = default;

const EffectFitter::Learnt& EffectFitter::learnt(std::size_t hypothesis) const {
  Learnt& learnt = learnt_[hypothesis];
  std::call_once(learnt.once, [&] {
    const auto datasets = [&](std::span<const std::size_t> rows) {
      return HypothesisDatasets{rows, map_->features(table_->statistics.select_rows(rows), threads_)};
    };
    const std::vector<std::size_t> training =
        still_made(*table_, rows_of(*table_, hypothesis, Part::training), left_out_);
    learnt.estimator.emplace(*table_, hypothesis, datasets(training), datasets(held_back_[hypothesis]));
  });
  return learnt;
}

FittedEffect EffectFitter::fit(std::size_t hypothesis, std::span<const float> measured) const {
  const PointEstimator& estimator = *learnt(hypothesis).estimator;
  const std::vector<float> features = map_->features(measured);
  FittedEffect fitted;
  fitted.effect.name = table_->hypothesis_name(hypothesis);
  const EffectSpec& alike = estimator.kind_of(features);
  fitted.effect.choices = alike.choices;
  fitted.choices = estimator.choices_of(features);
  for (const ParameterInfo& info : effects::find(fitted.effect.name).info.parameters) {
    if (applies(info, alike)) fitted.effect.parameters[info.name] = alike.parameters.at(info.name);
  }
  if (estimator.infos().empty()) return fitted;

  const std::vector<double> observed = estimator.of(features);
  const std::vector<std::size_t> rows = estimator.rows_like(alike);
  const stats::AbcPosterior posterior = posterior_of(estimator, observed, rows);
  const std::vector<double> widening = widening_of(estimator, observed, rows);
  fitted.includes_off = true;
  bool any_strength = false;
  for (std::size_t p = 0; p < estimator.infos().size(); ++p) {
    const ParameterInfo& info = *estimator.infos()[p];
    if (!applies(info, alike)) continue;
    const Interval flat = posterior.interval(p, confidence, widening[p]);
    FittedParameter parameter{info.name, info.unit, from_flat(info, posterior.quantile(p, 0.5)),
                              {},        info.off,  info.role == effects::Role::strength,
                              {}};
    for (int i = 0; i < 20; ++i) {
      const double middle = posterior.quantile(p, 0.5), value = posterior.quantile(p, (i + 0.5) / 20.0);
      parameter.equally_likely.push_back(from_flat(info, middle + widening[p] * (value - middle)));
    }
    parameter.interval = {from_flat(info, flat.low), from_flat(info, flat.high)};
    if (parameter.is_strength) {
      any_strength = true;
      fitted.includes_off = fitted.includes_off && parameter.interval.contains(info.off);
    }
    fitted.effect.parameters[info.name] = parameter.value;
    fitted.parameters.push_back(std::move(parameter));
  }
  fitted.includes_off = fitted.includes_off && any_strength;
  fitted.effect = effects::settled(std::move(fitted.effect), *scene_);
  for (FittedParameter& parameter : fitted.parameters) parameter.value = fitted.effect.parameters.at(parameter.name);
  return fitted;
}

}  // namespace pirsim::reconcile
