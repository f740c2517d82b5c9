// Numbers as texts and tables show them.
#pragma once

#include <array>
#include <charconv>
#include <iomanip>
#include <sstream>
#include <string>

namespace pirsim {

/// With so many digits after the point.
[[nodiscard]] inline std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

/// With as many digits as tell it from every other number.
[[nodiscard]] inline std::string shortest_number(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace pirsim
