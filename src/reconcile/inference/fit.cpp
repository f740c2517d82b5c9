#include "reconcile/inference/fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "pirsim/error.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {
namespace {

using effects::ParameterInfo;
using effects::Role;
using effects::Scale;

constexpr std::size_t fewest_in_part = 10;  ///< 10 and 20 were tried: no difference
constexpr std::size_t most_parts = 3;       ///< by strength; 1, 2 and 3 were tried: 3 part the hypotheses best

/// What isn't a matter of more or less: choices, and for each strength on which side of `off` it lies.
using ChoicesAndSides = std::pair<std::map<std::string, std::string, std::less<>>, std::vector<int>>;

ChoicesAndSides kind_of(const EffectSpec& effect) {
  ChoicesAndSides kind{effect.choices, {}};
  for (const ParameterInfo& info : effects::find(effect.name).info.parameters) {
    if (info.role != Role::strength || !effects::applies(info, effect)) continue;
    const double value = effect.parameters.at(info.name);
    kind.second.push_back(value > info.off ? 1 : value < info.off ? -1 : 0);
  }
  return kind;
}

double strength_of(const EffectSpec& effect) {
  const ParameterInfo& strength = effects::strength_parameter(effect);
  return to_flat(strength, effect.parameters.at(strength.name));
}

constexpr std::size_t fewest_training = 20;  ///< datasets of a hypothesis: fewer have no shape
constexpr std::size_t fewest_calibration = 10;
constexpr std::size_t fewest_of_kind = 10;  ///< training datasets: the mean of fewer is noise

/// Its parameters are fitted from these, each once more without one of them (stats::abc_posterior).
std::size_t fewest_to_fit(const ReferenceTable& table, std::size_t hypothesis) {
  if (hypothesis == 0) return 0;
  return 2 * effects::find(table.hypothesis_name(hypothesis)).info.parameters.size() + 3;
}

/// The rows that the global test sees something in; if they are few the next ones too, so that p can fall below alpha:
/// two tests in one need 2 / alpha rows, half as many again tell more than whether it does (40 to 80 rows were tried).
std::vector<std::size_t> rows_seen(const TableView& view, std::vector<std::size_t> rows, double alpha) {
  std::vector<std::pair<double, std::size_t>> by_p;
  for (const std::size_t row : rows) by_p.emplace_back(view.p_of_row(row), row);
  std::ranges::sort(by_p);
  const auto fewest = static_cast<std::size_t>(3.0 / alpha);
  const auto n_seen =
      static_cast<std::size_t>(std::ranges::count_if(by_p, [&](const auto& row) { return row.first <= alpha; }));
  by_p.resize(std::min(by_p.size(), std::max(n_seen, fewest)));
  rows.clear();
  for (const auto& [p, row] : by_p) rows.push_back(row);
  std::ranges::sort(rows);
  return rows;
}

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

/// (n x n_parameters) flat; the value of a parameter that doesn't apply is the usual one.
stats::Matrix<double> parameters_of(const std::vector<const EffectSpec*>& drawn,
                                    const std::vector<const ParameterInfo*>& infos) {
  stats::Matrix<double> parameters(drawn.size(), infos.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    for (std::size_t p = 0; p < infos.size(); ++p) {
      const auto value = drawn[i]->parameters.find(infos[p]->name);
      parameters(i, p) = to_flat(*infos[p], value == drawn[i]->parameters.end() ? infos[p]->typical : value->second);
    }
  }
  return parameters;
}

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
    const std::vector<double> values = estimates.column(p);
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

double to_flat(const ParameterInfo& info, double value) {
  const double within = std::clamp(value, info.low, info.high);
  return info.scale == Scale::logarithmic ? std::log(within) : within;
}

double from_flat(const ParameterInfo& info, double value) {
  const double natural = info.scale == Scale::logarithmic ? std::exp(value) : value;
  const double rounded = info.scale == Scale::whole ? std::round(natural) : natural;
  return std::clamp(rounded, info.least, info.most);
}

std::vector<int> number_alike(const ReferenceTable& table, std::span<const std::size_t> rows, std::size_t fewest) {
  if (rows.empty() || table.rows[rows.front()].hypothesis == 0) return std::vector<int>(rows.size(), 0);
  std::map<ChoicesAndSides, std::vector<std::pair<double, std::size_t>>> by_kind;  // strength and place of each
  for (std::size_t place = 0; place < rows.size(); ++place) {
    const EffectSpec& drawn = table.rows[rows[place]].effects.front();
    by_kind[kind_of(drawn)].emplace_back(strength_of(drawn), place);
  }
  std::vector<int> numbers(rows.size(), 0);
  const bool any_small = std::ranges::any_of(by_kind, [&](const auto& k) { return k.second.size() < fewest; });
  int next = any_small ? 1 : 0;  // 0: all those of kinds with few datasets
  for (auto& [kind, members] : by_kind) {
    if (members.size() < fewest) continue;
    std::ranges::sort(members);
    const bool varies = members.front().first < members.back().first;
    const std::size_t parts = varies ? std::clamp<std::size_t>(members.size() / fewest_in_part, 1, most_parts) : 1;
    for (std::size_t i = 0; i < members.size(); ++i)
      numbers[members[i].second] = next + static_cast<int>(i * parts / members.size());
    next += static_cast<int>(parts);
  }
  return numbers;
}

KindFinder::KindFinder(const ReferenceTable& table, std::span<const std::size_t> rows,
                       const stats::Matrix<float>& features) {
  const std::vector<int> numbers = number_alike(table, rows, 1);
  const int n_kinds = numbers.empty() ? 0 : std::ranges::max(numbers) + 1;
  for (int kind = 0; kind < n_kinds; ++kind) {
    examples_.push_back(static_cast<std::size_t>(std::ranges::find(numbers, kind) - numbers.begin()));
    n_.push_back(static_cast<double>(std::ranges::count(numbers, kind)));
  }
  if (n_kinds > 1) discriminant_ = stats::Discriminant::fit(features, numbers, n_kinds);
}

std::size_t KindFinder::one_like(std::span<const float> features) const {
  if (examples_.size() < 2) return examples_.at(0);
  const std::vector<double> densities = discriminant_.log_densities(features);
  return examples_[static_cast<std::size_t>(std::ranges::max_element(densities) - densities.begin())];
}

std::vector<KindFinder::Share> KindFinder::shares(std::span<const float> features) const {
  if (examples_.size() < 2) return {{examples_.at(0), 1.0}};
  std::vector<double> logs = discriminant_.log_densities(features);
  for (std::size_t i = 0; i < logs.size(); ++i) logs[i] += std::log(n_[i]);
  std::vector<Share> shares;
  for (const double probability : stats::detail::softmax(logs))
    shares.push_back({examples_[shares.size()], probability});
  return shares;
}

std::vector<std::size_t> still_made(const ReferenceTable& table, std::vector<std::size_t> rows,
                                    const std::string& left_out) {
  std::erase_if(rows, [&](std::size_t row) {
    return std::ranges::find(table.rows[row].effects, left_out, &EffectSpec::name) != table.rows[row].effects.end();
  });
  return rows;
}

SeenRows seen_rows(const TableView& view, double alpha, const std::string& left_out) {
  const ReferenceTable& table = view.table();
  SeenRows seen{rows_of(table, 0, Subset::calibration)};
  for (std::size_t hypothesis = 1; hypothesis < table.n_hypotheses(); ++hypothesis)
    seen.push_back(
        rows_seen(view, still_made(table, rows_of(table, hypothesis, Subset::calibration), left_out), alpha));
  return seen;
}

LabelledRows::LabelledRows(const ReferenceTable& table, const SeenRows& seen, const std::string& left_out)
    : n_hypotheses(table.n_hypotheses()) {
  const auto add = [&](const std::vector<std::size_t>& more, const std::vector<int>& kinds_of_more,
                       std::vector<std::size_t>& part) {
    for (std::size_t i = 0; i < more.size(); ++i) {
      part.push_back(rows.size());
      rows.push_back(more[i]);
      labels.push_back(static_cast<int>(hypotheses.size()));
      kinds.push_back(kinds_of_more[i]);
    }
  };
  int n_kinds = 0;
  for (std::size_t hypothesis = 0; hypothesis < n_hypotheses; ++hypothesis) {
    if (table.hypothesis_name(hypothesis) == left_out) continue;
    const std::vector<std::size_t> training = still_made(table, rows_of(table, hypothesis, Subset::training), left_out);
    const std::size_t n_calibration = rows_of(table, hypothesis, Subset::calibration).size();
    if (training.size() < fewest_training ||
        n_calibration < std::max(fewest_calibration, fewest_to_fit(table, hypothesis))) {
      if (hypothesis > 0) continue;
      throw Error(ErrorCode::infeasible,
                  "reconcile: people could get about in too few realizations of the plain model (" +
                      std::to_string(training.size() + n_calibration) + "): simulate more realizations");
    }
    std::vector<int> alike = number_alike(table, training, fewest_of_kind);
    for (int& kind : alike) kind += n_kinds;
    n_kinds = std::ranges::max(alike) + 1;
    add(training, alike, split.fitting);
    add(seen.at(hypothesis), std::vector<int>(seen.at(hypothesis).size(), -1), split.calibration);
    hypotheses.push_back(hypothesis);
  }
  if (hypotheses.size() < 2)
    throw Error(ErrorCode::infeasible,
                "reconcile: no effect to look for is left; of each too few realizations could be "
                "simulated in this room");
}

std::vector<double> LabelledRows::by_hypothesis(std::span<const double> of_classes) const {
  std::vector<double> values(n_hypotheses, 0.0);
  for (std::size_t c = 0; c < hypotheses.size(); ++c) values[hypotheses[c]] = of_classes[c];
  return values;
}

HypothesisProbabilities::HypothesisProbabilities(const ReferenceTable& table, const FeatureMap& map,
                                                 const SeenRows& seen, const stats::PooledClassifierSettings& settings)
    : map_(&map),
      data_(table, seen, {}),
      classifier_(stats::PooledClassifier::fit(map.features(table.statistics.select_rows(data_.rows), settings.threads),
                                               data_.labels, static_cast<int>(data_.hypotheses.size()), data_.split,
                                               settings, data_.kinds)) {}

std::vector<double> HypothesisProbabilities::of(std::span<const float> statistics) const {
  return data_.by_hypothesis(classifier_.probabilities(map_->features(statistics)));
}

HypothesisClassifier::HypothesisClassifier(const TableView& view, const ClassifierSettings& settings,
                                           const Context& context)
    : map_(&view.map()),
      names_(view.table().hypotheses()),
      seen_rows_(reconcile::seen_rows(view, settings.alpha, settings.left_out)),
      data_(view.table(), seen_rows_, settings.left_out) {
  stats::ConformalSettings conformal;
  conformal.pooled.trees = {.trees = settings.trees, .seed = context.seed, .threads = context.threads};
  conformal.pooled.threads = context.threads;
  conformal.shapes.seed = context.seed;
  conformal.shapes.threads = context.threads;
  conformal.blocks = view.map().blocks();
  const stats::Matrix<float> features = view.features().select_rows(data_.rows);
  classifier_ = stats::ConformalClassifier::fit(features, data_.labels, static_cast<int>(data_.hypotheses.size()),
                                                data_.split, conformal, data_.kinds);
  impostors_ = stats::ImpostorTests::fit(classifier_.pooled().log_densities(features, context.threads), data_.labels,
                                         data_.split, context.threads);
  std::vector<int> labels;
  for (const std::size_t place : data_.split.calibration) labels.push_back(data_.labels[place]);
  reliability_ = stats::reliability(classifier_.calibration_probabilities(), labels);
}

std::vector<double> HypothesisClassifier::probabilities(std::span<const float> statistics) const {
  return data_.by_hypothesis(classifier_.pooled().probabilities(map_->features(statistics)));
}

std::vector<HypothesisScore> HypothesisClassifier::judge(std::span<const float> statistics) const {
  const std::vector<float> features = map_->features(statistics);
  const stats::Classification found = classifier_.classify(features);
  const std::vector<double> log_densities = classifier_.pooled().log_densities(features);
  std::vector<HypothesisScore> scores;
  for (const std::string& name : names_) scores.push_back({name});
  for (std::size_t c = 0; c < data_.hypotheses.size(); ++c) {
    HypothesisScore& score = scores[data_.hypotheses[c]];
    score.probability = found.probabilities[c];
    score.p_relative = found.p_relative[c];
    score.p_absolute = found.p_absolute[c];
    score.p = found.p[c];
    score.least_p = classifier_.least_p(c);
    if (c > 0) score.p_own = impostors_.p(c, log_densities);
  }
  return scores;
}

std::vector<FeatureName> HypothesisClassifier::telling_features(std::size_t n) const {
  std::vector<std::size_t> order = stats::numbers_to(map_->names().size());
  const std::vector<double>& importance = classifier_.pooled().trees().importance();
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return importance[a] > importance[b]; });
  std::vector<FeatureName> names;
  for (std::size_t i = 0; i < std::min(n, order.size()); ++i) names.push_back(map_->names()[order[i]]);
  return names;
}

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
  for (std::size_t i = 0; i < held_back.rows.size(); ++i) estimates_.append_row(of(held_back.features.row(i)));
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
  const std::vector<std::size_t> all = stats::numbers_to(held_back_.size());
  std::vector<std::size_t> rows = all;
  std::erase_if(rows, [&](std::size_t row) { return !is_like(held_back_[row]); });
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

const PointEstimator& EffectFitter::estimator_of(std::size_t hypothesis) const {
  Learnt& learnt = learnt_[hypothesis];
  std::call_once(learnt.once, [&] {
    const auto datasets = [&](std::span<const std::size_t> rows) {
      return HypothesisDatasets{rows, map_->features(table_->statistics.select_rows(rows), threads_)};
    };
    const std::vector<std::size_t> training =
        still_made(*table_, rows_of(*table_, hypothesis, Subset::training), left_out_);
    learnt.estimator.emplace(*table_, hypothesis, datasets(training), datasets(held_back_[hypothesis]));
  });
  return *learnt.estimator;
}

FittedEffect EffectFitter::fit(std::size_t hypothesis, std::span<const float> measured) const {
  const PointEstimator& estimator = estimator_of(hypothesis);
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
                              {},        info.off,  info.role == Role::strength,
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
