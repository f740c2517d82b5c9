#include "reconcile/inference/flat_scale.hpp"

#include <algorithm>
#include <cmath>

namespace pirsim::reconcile {

using effects::ParameterInfo;
using effects::Scale;

double to_flat(const ParameterInfo& info, double value) {
  const double within = std::clamp(value, info.low, info.high);
  return info.scale == Scale::logarithmic ? std::log(within) : within;
}

double from_flat(const ParameterInfo& info, double value) {
  const double natural = info.scale == Scale::logarithmic ? std::exp(value) : value;
  const double rounded = info.scale == Scale::whole ? std::round(natural) : natural;
  return std::clamp(rounded, info.least, info.most);
}

}  // namespace pirsim::reconcile
