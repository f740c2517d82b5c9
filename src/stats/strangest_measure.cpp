#include "stats/strangest_measure.hpp"

#include <algorithm>
#include <limits>

#include "stats/intervals.hpp"
#include "stats/require.hpp"

namespace pirsim::stats {

double conformal_p(std::span<const double> calibration, double score) {
  const auto as_strange = std::count_if(calibration.begin(), calibration.end(), [&](double c) { return c >= score; });
  return static_cast<double>(as_strange + 1) / static_cast<double>(calibration.size() + 1);
}

StrangestMeasure::StrangestMeasure(const Matrix<double>& known) : known_(known.columns(), known.rows()) {
  require(known.rows() > 0, "strangeness: no known row");
  for (std::size_t m = 0; m < known.columns(); ++m) {
    for (std::size_t row = 0; row < known.rows(); ++row) known_(m, row) = known(row, m);
    std::vector<double>& sorted = sorted_.emplace_back(known_.row(m).begin(), known_.row(m).end());
    std::ranges::sort(sorted);
  }
}

double StrangestMeasure::p(std::span<const double> row) const {
  require(row.size() == sorted_.size(), "strangeness: another number of measures than of the known rows");
  constexpr double lowest = -std::numeric_limits<double>::infinity();
  std::vector<double> strangest(known_.columns(), lowest);
  double own = lowest;
  for (std::size_t m = 0; m < row.size(); ++m) {
    std::vector<double> all = sorted_[m];
    all.insert(std::ranges::upper_bound(all, row[m]), row[m]);
    const double median = sorted_quantile(all, 0.5);
    const double reach = std::max(sorted_quantile(all, 0.95) - median, 1e-9);
    own = std::max(own, (row[m] - median) / reach);
    for (std::size_t i = 0; i < strangest.size(); ++i)
      strangest[i] = std::max(strangest[i], (known_(m, i) - median) / reach);
  }
  return conformal_p(strangest, own);
}

}  // namespace pirsim::stats
