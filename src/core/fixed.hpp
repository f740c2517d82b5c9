// Numbers as texts and tables show them.
#pragma once

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

}  // namespace pirsim
