// Which numbers are accepted, and how a message says so.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>

namespace pirsim {

/// Finite numbers: `{.above = 0.0, .max = 3.0}` is 0 < x <= 3.
struct NumberRange {
  double above = -std::numeric_limits<double>::infinity();
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool holds(double value) const noexcept;
  [[nodiscard]] std::string text() const;  ///< "a finite number > 0 and <= 3"
};

/// Whole numbers, both ends included.
struct IntegerRange {
  long long min = std::numeric_limits<int>::min();
  long long max = std::numeric_limits<int>::max();

  [[nodiscard]] bool holds(long long value) const noexcept { return value >= min && value <= max; }
  [[nodiscard]] std::string text() const;  ///< "a whole number from 1 up to 9"
};

// How often each of some whole numbers came out.

/// Value -> how often it came out, once or more. As large as there are different values, however many were counted.
using Tally = std::map<int, std::int64_t>;

}  // namespace pirsim
