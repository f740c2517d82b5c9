#include "reconcile/model_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "pirsim/core/parallel.hpp"
#include "pirsim/core/random.hpp"
#include "pirsim/effects/catalogue.hpp"
#include "pirsim/reconcile/locate.hpp"
#include "pirsim/reconcile/outcome.hpp"
#include "pirsim/reconcile/simulated_world.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t first_check_world = 1U << 23U;       ///< worlds that no table has seen
constexpr int datasets_per_world = 4;                        ///< where zones are remembered (assumed)
constexpr std::array<std::uint32_t, 2> first_looks{20, 60};  ///< worlds (assumed: only time depends on them)
constexpr double n_as_strange = 5.0;                         ///< datasets, the data among them (assumed)

/// A quarter of the datasets are as strange, five at least: of 20 with p 0.025 once in 10,000 models.
bool surely_passes(double p, std::size_t n_datasets) {
  const double as_strange = p * static_cast<double>(n_datasets + 1);  // the data themselves count
  return p > 0.25 && as_strange > n_as_strange;
}

/// With fewer datasets no data are strange enough.
bool can_refuse(std::size_t n_datasets, double level) { return static_cast<double>(n_datasets + 1) * level >= 1.0; }

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

int datasets_a_world(std::span<const FittedEffect> effects) {
  std::vector<EffectSpec> specs;
  for (const FittedEffect& fitted : effects) specs.push_back(fitted.effect);
  return acts_on_remembered_zones(specs) ? datasets_per_world : 1;
}

/// Simulates datasets of some models, more and more.
class Ensembles {
 public:
  Ensembles(std::span<const PatchedModel> models, const Laboratory& lab, const ModelCheckSettings& settings)
      : models_(models), lab_(lab), settings_(settings), datasets_(models.size()) {}

  /// Simulates those models, by index, in all worlds up to this one. Call with fewer models and more worlds each time.
  void extend(std::span<const std::size_t> which, std::uint32_t n_worlds) {
    ordered_parallel<std::vector<Rows>>(
        n_worlds - n_worlds_, settings_.threads,
        [&](std::size_t i) {
          return datasets_in(first_check_world + n_worlds_ + static_cast<std::uint32_t>(i), which);
        },
        [&](const std::vector<Rows>& of_models) {
          for (std::size_t k = 0; k < which.size(); ++k) {
            for (const auto& row : of_models[k]) datasets_[which[k]].append_row(std::span<const float>(row));
          }
        });
    n_worlds_ = n_worlds;
  }

  /// (n x n_statistics) of one model.
  [[nodiscard]] const stats::Matrix<float>& of(std::size_t model) const { return datasets_[model]; }
  void forget(std::size_t model) { datasets_[model] = {}; }

 private:
  using Rows = std::vector<std::vector<float>>;

  [[nodiscard]] std::vector<Rows> datasets_in(std::uint32_t index, std::span<const std::size_t> which) const {
    std::vector<Rows> all(which.size());
    for (const int per_world : {1, datasets_per_world}) {
      std::optional<SimulatedWorld> world;
      for (std::size_t k = 0; k < which.size(); ++k) {
        const std::span<const FittedEffect> put_in = models_[which[k]].put_in;
        if (datasets_a_world(put_in) != per_world) continue;
        if (!world) world.emplace(lab_.source, lab_.frame, index, lab_.shape.n_replicates * per_world);
        all[k] = datasets_of(put_in, *world, index, per_world);
      }
    }
    return all;
  }

  [[nodiscard]] Rows datasets_of(std::span<const FittedEffect> put_in, const SimulatedWorld& world, std::uint32_t index,
                                 int per_world) const {
    const int n = lab_.shape.n_replicates;
    const auto data = world.with_effects(drawn(put_in, lab_, settings_.seed, index), 0, n * per_world);
    Rows rows;
    for (int d = 0; data && d < per_world; ++d)
      rows.push_back(statistics_of(lab_.frame, lab_.shape, lab_.table.profile, part_of(*data, d, n)));
    return rows;
  }

  std::span<const PatchedModel> models_;
  const Laboratory& lab_;
  const ModelCheckSettings& settings_;
  std::vector<stats::Matrix<float>> datasets_;  // one a model
  std::uint32_t n_worlds_ = 0;
};

}  // namespace

double level_with(std::size_t n_put_in, double alpha) { return alpha * std::pow(0.5, static_cast<double>(n_put_in)); }

std::vector<double> p_with(std::span<const PatchedModel> models, const Laboratory& lab, const FeatureMap& map,
                           const ModelCheckSettings& settings,
                           const std::function<void(std::size_t, std::uint32_t)>& on_look) {
  Ensembles ensembles(models, lab, settings);
  std::vector<double> p(models.size());
  std::vector<std::size_t> in_doubt(models.size());
  std::iota(in_doubt.begin(), in_doubt.end(), std::size_t{0});
  const auto n_to_refuse = static_cast<std::uint32_t>(std::ceil(worlds_to_refuse / settings.level));
  for (const std::uint32_t n_worlds : {first_looks[0], first_looks[1], std::max(n_to_refuse, first_looks[1])}) {
    if (in_doubt.empty()) break;
    if (on_look) on_look(in_doubt.size(), n_worlds);
    ensembles.extend(in_doubt, n_worlds);
    std::vector<std::size_t> still;
    for (const std::size_t k : in_doubt) {
      const stats::Matrix<float>& datasets = ensembles.of(k);
      if (datasets.rows() > 1)
        p[k] =
            locate(lab.frame, map, datasets, models[k].observed, {settings.level, settings.seed, settings.threads}).p;
      if (surely_passes(p[k], datasets.rows()))
        ensembles.forget(k);
      else
        still.push_back(k);
    }
    in_doubt = std::move(still);
  }
  for (const std::size_t k : in_doubt) {
    if (!can_refuse(ensembles.of(k).rows(), settings.level)) p[k] = 0.0;
  }
  return p;
}

}  // namespace pirsim::reconcile
