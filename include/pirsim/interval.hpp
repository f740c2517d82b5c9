// An interval of numbers, both ends included.
#pragma once

namespace pirsim {

struct Interval {
  double low = 0.0, high = 0.0;
  [[nodiscard]] bool contains(double value) const noexcept { return low <= value && value <= high; }
  bool operator==(const Interval&) const = default;
};

}  // namespace pirsim
