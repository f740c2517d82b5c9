// Features as they are written, one after the other. Private to reconcile.
#pragma once

#include <numeric>
#include <string>
#include <vector>

#include "pirsim/reconcile/feature_map.hpp"

namespace pirsim::reconcile {

/// Deviations in units of the plain model's scatter, drawn in at the ends.
struct FeatureMap::Scaled {
  std::vector<double> values;  ///< (n_statistics)
};

/// Numbers in the order in which they come; their names too when those are wanted.
struct FeatureMap::Writer {
  std::vector<float> values;
  std::vector<std::string>* names = nullptr;
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
