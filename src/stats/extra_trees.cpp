#include "stats/extra_trees.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "stats/groups.hpp"
#include "stats/kit.hpp"

namespace pirsim::stats {
namespace {

/// Class shares of the leaf that the row falls into are added.
void add_leaf(const ExtraTrees::Tree& tree, std::span<const float> features, std::span<double> sum) {
  std::uint32_t node = 0;
  while (tree.column[node] >= 0)
    node = tree.next[node] + (features[static_cast<std::size_t>(tree.column[node])] <= tree.threshold[node] ? 0 : 1);
  const std::uint32_t begin = tree.next[node];
  const auto end = begin + static_cast<std::uint32_t>(-tree.column[node]);
  for (std::uint32_t i = begin; i < end; ++i) sum[tree.classes[i]] += static_cast<double>(tree.shares[i]);
}

}  // namespace

ExtraTrees ExtraTrees::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                           const ExtraTreesSettings& settings) {
  detail::check_labelled(features, labels, n_classes, 1);
  require(settings.trees > 0 && settings.min_leaf > 0, "extra trees: at least one tree and one row a leaf");
  const detail::GrowingData data = detail::prepare(features, labels, n_classes);
  const auto root = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(features.columns()))));
  const detail::GrowingRules rules{std::min(settings.tries == 0 ? root : settings.tries, features.columns()),
                                   settings.min_leaf, settings.seed};
  ExtraTrees forest;
  forest.n_classes_ = n_classes;
  forest.n_columns_ = features.columns();
  forest.importance_.assign(features.columns(), 0.0);
  ordered_parallel<detail::GrownTree>(
      settings.trees, settings.threads,
      [&](std::size_t tree) { return detail::grow(data, rules, static_cast<std::uint32_t>(tree)); },
      [&](detail::GrownTree& grown) {
        forest.trees_.push_back(std::move(grown.tree));
        for (std::size_t c = 0; c < grown.gain.size(); ++c) forest.importance_[c] += grown.gain[c];
      });
  double total = 0.0;
  for (const double gain : forest.importance_) total += gain;
  if (total > 0.0)
    for (double& gain : forest.importance_) gain /= total;
  return forest;
}

std::vector<double> ExtraTrees::probabilities(std::span<const float> features) const {
  require(features.size() == n_columns_, "extra trees: another number of features than was fitted");
  std::vector<double> sum(static_cast<std::size_t>(n_classes_), 0.0);
  for (const Tree& tree : trees_) add_leaf(tree, features, sum);
  for (double& share : sum) share /= static_cast<double>(trees_.size());
  return sum;
}

Matrix<double> ExtraTrees::probabilities(const Matrix<float>& features, unsigned threads) const {
  return detail::map_rows(features.rows(), static_cast<std::size_t>(n_classes_), threads,
                          [&](std::size_t row) { return probabilities(features.row(row)); });
}

}  // namespace pirsim::stats
