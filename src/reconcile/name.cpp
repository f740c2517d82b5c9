#include "pirsim/reconcile/name.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "pirsim/core/error.hpp"
#include "pirsim/reconcile/locate.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::size_t fewest_training = 20;  ///< datasets of an entry: fewer have no shape
constexpr std::size_t fewest_calibration = 10;

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

/// Rows of the table with their classes, split by world.
struct Labelled {
  std::vector<std::size_t> rows;
  std::vector<int> labels;
  stats::Split split;

  void add(const std::vector<std::size_t>& more, int label, std::vector<std::size_t>& part) {
    for (const std::size_t row : more) {
      part.push_back(rows.size());
      rows.push_back(row);
      labels.push_back(label);
    }
  }
};

}  // namespace

FamilyScore likeliest_family(std::span<const EntryScore> scores) {
  std::map<effects::Family, double> sums;
  for (const EntryScore& score : scores.subspan(1)) sums[effects::find(score.entry).info.family] += score.probability;
  const auto likeliest = std::ranges::max_element(sums, {}, [](const auto& sum) { return sum.second; });
  return likeliest == sums.end() ? FamilyScore{} : FamilyScore{likeliest->first, likeliest->second};
}

Namer::Namer(const TableView& view, const NamerSettings& settings) : map_(&view.map()) {
  const ReferenceTable& table = view.table();
  Labelled data;
  seen_rows_.resize(table.n_entries());
  for (std::size_t entry = 0; entry < table.n_entries(); ++entry) {
    names_.push_back(table.entry_name(entry));
    if (names_.back() == settings.left_out) continue;
    const std::vector<std::size_t> training = rows_of(table, entry, Part::training);
    const std::vector<std::size_t> calibration = rows_of(table, entry, Part::calibration);
    if (training.size() < fewest_training || calibration.size() < fewest_calibration) {
      if (entry > 0) continue;
      throw Error(ErrorCode::infeasible, "reconcile: people could get about in too few worlds of the plain model (" +
                                             std::to_string(training.size() + calibration.size()) +
                                             "): simulate more worlds");
    }
    const auto label = static_cast<int>(entries_.size());
    data.add(training, label, data.split.fitting);
    seen_rows_[entry] = entry == 0 ? calibration : rows_seen(view, calibration, settings.alpha);
    data.add(seen_rows_[entry], label, data.split.calibration);
    entries_.push_back(entry);
  }
  const stats::Matrix<float> features = view.features().select_rows(data.rows);
  stats::ConformalSettings conformal;
  conformal.trees.trees = settings.trees;
  conformal.trees.seed = settings.seed;
  conformal.trees.threads = settings.threads;
  conformal.shapes.seed = settings.seed;
  conformal.shapes.threads = settings.threads;
  conformal.blocks = view.map().blocks();
  conformal.threads = settings.threads;
  classifier_ =
      stats::ConformalClassifier::fit(features, data.labels, static_cast<int>(entries_.size()), data.split, conformal);
  std::vector<int> labels;
  for (const std::size_t row : data.split.calibration) labels.push_back(data.labels[row]);
  reliability_ = stats::reliability(classifier_.calibration_probabilities(), labels);
}

std::vector<double> Namer::probabilities(std::span<const float> statistics) const {
  const std::vector<double> of_classes = classifier_.probabilities(map_->features(statistics));
  std::vector<double> p(names_.size(), 0.0);
  for (std::size_t c = 0; c < entries_.size(); ++c) p[entries_[c]] = of_classes[c];
  return p;
}

std::vector<EntryScore> Namer::judge(std::span<const float> statistics) const {
  const stats::Classification found = classifier_.classify(map_->features(statistics));
  std::vector<EntryScore> scores;
  for (const std::string& name : names_) scores.push_back({name});
  for (std::size_t c = 0; c < entries_.size(); ++c) {
    EntryScore& score = scores[entries_[c]];
    score.probability = found.probabilities[c];
    score.p_relative = found.p_relative[c];
    score.p_absolute = found.p_absolute[c];
    score.p = found.p[c];
  }
  return scores;
}

std::vector<std::string> Namer::telling_features(std::size_t n) const {
  std::vector<std::size_t> order(map_->names().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<double>& importance = classifier_.trees().importance();
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return importance[a] > importance[b]; });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(n, order.size()); ++i) names.push_back(map_->names()[order[i]]);
  return names;
}

}  // namespace pirsim::reconcile
