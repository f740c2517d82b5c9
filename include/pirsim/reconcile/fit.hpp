// How strong is a named effect?
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/reconcile/feature_map.hpp"
#include "pirsim/reconcile/reference_table.hpp"
#include "pirsim/stats/intervals.hpp"

namespace pirsim::reconcile {

struct FittedParameter {
  std::string name, unit;
  double value = 0.0;
  stats::Interval interval;  ///< 90 %, nuisance included
  double off = 0.0;
  bool is_strength = true;             ///< has an `off` at which nothing happens
  std::vector<double> equally_likely;  ///< quantiles in the middles of twenty equal parts, ascending
};

struct FittedEffect {
  EffectSpec effect;  ///< with the fitted parameters, as a script takes it
  std::vector<FittedParameter> parameters;
  bool includes_off = false;  ///< every strength's interval holds its `off`
};

struct FitSettings {
  std::uint64_t seed = 0;
  unsigned threads = 0;
  double confidence = 0.9;
};

/// From the datasets of one entry of the table alone: a linear guess of its parameters, then regression-adjusted ABC
/// on it, widened until `held_back` datasets (rows of the entry outside the training part) like the measured one are
/// covered as often as promised: give those in which a disagreement is seen, since nothing else is fitted. What is no
/// matter of more or less (which sensor, which wall, which way) is the likeliest kind by a discriminant between the
/// kinds. Ref: [FearnheadPrangle2012], [Beaumont2002]
[[nodiscard]] FittedEffect fit_from_table(const ReferenceTable& table, const FeatureMap& map, std::size_t entry,
                                          std::span<const std::size_t> held_back, std::span<const float> measured,
                                          const FitSettings& settings);

}  // namespace pirsim::reconcile
