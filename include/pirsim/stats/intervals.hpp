// How sure a number is: intervals of shares, of any statistic of resampled blocks, and the sign test.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace pirsim::stats {

struct Interval {
  double low = 0.0, high = 0.0;
  [[nodiscard]] bool contains(double value) const noexcept { return low <= value && value <= high; }
  bool operator==(const Interval&) const = default;
};

/// Quantile of a sample that needn't be sorted, linear between order statistics (type 7 of [Hyndman1996]).
/// probability in [0, 1]. Throws Error(usage) for an empty sample.
[[nodiscard]] double quantile(std::span<const double> sample, double probability);
/// The same of an ascending sample.
[[nodiscard]] double sorted_quantile(std::span<const double> sample, double probability);

/// Exact interval of a probability after `hits` of `trials` (1 or more), at least `confidence` sure.
/// Ref: [ClopperPearson1934]
[[nodiscard]] Interval clopper_pearson(std::size_t hits, std::size_t trials, double confidence = 0.95);

/// P(at least `positive` of `positive + negative` signs are positive) if both signs are equally likely; zeros are to be
/// left out by the caller. 1 without any sign.
[[nodiscard]] double sign_test_greater(std::size_t positive, std::size_t negative);
/// The same for either direction: twice the smaller tail, at most 1.
[[nodiscard]] double sign_test_two_sided(std::size_t positive, std::size_t negative);

enum class BootstrapKind {
  percentile,
  bca,  ///< bias-corrected and accelerated; the acceleration from the jackknife. Ref: [Efron1987]
};

struct BootstrapSettings {
  double confidence = 0.95;
  std::size_t samples = 2000;
  BootstrapKind kind = BootstrapKind::bca;
  std::uint64_t seed = 0;
  unsigned threads = 0;  ///< 0: all cores; never changes the result
};

/// A statistic of the blocks of the given indices; an index may occur several times. Called from several threads.
using BlockStatistic = std::function<double(std::span<const std::size_t> blocks)>;

/// Interval of a statistic of `n_blocks` (2 or more) independent blocks, trials for example, drawn with replacement.
/// Blocks keep what is dependent together; with few blocks (10, say) any bootstrap interval is somewhat too short.
[[nodiscard]] Interval block_bootstrap(std::size_t n_blocks, const BlockStatistic& statistic,
                                       const BootstrapSettings& settings = {});

}  // namespace pirsim::stats
