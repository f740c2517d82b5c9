#include "reconcile/data/bit_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::reconcile {
namespace {

constexpr float silent_below = 0.02F;  ///< expected share of rows with motion
constexpr std::size_t block_rows = 10;
constexpr std::size_t shortest_period_rows = 8;
constexpr double farthest_shift_s = 20.0;  ///< beyond the prior of clock_lag; and so many rows, where they are longer
constexpr double least_likeness = 0.3;     ///< assumed (0.2-0.45): correlation from which a shift is told

void add_counts(const BitSeries& series, double window_s, CellValues& values) {
  const std::size_t n = series.bits.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (series.bits[i] != 1) continue;
    values[CellStatistic::seconds] += window_s;
    if (series.busy[i] != 0) values[CellStatistic::busy_seconds] += window_s;
    if (series.expected[i] < silent_below) values[CellStatistic::silent_seconds] += window_s;
    values[CellStatistic::half_difference] += 2 * i < n ? window_s : -window_s;
    values.values[static_cast<std::size_t>(CellStatistic::sixth_1) + 6 * i / n] += window_s;
  }
}

/// Stretches of equal bits; an unknown bit ends a stretch of either kind.
void add_stretches(const BitSeries& series, CellValues& values) {
  const std::size_t n = series.bits.size();
  double longest_run = 0.0, longest_gap = 0.0;
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin + 1;
    while (end < n && series.bits[end] == series.bits[begin]) ++end;
    const std::size_t length = end - begin;
    const bool inner = begin > 0 && end < n && series.bits[begin - 1] != unknown_bit && series.bits[end] != unknown_bit;
    if (series.bits[begin] == 1) {
      longest_run = std::max(longest_run, static_cast<double>(length));
      if (begin > 0 && series.bits[begin - 1] == 0) values[CellStatistic::onsets] += 1.0;
      if (inner && length == 1) values[CellStatistic::isolated] += 1.0;
    } else if (series.bits[begin] == 0) {
      longest_gap = std::max(longest_gap, static_cast<double>(length));
      if (inner && length == 1) values[CellStatistic::single_gaps] += 1.0;
      if (inner && length == 2) values[CellStatistic::double_gaps] += 1.0;
    }
    begin = end;
  }
  values[CellStatistic::longest_run] += longest_run;
  values[CellStatistic::longest_gap] += longest_gap;
}

double share_again_after(std::span<const std::uint8_t> bits, std::size_t lag) {
  std::uint32_t followed = 0, known = 0;
  for (std::size_t i = 0; i + lag < bits.size(); ++i) {  // without branches: bits are hard to foresee
    const std::uint32_t moved = bits[i] == 1 ? 1 : 0;
    followed += moved & (bits[i + lag] == 1 ? 1U : 0U);
    known += moved & (bits[i + lag] != unknown_bit ? 1U : 0U);
  }
  return known > 0 ? static_cast<double>(followed) / known : 0.0;
}

/// Sum of squared deviations of block counts over what independent rows would give; 1 by chance, 0 without motion.
double dispersion(std::span<const std::uint8_t> bits) {
  std::vector<double> counts;
  for (std::size_t begin = 0; begin + block_rows <= bits.size(); begin += block_rows) {
    const auto block = bits.subspan(begin, block_rows);
    counts.push_back(static_cast<double>(std::ranges::count(block, 1)));
  }
  if (counts.size() < 2) return 0.0;
  double mean = 0.0;
  for (const double count : counts) mean += count / static_cast<double>(counts.size());
  double squares = 0.0;
  for (const double count : counts) squares += (count - mean) * (count - mean);
  const double by_chance =
      static_cast<double>(counts.size() - 1) * mean * (1.0 - mean / static_cast<double>(block_rows));
  return mean > 0.0 ? squares / (by_chance + 0.5) : 0.0;
}

/// (n) exp(2 pi i k / n), made once for every n.
const std::vector<std::complex<double>>& roots_of_unity(std::size_t n) {
  thread_local std::map<std::size_t, std::vector<std::complex<double>>> known;
  std::vector<std::complex<double>>& roots = known[n];
  for (std::size_t k = roots.size(); k < n; ++k) {
    const double angle = 2.0 * pi * static_cast<double>(k) / static_cast<double>(n);
    roots.emplace_back(std::cos(angle), std::sin(angle));
  }
  return roots;
}

