#include "reconcile/model_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pirsim/core/parallel.hpp"
#include "pirsim/core/random.hpp"
#include "pirsim/effects/catalogue.hpp"
#include "pirsim/reconcile/locate.hpp"
#include "pirsim/reconcile/simulated_world.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t first_check_world = 1U << 23U;  ///< worlds that no table has seen
constexpr int datasets_per_world = 4;                   ///< where zones are remembered
constexpr std::array<std::uint32_t, 2> first_looks{20, 60};
constexpr double surely_passes = 0.25;  ///< of 20 datasets five as strange: with p 0.025 once in 10,000 models
/// Of the datasets that refuse, so many would be as strange at the level. With two (80 datasets) the strangest of a
/// hundred columns is noise: Table 1 with seats scattered had p 0.025 from 80 and 0.4 from 200.
constexpr double n_as_strange = 5.0;

/// The i-th n runs of every trial, numbered from 1.
std::vector<Series> part_of(const std::vector<Series>& runs, int i, int n) {
  std::vector<Series> part;
  for (const Series& run : runs) {
    if (run.replicate <= i * n || run.replicate > (i + 1) * n) continue;
    part.push_back(run);
    part.back().replicate -= i * n;
  }
  return part;
}

/// As they are in one world.
std::vector<EffectSpec> drawn(std::span<const FittedEffect> effects, const Laboratory& lab, std::uint64_t seed,
                              std::uint32_t world) {
  Stream stream({seed, world, 0, Purpose::model_check});
  std::vector<EffectSpec> all;
  for (const FittedEffect& fitted : effects) {
    all.push_back(fitted.effect);
    for (const FittedParameter& parameter : fitted.parameters) {
      const std::vector<double>& values = parameter.equally_likely;
      if (values.empty()) continue;
      all.back().parameters.at(parameter.name) = values[stream.index(static_cast<std::uint32_t>(values.size()))];
    }
    all.back() = effects::settled(std::move(all.back()), lab.source.scene);
  }
  return all;
}

/// Simulates datasets of one model, more and more.
class Ensemble {
 public:
  Ensemble(std::span<const FittedEffect> effects, const Laboratory& lab, const ModelCheckSettings& settings)
      : effects_(effects), lab_(lab), settings_(settings) {}

  /// (n x n_statistics) of all worlds up to this one.
  const stats::Matrix<float>& up_to(std::uint32_t n_worlds) {
    using Rows = std::vector<std::vector<float>>;
    ordered_parallel<Rows>(
        n_worlds - n_worlds_, settings_.threads,
        [&](std::size_t i) { return datasets_of(first_check_world + n_worlds_ + static_cast<std::uint32_t>(i)); },
        [&](const Rows& rows) {
          for (const auto& row : rows) datasets_.append_row(std::span<const float>(row));
        });
    n_worlds_ = n_worlds;
    return datasets_;
  }

 private:
  [[nodiscard]] std::vector<std::vector<float>> datasets_of(std::uint32_t index) const {
    const std::vector<EffectSpec> effects = drawn(effects_, lab_, settings_.seed, index);
    const int n = lab_.shape.n_replicates, per_world = acts_on_remembered_zones(effects) ? datasets_per_world : 1;
    const SimulatedWorld world(lab_.source, lab_.frame, index, n * per_world);
    const auto data = world.with_effects(effects, 0, n * per_world);
    std::vector<std::vector<float>> rows;
    for (int d = 0; data && d < per_world; ++d)
      rows.push_back(statistics_of(lab_.frame, lab_.shape, lab_.table.profile, part_of(*data, d, n)));
    return rows;
  }

  std::span<const FittedEffect> effects_;
  const Laboratory& lab_;
  const ModelCheckSettings& settings_;
  stats::Matrix<float> datasets_;
  std::uint32_t n_worlds_ = 0;
};

}  // namespace

double level_with(std::size_t n_put_in, double alpha) { return alpha * std::pow(0.5, static_cast<double>(n_put_in)); }

double p_with(std::span<const FittedEffect> put_in, const Laboratory& lab, const FeatureMap& map,
              std::span<const float> observed, const ModelCheckSettings& settings) {
  Ensemble ensemble(put_in, lab, settings);
  const auto p_of = [&](std::uint32_t n_worlds) {
    const stats::Matrix<float>& datasets = ensemble.up_to(n_worlds);
    if (datasets.rows() < 2) return 0.0;
    return locate(lab.frame, map, datasets, observed, {settings.level, settings.seed, settings.threads}).p;
  };
  for (const std::uint32_t n_worlds : first_looks) {
    const double p = p_of(n_worlds);
    if (p > surely_passes) return p;
  }
  const auto n_to_refuse = static_cast<std::uint32_t>(std::ceil(n_as_strange / settings.level));
  return p_of(std::max(n_to_refuse, first_looks.back()));
}

}  // namespace pirsim::reconcile
