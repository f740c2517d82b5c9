// Extremely randomised trees: which of some classes made this row of features. Ref: [Geurts2006]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::stats {

struct ExtraTreesSettings {
  std::size_t trees = 300;
  std::size_t tries = 0;     ///< columns tried at a node; 0: the square root of their number, rounded up
  std::size_t min_leaf = 3;  ///< fewest rows of a leaf
  std::uint64_t seed = 0;
  unsigned threads = 0;  ///< 0: all cores; never changes the result
};

/// An immutable forest. All rows grow every tree; at a node some columns are tried, each with one random threshold,
/// and the split with the greatest gain in Gini's index is taken. Classes weigh the same however many rows they have.
class ExtraTrees {
 public:
  ExtraTrees() = default;
  /// features: (n_rows x n_columns), finite; labels: (n_rows) in [0, n_classes), each class at least once.
  /// Throws Error(usage) otherwise.
  [[nodiscard]] static ExtraTrees fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                      const ExtraTreesSettings& settings = {});

  /// (n_classes) mean over trees of the leaf's class shares; sums to 1.
  [[nodiscard]] std::vector<double> probabilities(std::span<const float> features) const;
  /// (n_rows x n_classes)
  [[nodiscard]] Matrix<double> probabilities(const Matrix<float>& features, unsigned threads = 0) const;
  /// (n_columns) share of the total gain that each column's splits made; sums to 1 unless no tree has a split.
  [[nodiscard]] const std::vector<double>& importance() const noexcept { return importance_; }
  [[nodiscard]] int n_classes() const noexcept { return n_classes_; }

  bool operator==(const ExtraTrees&) const = default;

  /// One tree as arrays over its nodes; node 0 is the root.
  struct Tree {
    std::vector<std::int32_t> column;    ///< of a leaf: minus how many classes it holds
    std::vector<float> threshold;        ///< rows with a value <= it go to node `next`, others to `next + 1`
    std::vector<std::uint32_t> next;     ///< of a leaf: where its classes begin
    std::vector<std::uint16_t> classes;  ///< of all leaves, one after another
    std::vector<float> shares;           ///< beside `classes`
    bool operator==(const Tree&) const = default;
  };

 private:
  int n_classes_ = 0;
  std::size_t n_columns_ = 0;
  std::vector<Tree> trees_;
  std::vector<double> importance_;
};

}  // namespace pirsim::stats

namespace pirsim::stats::detail {

// Grows one randomised tree.

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

[[nodiscard]] GrowingData prepare(const Matrix<float>& features, std::span<const int> labels, int n_classes);
[[nodiscard]] GrownTree grow(const GrowingData& data, const GrowingRules& rules, std::uint32_t index);

}  // namespace pirsim::stats::detail
