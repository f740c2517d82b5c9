// How closely two numbers go together. Private to reconcile.
#pragma once

#include <cmath>

namespace pirsim::reconcile {

/// Pearson's coefficient of pairs that come one by one.
class Correlation {
 public:
  void add(double a, double b) noexcept {
    n_ += 1.0;
    a_ += a;
    b_ += b;
    aa_ += a * a;
    bb_ += b * b;
    ab_ += a * b;
  }
  /// 0 if one of the two doesn't vary.
  [[nodiscard]] double value() const {
    const double variance = (n_ * aa_ - a_ * a_) * (n_ * bb_ - b_ * b_);
    return variance > 1e-9 ? (n_ * ab_ - a_ * b_) / std::sqrt(variance) : 0.0;
  }

 private:
  double n_ = 0.0, a_ = 0.0, b_ = 0.0, aa_ = 0.0, bb_ = 0.0, ab_ = 0.0;
};

}  // namespace pirsim::reconcile
