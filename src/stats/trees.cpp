#include "stats/trees.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "model/core/parallel.hpp"
#include "pirsim/random.hpp"
#include "stats/classes.hpp"
#include "stats/linear_algebra.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {
namespace {

/// What all trees are grown from; the features must outlive it.
struct GrowingData {
  std::size_t n_rows = 0, n_columns = 0;
  std::span<const float> features;    ///< (n_rows x n_columns)
  std::vector<float> columns;         ///< (n_columns x n_rows) the same, transposed
  std::vector<std::uint16_t> labels;  ///< (n_rows)
  std::vector<double> class_weight;   ///< (n_classes) of one row, so that all classes weigh the same
};

struct GrowingRules {
  std::size_t tries = 1;
  std::size_t min_leaf = 1;
  std::uint64_t seed = 0;
};

struct GrownTree {
  ExtraTrees::Tree tree;
  std::vector<double> gain;  ///< (n_columns) decrease of weighted impurity
};

struct NodeSplit {
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
      const NodeSplit split = find_split(task);
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
  NodeSplit find_split(const Task& task) {
    NodeSplit best;
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

  std::size_t partition(const Task& task, const NodeSplit& split) {
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

/// Class shares of the leaf that the row falls into are added.
void add_leaf(const ExtraTrees::Tree& tree, std::span<const float> features, std::span<double> sum) {
  std::uint32_t node = 0;
  while (tree.column[node] >= 0)
    node = tree.next[node] + (features[static_cast<std::size_t>(tree.column[node])] <= tree.threshold[node] ? 0 : 1);
  const std::uint32_t begin = tree.next[node];
  const auto end = begin + static_cast<std::uint32_t>(-tree.column[node]);
  for (std::uint32_t i = begin; i < end; ++i) sum[tree.classes[i]] += static_cast<double>(tree.shares[i]);
}

/// A forest gives 0 to classes that no leaf holds; what is less likely than this is taken for as likely.
constexpr double smallest_probability = 1e-4;  // assumed; 1e-3 and 1e-6 tried

double log_of(double probability) { return std::log(std::max(probability, smallest_probability)); }

Eigen::VectorXd softmax(const Eigen::VectorXd& logs) {
  const Eigen::VectorXd shares = (logs.array() - logs.maxCoeff()).exp();
  return shares / shares.sum();
}

/// Loss, gradient and Hessian of the mean log loss in the weights.
struct LossTerms {
  double loss = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

LossTerms loss_of(std::span<const Matrix<double>> sources, std::span<const int> labels,
                  const Eigen::VectorXd& weights) {
  const Eigen::Index n_sources = weights.size();
  LossTerms terms{0.0, Eigen::VectorXd::Zero(n_sources), Eigen::MatrixXd::Zero(n_sources, n_sources)};
  Eigen::MatrixXd logs(static_cast<Eigen::Index>(sources[0].columns()), n_sources);
  for (std::size_t row = 0; row < labels.size(); ++row) {
    for (Eigen::Index s = 0; s < n_sources; ++s)
      for (Eigen::Index k = 0; k < logs.rows(); ++k)
        logs(k, s) = log_of(sources[static_cast<std::size_t>(s)](row, static_cast<std::size_t>(k)));
    const Eigen::VectorXd shares = softmax(logs * weights);
    const Eigen::VectorXd mean = logs.transpose() * shares;
    terms.loss -= std::log(std::max(shares(labels[row]), 1e-300));
    terms.gradient += mean - logs.row(labels[row]).transpose();
    terms.hessian += logs.transpose() * shares.asDiagonal() * logs - mean * mean.transpose();
  }
  const double n = static_cast<double>(labels.size());
  return {terms.loss / n, terms.gradient / n, terms.hessian / n};
}

std::vector<float> with_coordinates(std::span<const float> features, std::span<const double> place) {
  std::vector<float> wide(features.begin(), features.end());
  for (const double coordinate : place) wide.push_back(static_cast<float>(coordinate));
  return wide;
}

Matrix<float> with_coordinates(const Matrix<float>& features, const Matrix<double>& places) {
  Matrix<float> wide(features.rows(), features.columns() + places.columns());
  for (std::size_t row = 0; row < features.rows(); ++row) {
    const std::vector<float> values = with_coordinates(features.row(row), places.row(row));
    std::copy(values.begin(), values.end(), wide.row(row).begin());
  }
  return wide;
}

struct Problem {
  Eigen::MatrixXd design;  ///< (n_rows x 1 + n_columns) a column of ones first
  Eigen::VectorXd outcomes, offset, penalty;
};

struct Terms {
  double log_likelihood = 0.0;
  Eigen::VectorXd residuals, gradient;
  Eigen::MatrixXd information;
};

Problem pose(const Matrix<double>& columns, std::span<const std::uint8_t> outcomes, const LogisticSettings& settings) {
  const auto n = static_cast<Eigen::Index>(columns.rows()), d = static_cast<Eigen::Index>(columns.columns());
  Problem problem{Eigen::MatrixXd::Ones(n, d + 1), Eigen::VectorXd(n), Eigen::VectorXd::Zero(n),
                  Eigen::VectorXd::Constant(d + 1, settings.ridge)};
  problem.design.rightCols(d) = detail::as_eigen(columns);
  problem.penalty(0) = settings.intercept_ridge;
  for (Eigen::Index i = 0; i < n; ++i) problem.outcomes(i) = outcomes[static_cast<std::size_t>(i)];
  if (!settings.offset.empty()) problem.offset = detail::as_eigen(settings.offset);
  return problem;
}

Terms terms_at(const Problem& problem, const Eigen::VectorXd& coefficients) {
  const Eigen::VectorXd odds = problem.design * coefficients + problem.offset;
  const Eigen::VectorXd shares = odds.unaryExpr([](double x) { return 1.0 / (1.0 + std::exp(-x)); });
  Terms terms;
  for (Eigen::Index i = 0; i < odds.size(); ++i) {
    // log(1 + e^x) without overflow
    const double log_sum = std::max(odds(i), 0.0) + std::log1p(std::exp(-std::abs(odds(i))));
    terms.log_likelihood += problem.outcomes(i) * odds(i) - log_sum;
  }
  terms.residuals = problem.outcomes - shares;
  terms.gradient = problem.design.transpose() * terms.residuals - problem.penalty.cwiseProduct(coefficients);
  const Eigen::VectorXd weights = shares.array() * (1.0 - shares.array());
  terms.information = problem.design.transpose() * weights.asDiagonal() * problem.design;
  terms.information.diagonal() += problem.penalty;
  return terms;
}

double penalised(const Problem& problem, const Terms& terms, const Eigen::VectorXd& coefficients) {
  return terms.log_likelihood - 0.5 * problem.penalty.dot(coefficients.cwiseAbs2());
}

Eigen::MatrixXd covariance(const Problem& problem, const Terms& terms, std::span<const int> cluster) {
  const Eigen::MatrixXd inverse = detail::inverse_of_symmetric(terms.information);
  if (cluster.empty()) return inverse;
  std::map<int, Eigen::VectorXd> scores;
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    auto [score, fresh] = scores.try_emplace(cluster[i], Eigen::VectorXd::Zero(problem.design.cols()));
    const auto row = static_cast<Eigen::Index>(i);
    score->second += problem.design.row(row).transpose() * terms.residuals(row);
  }
  require(scores.size() > 1, "logistic: fewer than two clusters");
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(inverse.rows(), inverse.cols());
  for (const auto& [name, score] : scores) meat += score * score.transpose();
  const auto n = static_cast<double>(scores.size());
  return inverse * meat * inverse * (n / (n - 1.0));
}

}  // namespace

ExtraTrees ExtraTrees::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                           const ExtraTreesSettings& settings) {
  detail::check_labelled(features, labels, n_classes, 1);
  require(settings.trees > 0 && settings.min_leaf > 0, "extra trees: at least one tree and one row a leaf");
  const GrowingData data = prepare(features, labels, n_classes);
  const auto root = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(features.columns()))));
  const GrowingRules rules{std::min(settings.tries == 0 ? root : settings.tries, features.columns()), settings.min_leaf,
                           settings.seed};
  ExtraTrees forest;
  forest.n_classes_ = n_classes;
  forest.n_columns_ = features.columns();
  forest.importance_.assign(features.columns(), 0.0);
  ordered_parallel<GrownTree>(
      settings.trees, settings.threads,
      [&](std::size_t tree) { return Grower(data, rules, static_cast<std::uint32_t>(tree)).grow(); },
      [&](GrownTree& grown) {
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

LogPool LogPool::fit(std::span<const Matrix<double>> sources, std::span<const int> labels) {
  require(!sources.empty() && !labels.empty(), "pool: no source or no row");
  for (const Matrix<double>& source : sources)
    require(source.rows() == labels.size() && source.columns() == sources[0].columns(), "pool: sizes differ");
  const auto n_sources = static_cast<Eigen::Index>(sources.size());
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(n_sources, 1.0 / static_cast<double>(n_sources));
  LossTerms terms = loss_of(sources, labels, weights);
  for (int iteration = 0; iteration < 50; ++iteration) {
    terms.hessian.diagonal().array() += 1e-9;
    Eigen::VectorXd step = detail::solve_symmetric(terms.hessian, terms.gradient);
    LossTerms next = loss_of(sources, labels, weights - step);
    for (int halving = 0; next.loss > terms.loss && halving < 30; ++halving) {
      step *= 0.5;
      next = loss_of(sources, labels, weights - step);
    }
    if (!(next.loss < terms.loss)) break;
    weights -= step;
    terms = next;
    if (step.norm() < 1e-8) break;
  }
  return LogPool({weights.begin(), weights.end()});
}

std::vector<double> LogPool::combine(std::span<const std::vector<double>> sources) const {
  require(sources.size() == weights_.size() && !sources.empty(), "pool: another number of sources than was fitted");
  Eigen::VectorXd logs = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(sources[0].size()));
  for (std::size_t s = 0; s < sources.size(); ++s)
    for (std::size_t k = 0; k < sources[s].size(); ++k)
      logs(static_cast<Eigen::Index>(k)) += weights_[s] * log_of(sources[s][k]);
  const Eigen::VectorXd shares = softmax(logs);
  return {shares.begin(), shares.end()};
}

Reliability reliability(const Matrix<double>& probabilities, std::span<const int> labels, std::size_t n_bins) {
  require(probabilities.rows() == labels.size() && !labels.empty(), "reliability: rows and labels differ in number");
  require(n_bins > 0, "reliability: no bin");
  Reliability result{std::vector<ReliabilityBin>(n_bins), 0.0};
  for (std::size_t row = 0; row < labels.size(); ++row) {
    const auto shares = probabilities.row(row);
    const auto likeliest = std::max_element(shares.begin(), shares.end());
    const auto place = static_cast<std::size_t>(std::clamp(*likeliest, 0.0, 1.0) * static_cast<double>(n_bins));
    ReliabilityBin& bin = result.bins[std::min(place, n_bins - 1)];
    ++bin.rows;
    bin.mean_probability += *likeliest;
    bin.share_right += likeliest - shares.begin() == labels[row] ? 1.0 : 0.0;
  }
  for (ReliabilityBin& bin : result.bins) {
    result.expected_calibration_error +=
        std::abs(bin.mean_probability - bin.share_right) / static_cast<double>(labels.size());
    if (bin.rows == 0) continue;
    bin.mean_probability /= static_cast<double>(bin.rows);
    bin.share_right /= static_cast<double>(bin.rows);
  }
  return result;
}

PooledClassifier PooledClassifier::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                       const Split& split, const PooledClassifierSettings& settings,
                                       std::span<const int> subclasses) {
  require(labels.size() == features.rows(), "classes: rows and labels differ in number");
  const std::vector<int> fitting_labels = detail::select(labels, split.fitting);
  PooledClassifier fitted;
  {
    const Matrix<float> fitting = features.select_rows(split.fitting);
    const std::vector<int> parts = subclasses.empty() ? fitting_labels : detail::select(subclasses, split.fitting);
    fitted.mixture_ = MixtureDiscriminant::fit(fitting, fitting_labels, n_classes, parts);
    fitted.n_coordinates_ = std::min(settings.coordinates, fitted.mixture_.discriminant().n_directions());
    const Matrix<double> places =
        fitted.mixture_.discriminant().project(fitting, fitted.n_coordinates_, settings.threads);
    fitted.layers_ = NormalLayers::fit(places, fitting_labels, n_classes, settings.layers);
    fitted.trees_ = ExtraTrees::fit(with_coordinates(fitting, places), fitting_labels, n_classes, settings.trees);
  }
  std::vector<Matrix<double>> tables;  // per source (n_calibration_rows x n_classes)
  using Sources = std::vector<std::vector<double>>;
  ordered_parallel<Sources>(
      split.calibration.size(), settings.threads,
      [&](std::size_t i) { return fitted.sources(features.row(split.calibration[i])); },
      [&](Sources& row) {
        tables.resize(row.size());
        for (std::size_t s = 0; s < row.size(); ++s) tables[s].append_row(row[s]);
      });
  fitted.pool_ = LogPool::fit(tables, detail::select(labels, split.calibration));
  for (std::size_t i = 0; i < split.calibration.size(); ++i) {
    Sources row;
    for (const Matrix<double>& table : tables) row.emplace_back(table.row(i).begin(), table.row(i).end());
    fitted.probabilities_.append_row(fitted.pool_.combine(row));
  }
  return fitted;
}

