#include "studies/crps.hpp"

#include <cmath>

#include "pirsim/error.hpp"

namespace pirsim::studies {

double crps(const Tally& ensemble, double observed) {
  if (ensemble.empty()) throw Error(ErrorCode::usage, "crps: no member");
  double n = 0.0;
  for (const auto& [value, times] : ensemble) n += static_cast<double>(times);
  double error = 0.0, pairs = 0.0, below = 0.0;
  for (const auto& [value, count] : ensemble) {
    const auto x = static_cast<double>(value), times = static_cast<double>(count);
    error += times * std::abs(x - observed);
    pairs += x * times * (2.0 * below + times - n);  // sum over pairs of x_j - x_i, `times` members at once
    below += times;
  }
  return error / n - pairs / (n * n);
}

}  // namespace pirsim::studies
