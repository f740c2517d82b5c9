#include "stats/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include "model/core/parallel.hpp"
#include "stats/linear_algebra.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {
namespace {

using detail::as_eigen;

std::vector<double> sorted(std::span<const double> values) {
  std::vector<double> copy(values.begin(), values.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

double distance(std::span<const double> a, std::span<const double> b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squares);
}

double median(std::vector<double> values) { return stats::quantile(values, 0.5); }

/// Median absolute deviation of each column from its median; 1 where that is 0.
std::vector<double> column_scales(const Matrix<double>& rows) {
  std::vector<double> scales;
  for (std::size_t c = 0; c < rows.columns(); ++c) {
    std::vector<double> values = rows.column(c);
    const double centre = median(values);
    for (double& value : values) value = std::abs(value - centre);
    const double scale = median(std::move(values));
    scales.push_back(scale > 0.0 ? scale : 1.0);
  }
  return scales;
}

/// log((x - low) / (high - x)); a value at the very border is moved off it by a billionth of the range.
double to_open(double value, const Interval& bounds) {
  const double share = std::clamp((value - bounds.low) / (bounds.high - bounds.low), 1e-9, 1.0 - 1e-9);
  return std::log(share / (1.0 - share));
}
double from_open(double value, const Interval& bounds) {
  return bounds.low + (bounds.high - bounds.low) / (1.0 + std::exp(-value));
}

struct Accepted {
  std::vector<std::size_t> rows;
  std::vector<double> weights;  ///< sum 1
};

Accepted accept_nearest(const Matrix<double>& statistics, std::span<const double> observed, double share) {
  const std::vector<double> scales = column_scales(statistics);
  std::vector<double> distances(statistics.rows(), 0.0);
  for (std::size_t r = 0; r < statistics.rows(); ++r) {
    for (std::size_t c = 0; c < observed.size(); ++c)
      distances[r] += std::pow((statistics(r, c) - observed[c]) / scales[c], 2);
    distances[r] = std::sqrt(distances[r]);
  }
  Accepted accepted;
  accepted.rows = numbers_to(statistics.rows());
  std::stable_sort(accepted.rows.begin(), accepted.rows.end(),
                   [&](std::size_t a, std::size_t b) { return distances[a] < distances[b]; });
  const auto kept = static_cast<std::size_t>(std::ceil(share * static_cast<double>(statistics.rows())));
  accepted.rows.resize(std::min(kept, statistics.rows()));
  // The widest is just beyond the last row, so that every kept row has a weight.
  const double widest = distances[accepted.rows.back()] * (1.0 + 1e-6) + std::numeric_limits<double>::min();
  double sum = 0.0;
  for (const std::size_t row : accepted.rows) {
    accepted.weights.push_back(1.0 - std::pow(distances[row] / widest, 2));
    sum += accepted.weights.back();
  }
  for (double& weight : accepted.weights) weight /= sum;
  return accepted;
}

/// Each parameter's regression on the statistics, taken at the observed ones, plus the rows' residuals.
Eigen::MatrixXd adjust(const Eigen::MatrixXd& parameters, const Eigen::MatrixXd& off, const Eigen::VectorXd& weights) {
  Eigen::MatrixXd design(off.rows(), off.cols() + 1);
  design << Eigen::VectorXd::Ones(off.rows()), off;
  const Eigen::VectorXd root = weights.cwiseSqrt();
  const Eigen::MatrixXd coefficients =
      detail::least_squares(root.asDiagonal() * design, root.asDiagonal() * parameters);
  return parameters - off * coefficients.bottomRows(off.cols());
}

// How extreme each row is in any entry: ranks of the values of one entry, from the smallest up.

/// Calls use(begin, end) for every run of equal values.
template <typename Use>
void for_each_tie(const std::vector<double>& sorted, const Use& use) {
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && sorted[end] == sorted[begin]) ++end;
    use(begin, end);
  }
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

/// Rank of each of the equal values sorted[begin] to sorted[end - 1]. Of a tied pair the formula of continuous_rank
/// gives the middle too, except at an end.
template <typename Sorted>
double shared_rank(const Sorted& sorted, std::size_t n, std::size_t begin, std::size_t end) {
  return end - begin > 1 ? 0.5 * static_cast<double>(begin + end) : continuous_rank(sorted, n, begin);
}

/// (n_rows) Ranks from the smallest value up; from the largest down they are n_rows less these.
std::vector<double> ranks_of(const std::vector<double>& values) {
  const std::vector<double> ascending = sorted(values);
  std::vector<double> ranks(values.size());
  for_each_tie(ascending, [&](std::size_t begin, std::size_t end) {
    std::fill(ranks.begin() + static_cast<std::ptrdiff_t>(begin), ranks.begin() + static_cast<std::ptrdiff_t>(end),
              shared_rank(ascending, ascending.size(), begin, end));
  });
  std::vector<double> of_values;
  for (const double value : values)
    of_values.push_back(
        ranks[static_cast<std::size_t>(std::ranges::lower_bound(ascending, value) - ascending.begin())]);
  return of_values;
}

/// Ranks of every entry from below.
Matrix<double> rank_columns(const Matrix<double>& rows, unsigned threads) {
  Matrix<double> from_below(rows.rows(), rows.columns());
  std::size_t column = 0;
  ordered_parallel<std::vector<double>>(
      rows.columns(), threads, [&](std::size_t c) { return ranks_of(rows.column(c)); },
      [&](std::vector<double>& ranks) {
        for (std::size_t r = 0; r < rows.rows(); ++r) from_below(r, column) = ranks[r];
        ++column;
      });
  return from_below;
}

/// (n_rows x n_columns) per row its pointwise ranks from the nearer side, smallest first.
Matrix<double> sorted_ranks(const Matrix<double>& from_below) {
  Matrix<double> sorted = from_below;
  const auto n = static_cast<double>(sorted.rows());
  for (double& rank : sorted.values()) rank = std::min(rank, n - rank);
  for (std::size_t r = 0; r < sorted.rows(); ++r) std::sort(sorted.row(r).begin(), sorted.row(r).end());
  return sorted;
}

std::vector<double> share_at_least_as_extreme(const Matrix<double>& sorted) {
  const std::size_t n = sorted.rows();
  const auto less = [&](std::size_t a, std::size_t b) {
    const auto x = sorted.row(a), y = sorted.row(b);
    return std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end());
  };
  std::vector<std::size_t> order = numbers_to(n);
  std::sort(order.begin(), order.end(), less);
  std::vector<double> share(n);
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    while (end < n && !less(order[begin], order[end])) ++end;
    for (std::size_t i = begin; i < end; ++i) share[order[i]] = static_cast<double>(end) / static_cast<double>(n);
  }
  return share;
}

