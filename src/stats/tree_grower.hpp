// Grows one randomised tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/extra_trees.hpp"

namespace pirsim::stats::detail {

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
