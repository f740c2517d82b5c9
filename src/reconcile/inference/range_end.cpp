#include "reconcile/inference/range_end.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "effects/catalogue.hpp"
#include "reconcile/inference/kinds.hpp"
#include "reconcile/inference/model_check.hpp"

namespace pirsim::reconcile {
namespace {

constexpr double last_part = 0.1;   ///< of the prior (assumed): a tenth of what was looked for ends there by chance
constexpr double step = 4.0 / 3.0;  ///< assumed
constexpr double farthest = 20.0;   ///< times as far from none as the end (assumed)

const effects::ParameterInfo& info_of(const std::string& effect, const std::string& parameter) {
  return *std::ranges::find(effects::find(effect).info.parameters, parameter, &effects::ParameterInfo::name);
}

/// Where nothing happens; of what has no such place, 0.
double none_of(const effects::ParameterInfo& info) { return info.role == effects::Role::strength ? info.off : 0.0; }

std::optional<double> end_near(const effects::ParameterInfo& info, double value) {
  const double low = to_flat(info, info.low), high = to_flat(info, info.high), flat = to_flat(info, value);
  const double edge = last_part * (high - low);
  if (flat > high - edge && info.high > none_of(info)) return info.high;
  if (flat < low + edge && info.low < none_of(info)) return info.low;
  return std::nullopt;
}

std::vector<double> steps_beyond(const effects::ParameterInfo& info, double end) {
  const double none = none_of(info);
  std::vector<double> values;
  for (double factor = step; factor < farthest * step; factor *= step) {
    const double asked = none + (end - none) * factor;
    const double value =
        std::clamp(info.scale == effects::Scale::whole ? std::round(asked) : asked, info.least, info.most);
    if (value == end || (!values.empty() && value == values.back())) break;
    values.push_back(value);
  }
  return values;
}

FittedEffect with_value(FittedEffect fitted, const std::string& parameter, double value) {
  fitted.effect.parameters.at(parameter) = value;
  FittedParameter& changed = *std::ranges::find(fitted.parameters, parameter, &FittedParameter::name);
  changed.value = value;
  changed.interval = {value, value};
  changed.equally_likely.clear();
  return fitted;
}

}  // namespace

std::optional<RangeEnd> range_end_of(const FittedEffect& fitted) {
  std::vector<const FittedParameter*> parameters;
  for (const FittedParameter& parameter : fitted.parameters) parameters.push_back(&parameter);
  std::ranges::stable_partition(parameters, &FittedParameter::is_strength);
  for (const FittedParameter* parameter : parameters) {
    const effects::ParameterInfo& info = info_of(fitted.effect.name, parameter->name);
    const std::optional<double> end = end_near(info, parameter->value);
    if (end) return RangeEnd{fitted.effect.name, parameter->name, parameter->unit, {info.low, info.high}, *end, *end};
  }
  return std::nullopt;
}

std::optional<RangeEnd> strong_end_of(const FittedEffect& fitted) {
  const auto strength = std::ranges::find_if(fitted.parameters, &FittedParameter::is_strength);
  if (strength == fitted.parameters.end()) return std::nullopt;
  const effects::ParameterInfo& info = info_of(fitted.effect.name, strength->name);
  const double end = strength->value < info.off ? info.low : info.high;
  return RangeEnd{fitted.effect.name, strength->name, strength->unit, {info.low, info.high}, end, end};
}

std::optional<FittedEffect> fitted_beyond(const FittedEffect& fitted, RangeEnd& end, const ReferenceStudy& reference,
                                          const FeatureMap& map, std::span<const float> measured, double level,
                                          const Context& context) {
  const std::vector<double> values = steps_beyond(info_of(end.effect, end.parameter), end.end);
  if (values.empty()) return std::nullopt;
  end.tried_to = values.back();
  std::vector<FittedEffect> effects;
  for (const double value : values) effects.push_back(with_value(fitted, end.parameter, value));
  std::vector<PatchedModel> models;
  for (const FittedEffect& effect : effects) models.push_back({std::span(&effect, 1), measured});
  const std::vector<GlobalP> p = p_with(models, reference, map, level, context);
  const auto best = static_cast<std::size_t>(std::ranges::max_element(p, {}, &GlobalP::p) - p.begin());
  if (p[best].p <= level) return std::nullopt;

  const auto passes = [level](const GlobalP& of) { return of.p > level; };
  const auto first = static_cast<std::size_t>(std::ranges::find_if(p, passes) - p.begin());
  const auto last = static_cast<std::size_t>(std::find_if(p.rbegin(), p.rend(), passes).base() - p.begin()) - 1;
  FittedEffect found = std::move(effects[best]);
  FittedParameter& parameter = *std::ranges::find(found.parameters, end.parameter, &FittedParameter::name);
  for (std::size_t i = first; i <= last; ++i) parameter.equally_likely.push_back(values[i]);
  std::ranges::sort(parameter.equally_likely);
  const double before = first == 0 ? end.end : values[first - 1], after = values[std::min(last + 1, values.size() - 1)];
  parameter.interval = {std::min(before, after), std::max(before, after)};
  found.includes_off = false;
  end.found = values[best];
  return found;
}

}  // namespace pirsim::reconcile
