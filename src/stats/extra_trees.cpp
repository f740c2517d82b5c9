#include "stats/extra_trees.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"
#include "pirsim/random.hpp"
#include "stats/groups.hpp"
#include "stats/kit.hpp"

namespace pirsim::stats::detail {
namespace {

struct Split {
  std::size_t column = 0;
  float threshold = 0.0F;
  double score = -1.0;  ///< sum over both sides of sum of squared class weights / weight
};

/// A node that waits: its place in the tree and its rows [begin, end).
struct Task {
  std::uint32_t node = 0;
  std::size_t begin = 0, end = 0;
};

/// A column's value in every row.
struct ColumnValues {
  const float* first = nullptr;
  std::size_t stride = 1;
  float operator()(std::uint32_t row) const noexcept { return first[row * stride]; }
};

class Grower {
 public:
  Grower(const GrowingData& data, const GrowingRules& rules, std::uint32_t index)
      : data_(data),
        rules_(rules),
        stream_({rules.seed, index, 0, Purpose::tree_growing}),
        rows_(data.n_rows),
        columns_(data.n_columns),
        values_(data.n_rows),
        classes_(data.n_rows),
        counts_(data.class_weight.size()) {
    std::iota(rows_.begin(), rows_.end(), std::uint32_t{0});
    std::iota(columns_.begin(), columns_.end(), std::uint32_t{0});
    grown_.gain.assign(data.n_columns, 0.0);
  }

  GrownTree grow() {
    std::vector<Task> waiting{{add_node(), 0, data_.n_rows}};
    while (!waiting.empty()) {
      const Task task = waiting.back();
      waiting.pop_back();
      count(task);
      const Split split = find_split(task);
      if (split.score < 0.0) {
        make_leaf(task.node);
        continue;
      }
      grown_.gain[split.column] += split.score - purity(node_counts_);
      const auto middle = partition(task, split);
      const std::uint32_t left = add_node();
      add_node();
      grown_.tree.column[task.node] = static_cast<std::int32_t>(split.column);
      grown_.tree.threshold[task.node] = split.threshold;
      grown_.tree.next[task.node] = left;
      waiting.push_back({left + 1, middle, task.end});
      waiting.push_back({left, task.begin, middle});
    }
    return std::move(grown_);
  }

 private:
  std::uint32_t add_node() {
    grown_.tree.column.push_back(0);
    grown_.tree.threshold.push_back(0.0F);
    grown_.tree.next.push_back(0);
    return static_cast<std::uint32_t>(grown_.tree.column.size() - 1);
  }

  /// Numbers the classes that the node has, ascending: deep in a tree these are few of all.
  void count(const Task& task) {
    std::ranges::fill(counts_, 0U);
    for (std::size_t i = task.begin; i < task.end; ++i) ++counts_[data_.labels[rows_[i]]];
    node_classes_.clear();
    node_counts_.clear();
    node_weights_.clear();
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      if (counts_[k] == 0) continue;
      node_counts_.push_back(counts_[k]);
      node_weights_.push_back(data_.class_weight[k]);
      counts_[k] = static_cast<std::uint32_t>(node_classes_.size());
      node_classes_.push_back(static_cast<std::uint16_t>(k));
    }
    left_counts_.resize(node_counts_.size());
    for (std::size_t i = task.begin; i < task.end; ++i)
      classes_[i] = static_cast<std::uint16_t>(counts_[data_.labels[rows_[i]]]);
  }

  /// Weight times (1 - Gini's impurity): the sum of squared class weights over their sum.
  [[nodiscard]] double purity(const std::vector<std::uint32_t>& counts) const {
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const double weight = counts[k] * node_weights_[k];
      sum += weight;
      squares += weight * weight;
    }
    return sum > 0.0 ? squares / sum : 0.0;
  }

  /// Of up to `tries` columns that vary in the node, drawn without replacement, the best random threshold.
  Split find_split(const Task& task) {
    Split best;
    const std::size_t n = task.end - task.begin;
    if (n < 2 * rules_.min_leaf || node_classes_.size() < 2) return best;
    std::size_t tried = 0;
    for (std::size_t drawn = 0; drawn < columns_.size() && tried < rules_.tries; ++drawn) {
      const std::size_t pick = drawn + stream_.index(static_cast<std::uint32_t>(columns_.size() - drawn));
      std::swap(columns_[drawn], columns_[pick]);
      const std::size_t column = columns_[drawn];
      const auto [low, high] = gather(column, task);
      if (!(low < high)) continue;
      ++tried;
      const auto share = static_cast<float>(stream_.uniform());
      const float threshold = std::min(low + share * (high - low), std::nextafter(high, low));
      const double score = score_of(threshold, task);
      if (score > best.score) best = {column, threshold, score};
    }
    return best;
  }

