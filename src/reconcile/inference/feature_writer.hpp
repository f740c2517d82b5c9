// Features as they are written, one after the other. Private to reconcile.
#pragma once

#include <numeric>
#include <vector>

#include "reconcile/inference/feature_map.hpp"

namespace pirsim::reconcile {

/// Statistics that are looked at as they are; those after them are parts of the time.
constexpr auto n_told_of_cells = static_cast<std::size_t>(CellStatistic::sixth_1);
constexpr auto n_told_of_trials = static_cast<std::size_t>(TrialStatistic::slice_1);

/// Deviations in units of the plain model's scatter, drawn in at the ends: of what is told of the trials looked at.
struct FeatureMap::Scaled {
  std::vector<double> values;  ///< (n_statistics) 0 where nobody looks
};

/// Numbers in the order in which they come; their names too when those are wanted.
struct FeatureMap::Writer {
  std::vector<float> values;
  std::vector<FeatureName>* names = nullptr;
  std::vector<std::size_t>* envelope = nullptr;
  std::vector<std::vector<std::size_t>>* blocks = nullptr;

  /// What has been added since the last block was ended is one.
  void end_block() {
    if (blocks == nullptr || values.size() == ended) return;
    blocks->emplace_back(values.size() - ended);
    std::iota(blocks->back().begin(), blocks->back().end(), ended);
    ended = values.size();
  }
  /// Whatever is added next is part of the global test.
  void test_next() {
    if (envelope != nullptr) envelope->push_back(values.size());
  }
  template <typename Name>
  void add(double value, const Name& name) {
    values.push_back(static_cast<float>(value));
    if (names != nullptr) names->push_back(name());
  }

 private:
  std::size_t ended = 0;  ///< number of values in blocks
};

}  // namespace pirsim::reconcile
