#include "reconcile/inference/classifier.hpp"

#include <algorithm>
#include <numeric>

#include "pirsim/error.hpp"
#include "reconcile/inference/kinds.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {
namespace {

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

}  // namespace

std::vector<std::size_t> still_made(const ReferenceTable& table, std::vector<std::size_t> rows,
                                    const std::string& left_out) {
  std::erase_if(rows, [&](std::size_t row) {
    return std::ranges::find(table.rows[row].effects, left_out, &EffectSpec::name) != table.rows[row].effects.end();
  });
  return rows;
}

SeenRows seen_rows(const TableView& view, double alpha, const std::string& left_out) {
  const ReferenceTable& table = view.table();
  SeenRows seen{rows_of(table, 0, Part::calibration)};
  for (std::size_t hypothesis = 1; hypothesis < table.n_hypotheses(); ++hypothesis)
    seen.push_back(rows_seen(view, still_made(table, rows_of(table, hypothesis, Part::calibration), left_out), alpha));
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
    const std::vector<std::size_t> training = still_made(table, rows_of(table, hypothesis, Part::training), left_out);
    const std::size_t n_calibration = rows_of(table, hypothesis, Part::calibration).size();
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
      seen_rows_(reconcile::seen_rows(view, settings.alpha, settings.left_out)),
      data_(view.table(), seen_rows_, settings.left_out) {
  for (std::size_t hypothesis = 0; hypothesis < view.table().n_hypotheses(); ++hypothesis)
    names_.push_back(view.table().hypothesis_name(hypothesis));
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
  std::vector<std::size_t> order(map_->names().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<double>& importance = classifier_.pooled().trees().importance();
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return importance[a] > importance[b]; });
  std::vector<FeatureName> names;
  for (std::size_t i = 0; i < std::min(n, order.size()); ++i) names.push_back(map_->names()[order[i]]);
  return names;
}

}  // namespace pirsim::reconcile