/// Greatest |sum of exp(2 pi i f t / n)|^2 over the rows t with motion, divided by its expectation by chance: of the
/// frequencies f from 1 on whose period is no shorter than the shortest.
double period_power(std::span<const std::uint8_t> bits) {
  const std::size_t n = bits.size();
  const auto count = static_cast<double>(std::ranges::count(bits, 1));
  if (count < 3.0 || count + 3.0 > static_cast<double>(n)) return 0.0;
  const std::vector<std::complex<double>>& roots = roots_of_unity(n);
  std::vector<std::complex<double>> sums(n / shortest_period_rows);
  for (std::size_t row = 0; row < n; ++row) {
    if (bits[row] != 1) continue;
    std::size_t k = 0;  // f * row modulo n
    for (std::complex<double>& sum : sums) {
      k = k + row < n ? k + row : k + row - n;
      sum += roots[k];
    }
  }
  double greatest = 0.0;
  for (const std::complex<double>& sum : sums) greatest = std::max(greatest, std::norm(sum));
  return greatest / (count * (1.0 - count / static_cast<double>(n)));
}

double cycle_strength(std::span<const std::uint8_t> bits, double cycle_rows) {
  double real = 0.0, imaginary = 0.0, count = 0.0;
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (bits[i] != 1) continue;
    const double angle = 2.0 * pi * static_cast<double>(i) / cycle_rows;
    real += std::cos(angle);
    imaginary += std::sin(angle);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(real * real + imaginary * imaginary) / count : 0.0;
}

double agreement(const BitSeries& series) {
  Correlation correlation;
  for (std::size_t i = 0; i < series.bits.size(); ++i) {
    if (series.bits[i] != unknown_bit) correlation.add(series.bits[i], series.expected[i]);
  }
  return correlation.value();
}

/// Rows by which the motion has to be earlier to be most like what is expected, with a parabola between rows.
double shift_rows(const BitSeries& series, double window_s) {
  const auto n = static_cast<std::ptrdiff_t>(series.bits.size());
  double n_known = 0.0, mean_bit = 0.0, mean_expected = 0.0;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    if (series.bits[row] == unknown_bit) continue;
    n_known += 1.0;
    mean_bit += series.bits[row];
    mean_expected += static_cast<double>(series.expected[row]);
  }
  if (n_known == 0.0) return 0.0;
  mean_bit /= n_known;
  mean_expected /= n_known;
  std::vector<double> bits, expected;
  double bit_squares = 0.0, expected_squares = 0.0;
  for (std::size_t row = 0; row < series.bits.size(); ++row) {
    bits.push_back(series.bits[row] == unknown_bit ? 0.0 : series.bits[row] - mean_bit);
    expected.push_back(static_cast<double>(series.expected[row]) - mean_expected);
    bit_squares += bits.back() * bits.back();
    expected_squares += expected.back() * expected.back();
  }
  const double farthest_rows = std::ceil(farthest_shift_s / std::min(window_s, 1.0));
  const std::ptrdiff_t farthest = std::min(static_cast<std::ptrdiff_t>(farthest_rows), n / 2);
  std::vector<double> likeness;
  for (std::ptrdiff_t shift = -farthest; shift <= farthest; ++shift) {
    double sum = 0.0;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, shift); i < std::min(n, n + shift); ++i) {
      sum += bits[static_cast<std::size_t>(i)] * expected[static_cast<std::size_t>(i - shift)];
    }
    likeness.push_back(sum);
  }
  const auto best = std::ranges::max_element(likeness);
  if (*best <= least_likeness * std::sqrt(bit_squares * expected_squares)) return 0.0;
  const auto rows = static_cast<double>(best - likeness.begin() - farthest);
  if (best == likeness.begin() || best + 1 == likeness.end()) return rows;
  const double before = *(best - 1), after = *(best + 1), bend = 2.0 * *best - before - after;
  return bend > 0.0 ? rows + 0.5 * (after - before) / bend : rows;
}

}  // namespace

void add_main_statistics(const BitSeries& series, double window_s, CellValues& values) {
  add_counts(series, window_s, values);
  add_stretches(series, values);
  constexpr std::array<std::pair<CellStatistic, std::size_t>, 5> lags{{{CellStatistic::again_after_1, 1},
                                                                       {CellStatistic::again_after_2, 2},
                                                                       {CellStatistic::again_after_3, 3},
                                                                       {CellStatistic::again_after_4, 4},
                                                                       {CellStatistic::again_after_6, 6}}};
  for (const auto& [statistic, lag] : lags) values[statistic] += share_again_after(series.bits, lag);
  values[CellStatistic::dispersion] += dispersion(series.bits);
  values[CellStatistic::period_power] += period_power(series.bits);
  values[CellStatistic::cycle_strength] += cycle_strength(series.bits, series.cycle_rows);
  values[CellStatistic::agreement] += agreement(series);
  values[CellStatistic::shift_s] += shift_rows(series, window_s) * window_s;
}

}  // namespace pirsim::reconcile
