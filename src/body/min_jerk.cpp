#include "body/min_jerk.hpp"

#include <algorithm>
#include <cmath>

namespace pirsim::body {

void MinJerk::move_to(double target, int ticks) noexcept {
  if (target == target_) return;
  const double start = value();
  const double velocity = derivative(1);
  const double acceleration = derivative(2);
  const double way = target - start;
  // A quintic of duration T overshoots if v T > 2.5 way (a = 0); 2.2 leaves room for an acceleration.
  if (velocity * way > 0.0) ticks = std::min(ticks, static_cast<int>(2.2 * way / velocity));
  ticks_ = std::max(ticks, 1);
  tick_ = 0;
  target_ = target;
  const double n = ticks_;
  const double v = velocity * n;
  const double a = acceleration * n * n;
  coefficients_ = {start,
                   v,
                   0.5 * a,
                   10.0 * way - 6.0 * v - 1.5 * a,
                   -15.0 * way + 8.0 * v + 1.5 * a,
                   6.0 * way - 3.0 * v - 0.5 * a};
}

double MinJerk::moving_value() const noexcept {
  const double tau = static_cast<double>(tick_) / ticks_;
  double sum = 0.0;
  for (std::size_t k = 6; k-- > 0;) sum = sum * tau + coefficients_[k];
  return sum;
}

double MinJerk::derivative(int order) const noexcept {
  if (settled()) return 0.0;
  const double tau = static_cast<double>(tick_) / ticks_;
  double sum = 0.0;
  for (int k = 5; k >= order; --k) {
    double factor = 1.0;
    for (int i = 0; i < order; ++i) factor *= k - i;
    sum = sum * tau + factor * coefficients_[static_cast<std::size_t>(k)];
  }
  return sum / std::pow(static_cast<double>(ticks_), order);
}

}  // namespace pirsim::body