  /// A small node's rows are scattered over a column; below the node most columns of each row are tried, so that the
  /// values are sooner found in memory if the rows lie together.
  [[nodiscard]] ColumnValues values_of(std::size_t column, const Task& task) const {
    if (task.end - task.begin < data_.n_columns) return {data_.features.data() + column, data_.n_columns};
    return {data_.columns.data() + column * data_.n_rows};
  }

  std::pair<float, float> gather(std::size_t column, const Task& task) {
    const ColumnValues values = values_of(column, task);
    float low = values(rows_[task.begin]), high = low;
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const float value = values(rows_[i]);
      values_[i] = value;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return {low, high};
  }

  double score_of(float threshold, const Task& task) {
    std::ranges::fill(left_counts_, 0U);
    std::size_t n_left = 0;
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const std::uint32_t left = values_[i] <= threshold ? 1 : 0;
      left_counts_[classes_[i]] += left;
      n_left += left;
    }
    if (n_left < rules_.min_leaf || task.end - task.begin - n_left < rules_.min_leaf) return -1.0;
    const double left = purity(left_counts_);
    for (std::size_t k = 0; k < left_counts_.size(); ++k) left_counts_[k] = node_counts_[k] - left_counts_[k];
    return left + purity(left_counts_);
  }

  std::size_t partition(const Task& task, const Split& split) {
    const ColumnValues values = values_of(split.column, task);
    const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(task.begin);
    const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(task.end);
    const auto middle = std::partition(begin, end, [&](std::uint32_t row) { return values(row) <= split.threshold; });
    return static_cast<std::size_t>(middle - rows_.begin());
  }

  void make_leaf(std::uint32_t node) {
    double total = 0.0;
    for (std::size_t k = 0; k < node_counts_.size(); ++k) total += node_counts_[k] * node_weights_[k];
    grown_.tree.next[node] = static_cast<std::uint32_t>(grown_.tree.classes.size());
    grown_.tree.column[node] = -static_cast<std::int32_t>(node_classes_.size());
    for (std::size_t k = 0; k < node_counts_.size(); ++k) {
      grown_.tree.classes.push_back(node_classes_[k]);
      grown_.tree.shares.push_back(static_cast<float>(node_counts_[k] * node_weights_[k] / total));
    }
  }

  const GrowingData& data_;
  const GrowingRules& rules_;
  Stream stream_;
  std::vector<std::uint32_t> rows_;     ///< of each node together
  std::vector<std::uint32_t> columns_;  ///< shuffled bit by bit as columns are drawn
  std::vector<float> values_;           ///< of the column being tried
  std::vector<std::uint16_t> classes_;  ///< of the node's rows, as numbered in the node
  std::vector<std::uint32_t> counts_;   ///< (n_classes) rows in the node, then the number there
  // Of the classes that the node has.
  std::vector<std::uint16_t> node_classes_;
  std::vector<double> node_weights_;
  std::vector<std::uint32_t> node_counts_, left_counts_;
  GrownTree grown_;
};

}  // namespace

GrowingData prepare(const Matrix<float>& features, std::span<const int> labels, int n_classes) {
  GrowingData data{features.rows(), features.columns(), features.values(), {}, {}, {}};
  data.columns.resize(features.values().size());
  for (std::size_t row = 0; row < features.rows(); ++row)
    for (std::size_t column = 0; column < features.columns(); ++column)
      data.columns[column * features.rows() + row] = features(row, column);
  std::vector<double> counts(static_cast<std::size_t>(n_classes), 0.0);
  for (const int label : labels) {
    data.labels.push_back(static_cast<std::uint16_t>(label));
    counts[static_cast<std::size_t>(label)] += 1.0;
  }
  for (const double count : counts) data.class_weight.push_back(1.0 / count);
  return data;
}

GrownTree grow(const GrowingData& data, const GrowingRules& rules, std::uint32_t index) {
  return Grower(data, rules, index).grow();
}

}  // namespace pirsim::stats::detail

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
