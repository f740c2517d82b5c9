#include "reconcile/inference/fit.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "reconcile/inference/kinds.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {
namespace {

using effects::ParameterInfo;
using effects::Role;

constexpr std::size_t fewest_own = 20;  ///< assumed: an estimate learnt from fewer datasets is worse than one from all

stats::Matrix<double> in_double(const stats::Matrix<float>& narrow) {
  stats::Matrix<double> wide(narrow.rows(), narrow.columns());
  std::ranges::copy(narrow.values(), wide.values().begin());
  return wide;
}

std::vector<const EffectSpec*> drawn_in(const ReferenceTable& table, std::span<const std::size_t> rows) {
  std::vector<const EffectSpec*> drawn;
  for (const std::size_t row : rows) drawn.push_back(&table.rows[row].effects.front());
  return drawn;
}

/// Of one that doesn't apply: what is usual.
double flat_value(const ParameterInfo& info, const EffectSpec& drawn) {
  const auto value = drawn.parameters.find(info.name);
  return to_flat(info, value == drawn.parameters.end() ? info.typical : value->second);
}

/// (n x n_parameters) flat
stats::Matrix<double> parameters_of(const std::vector<const EffectSpec*>& drawn,
                                    const std::vector<const ParameterInfo*>& infos) {
  stats::Matrix<double> parameters(drawn.size(), infos.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    for (std::size_t p = 0; p < infos.size(); ++p) parameters(i, p) = flat_value(*infos[p], *drawn[i]);
  }
  return parameters;
}

}  // namespace

PointEstimator::PointEstimator(const ReferenceTable& table, std::size_t hypothesis, const HypothesisDatasets& training,
                               const HypothesisDatasets& held_back)
    : drawn_(drawn_in(table, training.rows)), finder_(table, training.rows, training.features) {
  for (const ParameterInfo& info : effects::find(table.hypothesis_name(hypothesis)).info.parameters) {
    if (info.low < info.high) infos_.push_back(&info);
  }
  if (infos_.empty()) return;
  const stats::Matrix<double> features = in_double(training.features), parameters = parameters_of(drawn_, infos_);
  std::map<Choices, std::vector<std::size_t>> rows_of;
  for (std::size_t i = 0; i < drawn_.size(); ++i) rows_of[drawn_[i]->choices].push_back(i);
  const std::size_t n = infos_.size();
  stats::Matrix<double> targets(drawn_.size(), rows_of.size() * n);
  for (const auto& [choices, rows] : rows_of) {
    Alike& alike = alike_[choices];
    alike.number = alike_.size() - 1;
    if (rows.size() >= fewest_own)
      alike.from_own = stats::ParameterEstimator::fit(features.select_rows(rows), parameters.select_rows(rows));
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
      for (std::size_t p = 0; p < n; ++p) {
        const bool acts = drawn_[i]->choices == choices || infos_[p]->role != Role::strength;
        targets(i, alike.number * n + p) = acts ? parameters(i, p) : to_flat(*infos_[p], infos_[p]->off);
      }
    }
  }
  from_all_ = stats::ParameterEstimator::fit(features, targets);
  held_back_ = drawn_in(table, held_back.rows);
  parameters_ = parameters_of(held_back_, infos_);
  for (std::size_t i = 0; i < held_back.rows.size(); ++i)
    estimates_.append_row(std::span<const double>(of(held_back.features.row(i))));
}

std::vector<Interval> PointEstimator::bounds() const {
  std::vector<Interval> bounds;
  for (const ParameterInfo* info : infos_) bounds.push_back({to_flat(*info, info->low), to_flat(*info, info->high)});
  return bounds;
}

std::vector<std::size_t> PointEstimator::rows_like(const EffectSpec& kind) const {
  const auto is_like = [&](const EffectSpec* drawn) {
    return std::ranges::all_of(infos_, [&](auto* info) { return applies(*info, *drawn) == applies(*info, kind); });
  };
  std::vector<std::size_t> rows, all;
  for (std::size_t row = 0; row < held_back_.size(); ++row) {
    all.push_back(row);
    if (is_like(held_back_[row])) rows.push_back(row);
  }
  return rows.size() < fewest_own ? all : rows;
}

const EffectSpec& PointEstimator::kind_of(std::span<const float> features) const {
  return *drawn_[finder_.one_like(features)];
}

std::vector<FittedChoice> PointEstimator::choices_of(std::span<const float> features) const {
  std::map<std::string, std::map<std::string, double>> probabilities;  // of each choice's words
  const std::vector<KindFinder::Share> shares = finder_.shares(features);
  for (const KindFinder::Share& share : shares) {
    for (const auto& [name, word] : drawn_[share.example]->choices) probabilities[name];
  }
  for (const KindFinder::Share& share : shares) {
    const Choices& choices = drawn_[share.example]->choices;
    for (auto& [name, words] : probabilities) {
      const auto made = choices.find(name);
      words[made == choices.end() ? "" : made->second] += share.probability;
    }
  }
  std::vector<FittedChoice> fitted;
  for (const auto& [name, words] : probabilities) {
    FittedChoice& choice = fitted.emplace_back(FittedChoice{name, {}});
    for (const auto& [word, probability] : words) choice.words.push_back({word, probability});
    std::ranges::stable_sort(choice.words, std::ranges::greater{}, &FittedChoice::Word::probability);
  }
  return fitted;
}

std::vector<double> PointEstimator::of(std::span<const float> features) const {
  const std::vector<double> wide(features.begin(), features.end());
  const Alike& alike = alike_.at(kind_of(features).choices);
  const std::vector<double> all = from_all_.estimate(wide);
  const auto own = all.begin() + static_cast<std::ptrdiff_t>(alike.number * infos_.size());
  std::vector<double> estimates(own, own + static_cast<std::ptrdiff_t>(infos_.size()));
  if (alike_.size() == 1) return estimates;
  const std::vector<double> more = alike.from_own ? alike.from_own->estimate(wide) : estimates;
  estimates.insert(estimates.end(), more.begin(), more.end());
  return estimates;
}

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
                           std::vector<std::vector<std::size_t>> held_back, const Context& context,
                           std::string left_out)
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
