// A power law between two ends, fitted to what was seen between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace pirsim::test {

/// Of the truncated law with density ~ x^-(exponent + 1): Hill's estimate where the upper end is infinite.
struct PowerLawFit {
  double exponent = 0.0;
  double standard_error = 0.0;
  double distance = 0.0;  ///< Kolmogorov's, between the law and what was seen
  std::size_t n = 0;

  /// Not refused at 1 %. The exponent was fitted, which makes distances smaller: the test errs towards refusing less.
  [[nodiscard]] bool fits() const { return n > 50 && distance * std::sqrt(static_cast<double>(n)) < 1.63; }
};

inline PowerLawFit fit_power_law(std::vector<double> values, double low, double high) {
  std::erase_if(values, [&](double x) { return x < low || x > high; });
  std::ranges::sort(values);
  PowerLawFit fit;
  fit.n = values.size();
  if (fit.n < 2) return fit;
  const double range = std::log(high / low);
  double mean = 0.0;
  for (const double x : values) mean += std::log(x / low) / static_cast<double>(fit.n);
  // The logarithm is exponential with this rate, cut at the range.
  const auto mean_of = [&](double a) {
    return std::abs(a) < 1e-9 ? 0.5 * range : 1.0 / a - range / std::expm1(a * range);
  };
  double least = -20.0, most = 200.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (least + most);
    (mean_of(middle) > mean ? least : most) = middle;
  }
  fit.exponent = 0.5 * (least + most);
  const double a = fit.exponent, step = 1e-4;
  const double information = -(mean_of(a + step) - mean_of(a - step)) / (2.0 * step);
  fit.standard_error = 1.0 / std::sqrt(static_cast<double>(fit.n) * information);
  for (std::size_t i = 0; i < fit.n; ++i) {
    const double law = std::expm1(-a * std::log(values[i] / low)) / std::expm1(-a * range);
    const double seen = static_cast<double>(i) / static_cast<double>(fit.n);
    fit.distance = std::max({fit.distance, law - seen, seen + 1.0 / static_cast<double>(fit.n) - law});
  }
  return fit;
}

}  // namespace pirsim::test
