// Ranks of the values of one entry of a global envelope test, from the smallest up.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "stats/envelope.hpp"

namespace pirsim::stats::detail {

/// Calls use(begin, end) for every run of equal values.
template <typename Use>
void for_each_tie(const std::vector<double>& sorted, const Use& use) {
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && sorted[end] == sorted[begin]) ++end;
    use(begin, end);
  }
}

/// The rank from the largest value down is this less the rank from below. n: number of values.
inline double top_rank(PointwiseRank kind, std::size_t n) {
  return kind == PointwiseRank::continuous ? double(n) : double(n + 1);
}

/// Place of sorted[i] between its neighbours, in (0, n). Ref: [Hahn2015] in the form of [Myllymaki2024].
template <typename Sorted>
double continuous_rank(const Sorted& sorted, std::size_t n, std::size_t i) {
  const std::size_t last = n - 1;
  if (i == 0) return std::exp(-(sorted[1] - sorted[0]) / (sorted[last] - sorted[1]));
  if (i == last) {
    return static_cast<double>(n) - std::exp(-(sorted[last] - sorted[last - 1]) / (sorted[last - 1] - sorted[0]));
  }
  return static_cast<double>(i) + (sorted[i] - sorted[i - 1]) / (sorted[i + 1] - sorted[i - 1]);
}

/// Rank of each of the equal values sorted[begin] to sorted[end - 1]. kind: not random_ties. Of a tied pair the formula
/// of continuous_rank gives the middle too, except at an end.
template <typename Sorted>
double shared_rank(PointwiseRank kind, const Sorted& sorted, std::size_t n, std::size_t begin, std::size_t end) {
  if (kind == PointwiseRank::middle_ties) return 0.5 * static_cast<double>(begin + 1 + end);
  return end - begin > 1 ? 0.5 * static_cast<double>(begin + end) : continuous_rank(sorted, n, begin);
}

}  // namespace pirsim::stats::detail