/// The envelope excludes the first row's entry once all rows at least as far out as it on that side are cut away.
double adjusted_p(const Matrix<double>& from_below, const std::vector<double>& p, std::size_t column) {
  const auto n = static_cast<double>(from_below.rows());
  const double own = from_below(0, column);
  double below = 0.0, above = 0.0;
  for (std::size_t r = 0; r < from_below.rows(); ++r) {
    if (from_below(r, column) <= own) below = std::max(below, p[r]);
    if (n - from_below(r, column) <= n - own) above = std::max(above, p[r]);
  }
  return std::min(below, above);
}

double median_without_first(const Matrix<double>& rows, std::size_t column) {
  std::vector<double> values = rows.column(column);
  values.erase(values.begin());
  std::ranges::sort(values);
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

constexpr double rounding = 1e-6;  ///< of ranks; rows this near to a bound are looked at

/// Sorted values with one more put in.
struct Inserted {
  std::span<const double> sorted;
  std::size_t at = 0;
  double value = 0.0;
  double operator[](std::size_t i) const { return i < at ? sorted[i] : i == at ? value : sorted[i - 1]; }
};

}  // namespace

double quantile(std::span<const double> sample, double probability) {
  return sorted_quantile(sorted(sample), probability);
}

double sorted_quantile(std::span<const double> sample, double probability) {
  require(!sample.empty(), "quantile: empty sample");
  require(probability >= 0.0 && probability <= 1.0, "quantile: probability outside [0, 1]");
  const double place = probability * static_cast<double>(sample.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sample.size() - 1);
  return sample[below] + (place - static_cast<double>(below)) * (sample[above] - sample[below]);
}

