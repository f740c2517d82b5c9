// The global envelope test: how extreme each curve is anywhere, and among all curves.
#include "stats/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include "core/parallel.hpp"
#include "pirsim/random.hpp"
#include "stats/kit.hpp"

// Ranks of the values of one entry, from the smallest up.

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

namespace pirsim::stats {
namespace {

/// Ranks of a column from its smallest value up; the rank from the largest down is top - rank.
struct ColumnRanks {
  std::vector<double> from_below;  ///< (n_rows)
  double top = 0.0;
};

ColumnRanks rank_column(const std::vector<double>& values, PointwiseRank kind, Stream stream) {
  const std::size_t n = values.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::uint32_t> lot(n, 0);
  if (kind == PointwiseRank::random_ties) std::generate(lot.begin(), lot.end(), [&] { return stream.next_u32(); });
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (values[a] != values[b]) return values[a] < values[b];
    return lot[a] != lot[b] ? lot[a] < lot[b] : a < b;
  });
  std::vector<double> sorted(n);
  for (std::size_t i = 0; i < n; ++i) sorted[i] = values[order[i]];

  ColumnRanks ranks{std::vector<double>(n), detail::top_rank(kind, n)};
  detail::for_each_tie(sorted, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ranks.from_below[order[i]] = kind == PointwiseRank::random_ties
                                       ? static_cast<double>(i + 1)
                                       : detail::shared_rank(kind, sorted, sorted.size(), begin, end);
    }
  });
  return ranks;
}

/// Ranks of every entry from either side; small is extreme.
struct SideRanks {
  Matrix<double> low, high;
};

SideRanks rank_sides(const Matrix<double>& rows, const EnvelopeSettings& settings) {
  SideRanks sides{Matrix<double>(rows.rows(), rows.columns()), Matrix<double>(rows.rows(), rows.columns())};
  std::size_t column = 0;
  const auto rank = [&](std::size_t c) {
    std::vector<double> values(rows.rows());
    for (std::size_t r = 0; r < rows.rows(); ++r) values[r] = rows(r, c);
    return rank_column(values, settings.rank,
                       Stream({settings.seed, 0, static_cast<std::uint32_t>(c), Purpose::tied_ranks}));
  };
  const auto store = [&](ColumnRanks& ranks) {
    for (std::size_t r = 0; r < rows.rows(); ++r) {
      sides.low(r, column) = ranks.from_below[r];
      sides.high(r, column) = ranks.top - ranks.from_below[r];
    }
    ++column;
  };
  ordered_parallel<ColumnRanks>(rows.columns(), settings.threads, rank, store);
  return sides;
}

/// (n_rows x n_columns) per row its pointwise ranks from the nearer side, smallest first.
Matrix<double> sorted_ranks(const SideRanks& sides) {
  Matrix<double> sorted = sides.low;
  for (std::size_t i = 0; i < sorted.values().size(); ++i)
    sorted.values()[i] = std::min(sorted.values()[i], sides.high.values()[i]);
  for (std::size_t r = 0; r < sorted.rows(); ++r) std::sort(sorted.row(r).begin(), sorted.row(r).end());
  return sorted;
}

std::vector<double> share_at_least_as_extreme(const Matrix<double>& sorted) {
  const std::size_t n = sorted.rows();
  const auto less = [&](std::size_t a, std::size_t b) {
    const auto x = sorted.row(a), y = sorted.row(b);
    return std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end());
  };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), less);
  std::vector<double> share(n);
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    while (end < n && !less(order[begin], order[end])) ++end;
    for (std::size_t i = begin; i < end; ++i) share[order[i]] = static_cast<double>(end) / static_cast<double>(n);
  }
  return share;
}

/// The envelope excludes the first row's entry once all rows at least as far out as it on that side are cut away.
double adjusted_p(const Matrix<double>& side, const std::vector<double>& p, std::size_t column) {
  double largest = 0.0;
  for (std::size_t r = 0; r < side.rows(); ++r)
    if (side(r, column) <= side(0, column)) largest = std::max(largest, p[r]);
  return largest;
}

double median_without_first(const Matrix<double>& rows, std::size_t column) {
  std::vector<double> values;
  for (std::size_t r = 1; r < rows.rows(); ++r) values.push_back(rows(r, column));
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

void draw_envelope(const Matrix<double>& rows, const std::vector<double>& p, double alpha, GlobalEnvelope& envelope) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  envelope.lower.assign(rows.columns(), infinity);
  envelope.upper.assign(rows.columns(), -infinity);
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    if (p[r] <= alpha) continue;
    for (std::size_t c = 0; c < rows.columns(); ++c) {
      envelope.lower[c] = std::min(envelope.lower[c], rows(r, c));
      envelope.upper[c] = std::max(envelope.upper[c], rows(r, c));
    }
  }
}

}  // namespace

GlobalEnvelope global_envelope_test(std::span<const double> observed, const Matrix<double>& simulated,
                                    const EnvelopeSettings& settings) {
  require(simulated.rows() > 0, "envelope: no simulated row");
  require(simulated.columns() > 0, "envelope: nothing to compare");
  require(observed.size() == simulated.columns(), "envelope: observed and simulated rows differ in length");
  require(settings.alpha > 0.0 && settings.alpha < 1.0, "envelope: alpha must lie between 0 and 1");
  require_finite(observed, "envelope: an observed statistic is not finite");
  require_finite(simulated.values(), "envelope: a simulated statistic is not finite");
  Matrix<double> rows(simulated.rows() + 1, observed.size());
  std::copy(observed.begin(), observed.end(), rows.values().begin());
  std::copy(simulated.values().begin(), simulated.values().end(), rows.row(1).data());

  const SideRanks sides = rank_sides(rows, settings);
  const std::vector<double> p = share_at_least_as_extreme(sorted_ranks(sides));
  GlobalEnvelope envelope;
  envelope.p = p[0];
  for (std::size_t c = 0; c < rows.columns(); ++c) {
    envelope.adjusted_p.push_back(std::min(adjusted_p(sides.low, p, c), adjusted_p(sides.high, p, c)));
    envelope.median.push_back(median_without_first(rows, c));
  }
  draw_envelope(rows, p, settings.alpha, envelope);
  return envelope;
}

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
