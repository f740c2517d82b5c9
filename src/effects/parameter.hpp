// Short forms of parameters that many effects have alike.
#pragma once

#include "effects/catalogue.hpp"

namespace pirsim::effects {

/// A factor on what the model has; 1 is off.
[[nodiscard]] inline ParameterInfo factor(std::string name, double low, double high, double typical,
                                          std::string source) {
  return {.name = std::move(name),
          .unit = "",
          .off = 1.0,
          .typical = typical,
          .low = low,
          .high = high,
          .least = 0.05,
          .most = 20.0,
          .scale = Scale::logarithmic,
          .source = std::move(source)};
}

/// Something to either side of what the model has; 0 is off.
[[nodiscard]] inline ParameterInfo offset(std::string name, std::string unit, double reach, double typical, double most,
                                          std::string source) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .off = 0.0,
          .typical = typical,
          .low = -reach,
          .high = reach,
          .least = -most,
          .most = most,
          .source = std::move(source)};
}

/// Happens (1) or not (0).
[[nodiscard]] inline ParameterInfo whether(std::string name, std::string source) {
  return {.name = std::move(name),
          .unit = "",
          .off = 0.0,
          .typical = 1.0,
          .low = 1.0,
          .high = 1.0,
          .least = 0.0,
          .most = 1.0,
          .scale = Scale::whole,
          .source = std::move(source)};
}

}  // namespace pirsim::effects