std::vector<std::vector<double>> PooledClassifier::sources(std::span<const float> features) const {
  const std::vector<double> whole = mixture_.discriminant().project(features);
  const auto place = std::span(whole).first(n_coordinates_);
  return {trees_.probabilities(with_coordinates(features, place)), mixture_.probabilities_at(whole),
          detail::softmax(layers_.log_densities(place))};
}

std::vector<double> PooledClassifier::probabilities(std::span<const float> features) const {
  return pool_.combine(sources(features));
}

std::vector<double> PooledClassifier::log_densities(std::span<const float> features) const {
  const std::vector<double> place = mixture_.discriminant().project(features);
  return layers_.log_densities(std::span(place).first(n_coordinates_));
}

Matrix<double> PooledClassifier::log_densities(const Matrix<float>& features, unsigned threads) const {
  return detail::map_rows(features.rows(), static_cast<std::size_t>(n_classes()), threads,
                          [&](std::size_t row) { return log_densities(features.row(row)); });
}

LogisticFit fit_logistic(const Matrix<double>& columns, std::span<const std::uint8_t> outcomes,
                         const LogisticSettings& settings) {
  require(columns.rows() == outcomes.size() && !outcomes.empty(), "logistic: rows and outcomes differ in number");
  require(settings.offset.empty() || settings.offset.size() == outcomes.size(), "logistic: length of the offset");
  require(settings.cluster.empty() || settings.cluster.size() == outcomes.size(), "logistic: length of the clusters");
  require(settings.ridge >= 0.0 && settings.intercept_ridge >= 0.0, "logistic: negative ridge");
  require_finite(columns.values(), "logistic: a number is not finite");
  require_finite(settings.offset, "logistic: a number is not finite");
  for (const std::uint8_t outcome : outcomes) require(outcome <= 1, "logistic: an outcome is neither 0 nor 1");

  const Problem problem = pose(columns, outcomes, settings);
  Eigen::VectorXd at = Eigen::VectorXd::Zero(problem.design.cols());
  Terms terms = terms_at(problem, at);
  constexpr int most_iterations = 60;
  int iteration = 0;
  for (; iteration < most_iterations; ++iteration) {
    Eigen::VectorXd step = detail::solve_symmetric(terms.information, terms.gradient);
    const double before = penalised(problem, terms, at);
    Terms next = terms_at(problem, at + step);
    for (int halving = 0; penalised(problem, next, at + step) < before && halving < 40; ++halving) {
      step *= 0.5;
      next = terms_at(problem, at + step);
    }
    at += step;
    terms = std::move(next);
    if (step.norm() < 1e-9 * (1.0 + at.norm())) break;
  }
  require(iteration < most_iterations && at.allFinite(), "logistic: no maximum (separable outcomes); give a ridge");
  const Eigen::VectorXd errors = covariance(problem, terms, settings.cluster).diagonal().cwiseSqrt();
  return {{at.begin(), at.end()}, {errors.begin(), errors.end()}, terms.log_likelihood};
}

}  // namespace pirsim::stats
