#include "stats/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"
#include "pirsim/random.hpp"
#include "stats/kit.hpp"
#include "stats/pointwise_rank.hpp"

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

}  // namespace pirsim::stats