Interval clopper_pearson(std::size_t hits, std::size_t trials, double confidence) {
  require(trials > 0 && hits <= trials, "clopper_pearson: hits must lie between 0 and a positive number of trials");
  require(confidence > 0.0 && confidence < 1.0, "clopper_pearson: confidence must lie between 0 and 1");
  const double tail = 0.5 * (1.0 - confidence);
  const auto n = static_cast<double>(trials), k = static_cast<double>(hits);
  return {hits == 0 ? 0.0 : boost::math::binomial_distribution<>::find_lower_bound_on_p(n, k, tail),
          hits == trials ? 1.0 : boost::math::binomial_distribution<>::find_upper_bound_on_p(n, k, tail)};
}

double sign_test_greater(std::size_t positive, std::size_t negative) {
  if (positive == 0) return 1.0;
  const boost::math::binomial_distribution<> signs(static_cast<double>(positive + negative), 0.5);
  return boost::math::cdf(boost::math::complement(signs, static_cast<double>(positive) - 1.0));
}

Interval mean_interval(std::span<const double> values, double confidence) {
  require(values.size() > 1, "mean_interval: fewer than two values");
  require(confidence > 0.0 && confidence < 1.0, "mean_interval: confidence must lie between 0 and 1");
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const boost::math::students_t_distribution<> student(n - 1.0);
  const double reach = boost::math::quantile(boost::math::complement(student, 0.5 * (1.0 - confidence))) *
                       std::sqrt(squares / (n - 1.0) / n);
  return {mean - reach, mean + reach};
}

double energy_score(const Matrix<double>& ensemble, std::span<const double> observed) {
  require(ensemble.rows() > 0, "energy_score: no member");
  require(ensemble.columns() == observed.size(), "energy_score: members and observation differ in length");
  const auto n = static_cast<double>(ensemble.rows());
  double error = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < ensemble.rows(); ++i) {
    error += distance(ensemble.row(i), observed);
    for (std::size_t j = 0; j < i; ++j) pairs += distance(ensemble.row(i), ensemble.row(j));
  }
  return error / n - pairs / (n * n);
}

double area_between(std::span<const double> a, std::span<const double> b) {
  require(!a.empty() && !b.empty(), "area_between: empty sample");
  const std::vector<double> x = sorted(a), y = sorted(b);
  double area = 0.0, at = std::min(x.front(), y.front());
  for (std::size_t i = 0, j = 0; i < x.size() || j < y.size();) {
    const double next = j == y.size() || (i < x.size() && x[i] <= y[j]) ? x[i] : y[j];
    const double height =
        static_cast<double>(i) / static_cast<double>(x.size()) - static_cast<double>(j) / static_cast<double>(y.size());
    area += std::abs(height) * (next - at);
    at = next;
    while (i < x.size() && x[i] == next) ++i;
    while (j < y.size() && y[j] == next) ++j;
  }
  return area;
}

