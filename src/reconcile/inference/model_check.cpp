#include "reconcile/inference/model_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "pirsim/random.hpp"
#include "reconcile/ensemble/realization.hpp"
#include "reconcile/inference/fit.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t first_check_realization = 1U << 23U;  ///< realizations that no table has seen
constexpr std::array<std::uint32_t, 2> first_looks{20, 60};   ///< realizations (assumed: only time depends on them)
constexpr double n_as_strange = 5.0;                          ///< datasets, the data among them (assumed)
/// Realizations in which a model is simulated before it is refused, times the level (assumed: fewer would refuse as
/// seldom where nothing is wrong, and not as surely where something is).
constexpr double realizations_to_refuse = 5.0;

/// A quarter of the datasets are as strange, five at least: of 20 with p 0.025 once in 10,000 models.
bool surely_passes(double p, std::size_t n_datasets) {
  const double as_strange = p * static_cast<double>(n_datasets + 1);  // the data themselves count
  return p > 0.25 && as_strange > n_as_strange;
}

/// With fewer datasets no data are strange enough.
bool can_refuse(std::size_t n_datasets, double level) { return static_cast<double>(n_datasets + 1) * level >= 1.0; }

/// The effects as they are in one realization.
std::vector<EffectSpec> drawn(std::span<const FittedEffect> effects, const ReferenceStudy& reference,
                              std::uint64_t seed, std::uint32_t realization) {
  Stream stream({seed, realization, 0, Purpose::model_check});
  std::vector<EffectSpec> all;
  for (const FittedEffect& fitted : effects) {
    all.push_back(fitted.effect);
    for (const FittedParameter& parameter : fitted.parameters) {
      const std::vector<double>& values = parameter.equally_likely;
      if (values.empty()) continue;
      all.back().parameters.at(parameter.name) = values[stream.index(static_cast<std::uint32_t>(values.size()))];
    }
    all.back() = effects::settled(std::move(all.back()), reference.source.scene);
  }
  return all;
}

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

double level_with(std::size_t n_applied, double alpha) { return alpha * std::pow(0.5, static_cast<double>(n_applied)); }

std::vector<GlobalP> p_with(std::span<const PatchedModel> models, const ReferenceStudy& reference,
                            const FeatureMap& map, double level, const Context& context) {
  using Rows = std::vector<std::vector<float>>;  // one a model; empty: people can't get about
  const int n = reference.shape.n_replicates;
  // Of each model one in a realization: those of one realization share the room, so that data of another room would be
  // stranger than any of them.
  std::vector<stats::Matrix<float>> datasets(models.size());
  std::vector<GlobalP> p(models.size());
  std::vector<std::size_t> in_doubt = stats::numbers_to(models.size());
  std::uint32_t n_done = 0;
  const auto n_to_refuse = static_cast<std::uint32_t>(std::ceil(realizations_to_refuse / level));
  for (const std::uint32_t n_realizations : {first_looks[0], first_looks[1], std::max(n_to_refuse, first_looks[1])}) {
    if (in_doubt.empty()) break;
    const auto rows_of = [&](std::size_t i) {
      const std::uint32_t index = first_check_realization + n_done + static_cast<std::uint32_t>(i);
      const SimulatedRealization realization(reference.source, reference.frame, index, n);
      Rows rows;
      for (const std::size_t k : in_doubt) {
        const auto data = realization.with_effects(drawn(models[k].applied, reference, context.seed, index), 0, n);
        rows.push_back(data ? statistics_of(reference.frame, reference.shape, reference.table.profile, *data)
                            : std::vector<float>());
      }
      return rows;
    };
    for (const Rows& rows : in_parallel<Rows>(n_realizations - n_done, context.threads, rows_of)) {
      for (std::size_t k = 0; k < in_doubt.size(); ++k) {
        if (!rows[k].empty()) datasets[in_doubt[k]].append_row(rows[k]);
      }
    }
    n_done = n_realizations;
    std::vector<std::size_t> still;
    for (const std::size_t k : in_doubt) {
      if (datasets[k].rows() > 1) {
        const Location seen = locate(reference.frame, map, datasets[k], models[k].observed, level, context);
        p[k] = {seen.p, seen.least_p()};
      }
      if (surely_passes(p[k].p, datasets[k].rows()))
        datasets[k] = {};
      else
        still.push_back(k);
    }
    in_doubt = std::move(still);
  }
  for (const std::size_t k : in_doubt) {
    if (!can_refuse(datasets[k].rows(), level)) p[k] = {};
  }
  return p;
}

std::optional<RangeEnd> range_end_of(const FittedEffect& fitted) {
  std::vector<const FittedParameter*> parameters;
  for (const FittedParameter& parameter : fitted.parameters) parameters.push_back(&parameter);
  std::ranges::stable_partition(parameters, &FittedParameter::is_strength);
  for (const FittedParameter* parameter : parameters) {
    const effects::ParameterInfo& info = info_of(fitted.effect.name, parameter->name);
    if (info.goes_round()) continue;
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
