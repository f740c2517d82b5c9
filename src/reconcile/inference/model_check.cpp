#include "reconcile/inference/model_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"
#include "effects/catalogue.hpp"
#include "pirsim/random.hpp"
#include "reconcile/ensemble/simulated_realization.hpp"
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

/// As they are in one realization.
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

/// Simulates datasets of some models, more and more. Of each model one in a realization: those of one realization share
/// the room, so that data of another room would be stranger than any of them.
class Ensembles {
 public:
  Ensembles(std::span<const PatchedModel> models, const ReferenceStudy& reference, const Context& context)
      : models_(models), reference_(reference), context_(context), datasets_(models.size()) {}

  /// Simulates those models, by index, in all realizations up to this one. Call with fewer models and more realizations
  /// each time.
  void extend(std::span<const std::size_t> which, std::uint32_t n_realizations) {
    ordered_parallel<Rows>(
        n_realizations - n_realizations_, context_.threads,
        [&](std::size_t i) {
          return datasets_in(first_check_realization + n_realizations_ + static_cast<std::uint32_t>(i), which);
        },
        [&](const Rows& rows) {
          for (std::size_t k = 0; k < which.size(); ++k) {
            if (!rows[k].empty()) datasets_[which[k]].append_row(std::span<const float>(rows[k]));
          }
        });
    n_realizations_ = n_realizations;
  }

  /// (n x n_statistics) of one model.
  [[nodiscard]] const stats::Matrix<float>& of(std::size_t model) const { return datasets_[model]; }
  void forget(std::size_t model) { datasets_[model] = {}; }

 private:
  using Rows = std::vector<std::vector<float>>;  ///< one a model; empty: people can't get about

  [[nodiscard]] Rows datasets_in(std::uint32_t index, std::span<const std::size_t> which) const {
    const int n = reference_.shape.n_replicates;
    const SimulatedRealization realization(reference_.source, reference_.frame, index, n);
    Rows rows;
    for (const std::size_t k : which) {
      const auto data = realization.with_effects(drawn(models_[k].applied, reference_, context_.seed, index), 0, n);
      rows.push_back(data ? statistics_of(reference_.frame, reference_.shape, reference_.table.profile, *data)
                          : std::vector<float>());
    }
    return rows;
  }

  std::span<const PatchedModel> models_;
  const ReferenceStudy& reference_;
  const Context& context_;
  std::vector<stats::Matrix<float>> datasets_;  // one a model
  std::uint32_t n_realizations_ = 0;
};

}  // namespace

double level_with(std::size_t n_applied, double alpha) { return alpha * std::pow(0.5, static_cast<double>(n_applied)); }

std::vector<GlobalP> p_with(std::span<const PatchedModel> models, const ReferenceStudy& reference,
                            const FeatureMap& map, double level, const Context& context) {
  Ensembles ensembles(models, reference, context);
  std::vector<GlobalP> p(models.size());
  std::vector<std::size_t> in_doubt(models.size());
  std::iota(in_doubt.begin(), in_doubt.end(), std::size_t{0});
  const auto n_to_refuse = static_cast<std::uint32_t>(std::ceil(realizations_to_refuse / level));
  for (const std::uint32_t n_realizations : {first_looks[0], first_looks[1], std::max(n_to_refuse, first_looks[1])}) {
    if (in_doubt.empty()) break;
    ensembles.extend(in_doubt, n_realizations);
    std::vector<std::size_t> still;
    for (const std::size_t k : in_doubt) {
      const stats::Matrix<float>& datasets = ensembles.of(k);
      if (datasets.rows() > 1) {
        const Location seen = locate(reference.frame, map, datasets, models[k].observed, level, context);
        p[k] = {seen.p, seen.least_p()};
      }
      if (surely_passes(p[k].p, datasets.rows()))
        ensembles.forget(k);
      else
        still.push_back(k);
    }
    in_doubt = std::move(still);
  }
  for (const std::size_t k : in_doubt) {
    if (!can_refuse(ensembles.of(k).rows(), level)) p[k] = {};
  }
  return p;
}

}  // namespace pirsim::reconcile
