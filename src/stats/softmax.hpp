// Logs of odds as probabilities.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace pirsim::stats::detail {

/// Sums to 1; logs: at least one, up to a number that all share.
inline std::vector<double> softmax(std::vector<double> logs) {
  const double largest = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double& log : logs) sum += log = std::exp(log - largest);
  for (double& log : logs) log /= sum;
  return logs;
}

}  // namespace pirsim::stats::detail
