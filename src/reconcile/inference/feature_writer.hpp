// Features as they are written, one after the other. Private to reconcile.
#pragma once

#include <array>
#include <numeric>
#include <vector>

#include "reconcile/inference/feature_map.hpp"

namespace pirsim::reconcile {

/// Those before `end`, in order.
template <auto end>
[[nodiscard]] constexpr auto statistics_before() {
  std::array<decltype(end), static_cast<std::size_t>(end)> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<decltype(end)>(k);
  return all;
}
/// Statistics that are looked at as they are; those after them are parts of the time.
inline constexpr auto told_of_cells = statistics_before<CellStatistic::sixth_1>();
inline constexpr auto told_of_trials = statistics_before<TrialStatistic::slice_1>();

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
