#include "pirsim/reconcile/fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "pirsim/effects/catalogue.hpp"
#include "pirsim/reconcile/locate.hpp"
#include "pirsim/stats/posterior.hpp"

namespace pirsim::reconcile {
namespace {

using effects::ParameterInfo;
using effects::Scale;

/// Parameters are guessed on the scale on which their prior is flat.
double to_flat(const ParameterInfo& info, double value) {
  return info.scale == Scale::logarithmic ? std::log(value) : value;
}
double from_flat(const ParameterInfo& info, double value) {
  const double natural = info.scale == Scale::logarithmic ? std::exp(value) : value;
  const double rounded = info.scale == Scale::whole ? std::round(natural) : natural;
  return std::clamp(rounded, info.least, info.most);
}

bool varies(const ParameterInfo& info) { return info.low < info.high; }

/// The datasets of one entry with their parameters on flat scales.
struct Training {
  stats::Matrix<double> features;    ///< (n x n_features)
  stats::Matrix<double> parameters;  ///< (n x n_parameters)
  std::vector<std::size_t> rows;     ///< of the table
};

Training training_of(const ReferenceTable& table, const FeatureMap& map, std::size_t entry, Part part,
                     const std::vector<const ParameterInfo*>& infos, unsigned threads) {
  Training data{{}, {}, rows_of(table, entry, part)};
  const stats::Matrix<float> features = map.features(table.statistics.select_rows(data.rows), threads);
  data.features = stats::Matrix<double>(features.rows(), features.columns());
  std::ranges::copy(features.values(), data.features.values().begin());
  data.parameters = stats::Matrix<double>(data.rows.size(), infos.size());
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    for (std::size_t p = 0; p < infos.size(); ++p) {
      data.parameters(i, p) =
          to_flat(*infos[p], table.rows[data.rows[i]].effects.front().parameters.at(infos[p]->name));
    }
  }
  return data;
}

/// The choices that are most frequent among the datasets whose features lie nearest to the measured ones.
void choose(const ReferenceTable& table, const Training& data, const std::vector<double>& measured,
            EffectSpec& effect) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    double squares = 0.0;
    for (std::size_t f = 0; f < measured.size(); ++f) {
      squares += (data.features(i, f) - measured[f]) * (data.features(i, f) - measured[f]);
    }
    near.emplace_back(squares, data.rows[i]);
  }
  std::ranges::sort(near);
  near.resize(std::min<std::size_t>(near.size(), 9));
  std::map<std::map<std::string, std::string, std::less<>>, std::size_t> votes;
  for (const auto& [distance, row] : near) ++votes[table.rows[row].effects.front().choices];
  const auto most = std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
  if (most != votes.end()) effect.choices = most->first;
}

std::vector<stats::Interval> bounds_of(const std::vector<const ParameterInfo*>& infos) {
  std::vector<stats::Interval> bounds;
  for (const ParameterInfo* info : infos) bounds.push_back({to_flat(*info, info->low), to_flat(*info, info->high)});
  return bounds;
}

/// How much an interval must be stretched about its median so that `confidence` of the held-back datasets near the
/// measured one lie in theirs.
double widening_of(const Training& held_back, const stats::Matrix<double>& guesses,
                   const stats::AbcPosterior& posterior, std::size_t parameter, double observed_guess,
                   double confidence) {
  const stats::Interval interval = posterior.interval(parameter, confidence);
  const double half = 0.5 * (interval.high - interval.low);
  if (half <= 0.0 || held_back.rows.empty()) return 1.0;
  std::vector<std::pair<double, double>> misses;  // distance of the guess, error of the guess
  for (std::size_t i = 0; i < held_back.rows.size(); ++i) {
    misses.emplace_back(std::abs(guesses(i, parameter) - observed_guess),
                        std::abs(held_back.parameters(i, parameter) - guesses(i, parameter)));
  }
  std::ranges::sort(misses);
  misses.resize(std::max<std::size_t>(20, misses.size() / 4) < misses.size()
                    ? std::max<std::size_t>(20, misses.size() / 4)
                    : misses.size());
  std::vector<double> errors;
  for (const auto& [distance, error] : misses) errors.push_back(error);
  return std::max(1.0, stats::quantile(errors, confidence) / half);
}

}  // namespace

FittedEffect fit_from_table(const ReferenceTable& table, const FeatureMap& map, std::size_t entry,
                            std::span<const float> measured, const FitSettings& settings) {
  const effects::Effect& effect = effects::find(table.effects[entry - 1]);
  std::vector<const ParameterInfo*> infos;
  FittedEffect fitted;
  fitted.effect.name = effect.info.name;
  for (const ParameterInfo& info : effect.info.parameters) {
    if (varies(info))
      infos.push_back(&info);
    else
      fitted.effect.parameters[info.name] = info.low;
  }
  const Training training = training_of(table, map, entry, Part::training, infos, settings.threads);
  const Training held_back = training_of(table, map, entry, Part::calibration, infos, settings.threads);
  const std::vector<float> features = map.features(measured);
  const std::vector<double> observed(features.begin(), features.end());
  choose(table, training, observed, fitted.effect);
  if (infos.empty()) return fitted;

  const auto guess = stats::ParameterGuess::fit(training.features, training.parameters);
  const std::vector<double> observed_guess = guess.guess(observed);
  const auto posterior = stats::abc_posterior(training.parameters, guess.guess(training.features), observed_guess,
                                              {0.3, bounds_of(infos)});
  const stats::Matrix<double> held_back_guesses = guess.guess(held_back.features);
  fitted.includes_off = true;
  bool any_strength = false;
  for (std::size_t p = 0; p < infos.size(); ++p) {
    const ParameterInfo& info = *infos[p];
    const double widening =
        widening_of(held_back, held_back_guesses, posterior, p, observed_guess[p], settings.confidence);
    const stats::Interval flat = posterior.interval(p, settings.confidence, widening);
    FittedParameter parameter{info.name, info.unit, from_flat(info, posterior.quantile(p, 0.5)),
                              {},        info.off,  info.role == effects::Role::strength,
                              {}};
    for (int i = 0; i < 20; ++i) {
      const double middle = posterior.quantile(p, 0.5), value = posterior.quantile(p, (i + 0.5) / 20.0);
      parameter.equally_likely.push_back(from_flat(info, middle + widening * (value - middle)));
    }
    parameter.interval = {from_flat(info, flat.low), from_flat(info, flat.high)};
    if (parameter.is_strength) {
      any_strength = true;
      fitted.includes_off = fitted.includes_off && parameter.interval.contains(info.off);
    }
    fitted.effect.parameters[info.name] = parameter.value;
    fitted.parameters.push_back(std::move(parameter));
  }
  fitted.includes_off = fitted.includes_off && any_strength;
  return fitted;
}

}  // namespace pirsim::reconcile
