#include "model/core/range.hpp"

#include <cmath>
#include <sstream>

namespace pirsim {

bool NumberRange::holds(double value) const noexcept {
  return std::isfinite(value) && value > above && value >= min && value <= max;
}

std::string NumberRange::text() const {
  std::ostringstream text;
  text << "a finite number";
  const char* joint = " ";
  const auto bound = [&](const char* relation, double value) {
    if (!std::isfinite(value)) return;
    text << joint << relation << ' ' << value;
    joint = " and ";
  };
  bound(">", above);
  bound(">=", min);
  bound("<=", max);
  return text.str();
}

std::string IntegerRange::text() const {
  std::string text = "a whole number";
  if (min > IntegerRange{}.min) text += " from " + std::to_string(min);
  if (max < IntegerRange{}.max) text += " up to " + std::to_string(max);
  return text;
}

}  // namespace pirsim