ParameterEstimator ParameterEstimator::fit(const Matrix<double>& statistics, const Matrix<double>& parameters) {
  require(statistics.rows() == parameters.rows() && statistics.rows() > 1,
          "estimate: rows differ in number or are too few");
  require_finite(statistics.values(), "estimate: a statistic is not finite");
  require_finite(parameters.values(), "estimate: a parameter is not finite");
  const Eigen::RowVectorXd mean = as_eigen(statistics).colwise().mean();
  Eigen::MatrixXd centred = as_eigen(statistics).rowwise() - mean;
  const Eigen::RowVectorXd sd = (centred.colwise().squaredNorm() / static_cast<double>(statistics.rows())).cwiseSqrt();
  const Eigen::RowVectorXd inverse = sd.unaryExpr([](double x) { return x > 1e-12 ? 1.0 / x : 0.0; });
  centred.array().rowwise() *= inverse.array();
  const Eigen::RowVectorXd parameter_mean = as_eigen(parameters).colwise().mean();
  const Eigen::MatrixXd targets = as_eigen(parameters).rowwise() - parameter_mean;

  const auto [u, s, v] = detail::singular_values(centred, detail::Sides::both);
  const Eigen::ArrayXd squares = s.array().square();
  const Eigen::MatrixXd rotated = u.transpose() * targets;
  const auto n = static_cast<double>(statistics.rows());

  ParameterEstimator estimate;
  estimate.slopes_ = Matrix<double>(parameters.columns(), statistics.columns());
  for (Eigen::Index p = 0; p < targets.cols(); ++p) {
    double best_score = std::numeric_limits<double>::infinity();
    Eigen::ArrayXd best_shrink = Eigen::ArrayXd::Zero(squares.size());
    for (double exponent = -6.0; exponent <= 3.0; exponent += 0.5) {
      const Eigen::ArrayXd shrink = squares / (squares + n * std::pow(10.0, exponent));
      const double fitted = (rotated.col(p).array().square() * shrink * (2.0 - shrink)).sum();
      const double left = 1.0 - (1.0 + shrink.sum()) / n;  // share of the degrees of freedom; one is the mean's
      if (left <= 0.0) continue;
      const double score = std::max(0.0, targets.col(p).squaredNorm() - fitted) / (left * left);
      if (score < best_score) {
        best_score = score;
        best_shrink = shrink;
      }
    }
    const Eigen::ArrayXd safe = (squares > 1e-12 * squares(0)).select(s.array(), 1.0);
    const Eigen::VectorXd slopes =
        v * ((squares > 1e-12 * squares(0)).select(best_shrink / safe, 0.0) * rotated.col(p).array()).matrix();
    const Eigen::VectorXd scaled = slopes.cwiseProduct(inverse.transpose());
    std::copy(scaled.begin(), scaled.end(), estimate.slopes_.row(static_cast<std::size_t>(p)).begin());
    estimate.intercept_.push_back(parameter_mean(p) - mean.dot(scaled));
  }
  return estimate;
}

std::vector<double> ParameterEstimator::estimate(std::span<const double> statistics) const {
  require(statistics.size() == slopes_.columns(), "estimate: another number of statistics than was fitted");
  std::vector<double> values = intercept_;
  for (std::size_t p = 0; p < values.size(); ++p)
    values[p] += std::inner_product(statistics.begin(), statistics.end(), slopes_.row(p).begin(), 0.0);
  return values;
}

double AbcPosterior::quantile(std::size_t parameter, double probability) const {
  std::vector<std::size_t> order = numbers_to(values.rows());
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values(a, parameter) < values(b, parameter); });
  // Each value stands in the middle of its weight; between two of them the quantile is linear.
  double below = 0.0, last_place = 0.0, last_value = values(order[0], parameter);
  for (const std::size_t row : order) {
    const double place = below + 0.5 * weights[row], value = values(row, parameter);
    if (place >= probability)
      return place > last_place ? last_value + (value - last_value) * (probability - last_place) / (place - last_place)
                                : value;
    below += weights[row];
    last_place = place;
    last_value = value;
  }
  return last_value;
}

Interval AbcPosterior::interval(std::size_t parameter, double confidence, double widening) const {
  const double centre = quantile(parameter, 0.5), tail = 0.5 * (1.0 - confidence);
  return {centre + widening * (quantile(parameter, tail) - centre),
          centre + widening * (quantile(parameter, 1.0 - tail) - centre)};
}

