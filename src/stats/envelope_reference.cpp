#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/envelope.hpp"
#include "stats/kit.hpp"
#include "stats/pointwise_rank.hpp"

namespace pirsim::stats {
namespace {

constexpr double rounding = 1e-6;  ///< of ranks; rows this near to a bound are looked at

/// Sorted values with one more put in.
struct Inserted {
  std::span<const double> sorted;
  std::size_t at = 0;
  double value = 0.0;
  double operator[](std::size_t i) const { return i < at ? sorted[i] : i == at ? value : sorted[i - 1]; }
};

}  // namespace

/// One entry's ranks once the observed value is among them. Values above it move up by one; only its neighbours, and
/// the values at both ends, which a continuous rank looks at, need ranks of their own.
struct EnvelopeReference::Column {
  struct Special {
    double value = std::nan(""), rank = 0.0;
  };
  double observed = 0.0, own_rank = 0.0;
  Special first, before, after, last;

  [[nodiscard]] double rank(double value, double among_simulated) const {
    if (value == observed) return own_rank;
    if (value < observed) {
      if (value == before.value) return before.rank;
      return value == first.value ? first.rank : among_simulated;
    }
    if (value == after.value) return after.rank;
    return value == last.value ? last.rank : among_simulated + 1.0;
  }
};

EnvelopeReference::EnvelopeReference(Matrix<double> simulated, PointwiseRank rank)
    : simulated_(std::move(simulated)),
      sorted_(simulated_.columns(), simulated_.rows()),
      from_below_(simulated_.rows(), simulated_.columns()),
      least_(simulated_.rows(), std::numeric_limits<double>::infinity()),
      rank_(rank) {
  require(rank != PointwiseRank::random_ties, "envelope: a reference can't put ties in random order");
  require(simulated_.rows() > 1, "envelope: fewer than two simulated rows");
  require(simulated_.columns() > 0, "envelope: nothing to compare");
  require_finite(simulated_.values(), "envelope: a simulated statistic is not finite");
  const std::size_t n = simulated_.rows();
  std::vector<double> values(n);
  for (std::size_t c = 0; c < simulated_.columns(); ++c) {
    for (std::size_t r = 0; r < n; ++r) values[r] = simulated_(r, c);
    std::sort(values.begin(), values.end());
    std::copy(values.begin(), values.end(), sorted_.row(c).begin());
    std::vector<double> ranks(n);  // of values[i]
    detail::for_each_tie(values, [&](std::size_t begin, std::size_t end) {
      std::fill(ranks.begin() + static_cast<std::ptrdiff_t>(begin), ranks.begin() + static_cast<std::ptrdiff_t>(end),
                detail::shared_rank(rank_, values, n, begin, end));
    });
    for (std::size_t r = 0; r < n; ++r) {
      const auto i = std::lower_bound(values.begin(), values.end(), simulated_(r, c)) - values.begin();
      const double below = from_below_(r, c) = ranks[static_cast<std::size_t>(i)];
      least_[r] = std::min({least_[r], below, detail::top_rank(rank_, n) - below});
    }
  }
}

EnvelopeReference::Column EnvelopeReference::insert(std::size_t entry, double observed) const {
  const std::span<const double> sorted = sorted_.row(entry);
  const std::size_t n = sorted.size() + 1;
  const auto lower = static_cast<std::size_t>(std::ranges::lower_bound(sorted, observed) - sorted.begin());
  const auto upper = static_cast<std::size_t>(std::ranges::upper_bound(sorted, observed) - sorted.begin());
  const Inserted all{sorted, lower, observed};
  Column column;
  column.observed = observed;
  column.own_rank = detail::shared_rank(rank_, all, n, lower, upper + 1);
  /// Of the simulated value sorted[i], which differs from the observed one.
  const auto special = [&](std::size_t i) {
    const std::size_t shift = i < lower ? 0 : 1;
    const auto tied = std::equal_range(sorted.begin(), sorted.end(), sorted[i]);
    return Column::Special{
        sorted[i], detail::shared_rank(rank_, all, n, static_cast<std::size_t>(tied.first - sorted.begin()) + shift,
                                       static_cast<std::size_t>(tied.second - sorted.begin()) + shift)};
  };
  if (lower > 0) {
    column.first = special(0);
    column.before = special(lower - 1);
  }
  if (upper < sorted.size()) {
    column.after = special(upper);
    column.last = special(sorted.size() - 1);
  }
  return column;
}

double EnvelopeReference::p(std::span<const double> observed) const {
  require(observed.size() == simulated_.columns(), "envelope: observed and simulated rows differ in length");
  require_finite(observed, "envelope: an observed statistic is not finite");
  const double top = detail::top_rank(rank_, simulated_.rows() + 1);
  std::vector<Column> columns;
  std::vector<double> own;  // the observed row's pointwise ranks, smallest first
  for (std::size_t c = 0; c < observed.size(); ++c) {
    columns.push_back(insert(c, observed[c]));
    own.push_back(std::min(columns.back().own_rank, top - columns.back().own_rank));
  }
  std::sort(own.begin(), own.end());
  const auto rank_of = [&](std::size_t r, std::size_t c) {
    const double rank = columns[c].rank(simulated_(r, c), from_below_(r, c));
    return std::min(rank, top - rank);
  };
  std::size_t as_extreme = 1;  // the observed row itself
  std::vector<double> ranks(observed.size());
  for (std::size_t r = 0; r < simulated_.rows(); ++r) {
    // One value more lowers no rank, counted from either end, and raises it by two at most.
    if (least_[r] > own[0] + rounding) continue;
    if (least_[r] + 2.0 < own[0] - rounding) {
      ++as_extreme;
      continue;
    }
    double smallest = top;
    for (std::size_t c = 0; c < observed.size() && smallest >= own[0]; ++c)
      smallest = std::min(smallest, rank_of(r, c));
    if (smallest > own[0]) continue;
    if (smallest == own[0]) {
      for (std::size_t c = 0; c < observed.size(); ++c) ranks[c] = rank_of(r, c);
      std::sort(ranks.begin(), ranks.end());
      if (ranks > own) continue;
    }
    ++as_extreme;
  }
  return static_cast<double>(as_extreme) / static_cast<double>(simulated_.rows() + 1);
}

}  // namespace pirsim::stats