AbcPosterior abc_posterior(const Matrix<double>& parameters, const Matrix<double>& statistics,
                           std::span<const double> observed, const AbcSettings& settings) {
  require(parameters.rows() == statistics.rows() && parameters.rows() > 0, "abc: rows differ in number");
  require(observed.size() == statistics.columns(), "abc: observed and simulated statistics differ in number");
  require(settings.bounds.empty() || settings.bounds.size() == parameters.columns(), "abc: bounds per parameter");
  require(settings.accepted > 0.0 && settings.accepted <= 1.0, "abc: accepted share outside (0, 1]");
  require_finite(statistics.values(), "abc: a statistic is not finite");
  require_finite(observed, "abc: a statistic is not finite");
  Accepted accepted = accept_nearest(statistics, observed, settings.accepted);
  require(accepted.rows.size() >= observed.size() + 2, "abc: too few accepted rows for this many statistics");

  const Matrix<double> kept_parameters = parameters.select_rows(accepted.rows);
  const Matrix<double> kept_statistics = statistics.select_rows(accepted.rows);
  Eigen::MatrixXd values = as_eigen(kept_parameters);
  for (std::size_t p = 0; p < settings.bounds.size(); ++p)
    for (double& value : values.col(static_cast<Eigen::Index>(p))) value = to_open(value, settings.bounds[p]);
  const Eigen::MatrixXd off = as_eigen(kept_statistics).rowwise() - as_eigen(observed).transpose();
  values = adjust(values, off, as_eigen(std::span<const double>(accepted.weights)));
  for (std::size_t p = 0; p < settings.bounds.size(); ++p)
    for (double& value : values.col(static_cast<Eigen::Index>(p))) value = from_open(value, settings.bounds[p]);
  return {detail::to_matrix(values), std::move(accepted.weights)};
}

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

  const Matrix<double> from_below = rank_columns(rows, settings.threads);
  const std::vector<double> p = share_at_least_as_extreme(sorted_ranks(from_below));
  GlobalEnvelope envelope;
  envelope.p = p[0];
  for (std::size_t c = 0; c < rows.columns(); ++c) {
    envelope.adjusted_p.push_back(adjusted_p(from_below, p, c));
    envelope.median.push_back(median_without_first(rows, c));
  }
  draw_envelope(rows, p, settings.alpha, envelope);
  return envelope;
}

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

EnvelopeReference::EnvelopeReference(Matrix<double> simulated)
    : simulated_(std::move(simulated)),
      sorted_(simulated_.columns(), simulated_.rows()),
      from_below_(simulated_.rows(), simulated_.columns()),
      least_(simulated_.rows(), std::numeric_limits<double>::infinity()) {
  require(simulated_.rows() > 1, "envelope: fewer than two simulated rows");
  require(simulated_.columns() > 0, "envelope: nothing to compare");
  require_finite(simulated_.values(), "envelope: a simulated statistic is not finite");
  const std::size_t n = simulated_.rows();
  for (std::size_t c = 0; c < simulated_.columns(); ++c) {
    const std::vector<double> values = simulated_.column(c), ranks = ranks_of(values);
    std::ranges::copy(sorted(values), sorted_.row(c).begin());
    for (std::size_t r = 0; r < n; ++r) {
      from_below_(r, c) = ranks[r];
      least_[r] = std::min({least_[r], ranks[r], static_cast<double>(n) - ranks[r]});
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
  column.own_rank = shared_rank(all, n, lower, upper + 1);
  /// Of the simulated value sorted[i], which differs from the observed one.
  const auto special = [&](std::size_t i) {
    const std::size_t shift = i < lower ? 0 : 1;
    const auto tied = std::equal_range(sorted.begin(), sorted.end(), sorted[i]);
    return Column::Special{sorted[i], shared_rank(all, n, static_cast<std::size_t>(tied.first - sorted.begin()) + shift,
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
  const auto top = static_cast<double>(simulated_.rows() + 1);
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
