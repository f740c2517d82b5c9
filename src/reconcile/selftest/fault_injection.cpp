#include <algorithm>
#include <array>
#include <cmath>

#include "engine/effects/catalogue.hpp"
#include "model/core/random.hpp"
#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/fit.hpp"
#include "reconcile/selftest/selftest.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t first_injected_realization = 1U << 25U;  ///< realizations that no table has seen
constexpr std::uint32_t most_draws = 200;                        ///< for parameters of the strength wanted

/// What one dataset is to be.
struct Plan {
  CaseKind kind = CaseKind::nothing;
  Strength strength = Strength::none;
  const effects::Effect* effect = nullptr;  ///< of one effect
};

bool comes_in_strengths(const EffectSpec& spec) {
  const effects::ParameterInfo& first = effects::strength_parameter(spec);
  return first.low < first.high;
}

std::vector<Plan> plans_of(const ReferenceStudy& reference, const SelftestSettings& settings) {
  std::vector<Plan> plans(settings.n_nulls);
  for (const std::string& name : reference.table.effects) {
    const effects::Effect* effect = &effects::find(name);
    for (const Strength strength : {Strength::weak, Strength::medium, Strength::strong}) {
      plans.insert(plans.end(), settings.n_injected, Plan{CaseKind::one, strength, effect});
    }
  }
  const std::uint32_t n_pairs = reference.table.effects.size() < 2 ? 0 : settings.n_pairs;
  plans.insert(plans.end(), n_pairs, Plan{CaseKind::two, Strength::none, nullptr});
  return plans;
}

/// None if the draw isn't what the plan wants.
std::optional<std::vector<EffectSpec>> draw(const Plan& plan, const std::vector<std::string>& names,
                                            const Realization& realization, Stream& stream) {
  std::vector<const effects::Effect*> wanted;
  if (plan.effect != nullptr) wanted.push_back(plan.effect);
  while (plan.kind == CaseKind::two && wanted.size() < 2) {
    const effects::Effect* one = &effects::find(names[stream.index(static_cast<std::uint32_t>(names.size()))]);
    if (wanted.empty() || wanted.front() != one) wanted.push_back(one);
  }
  std::vector<EffectSpec> drawn;
  for (const effects::Effect* effect : wanted) {
    drawn.push_back(effects::draw_from_prior(*effect, realization.scene, realization.script, stream));
    const bool any_will_do = plan.kind == CaseKind::two || !comes_in_strengths(drawn.back());
    if (!any_will_do && strength_of(drawn.back()) != plan.strength) return std::nullopt;
  }
  return drawn;
}

/// The dataset of the index-th plan, or none.
TableChunk inject(const Plan& plan, std::uint32_t index, const ReferenceStudy& reference, int n_replicates,
                  std::uint64_t seed) {
  TableChunk chunk;
  const SimulatedRealization realization(reference.source, reference.frame, first_injected_realization + index,
                                         n_replicates);
  for (std::uint32_t attempt = 0; attempt < most_draws; ++attempt) {
    Stream stream({seed, index, attempt, Purpose::injected_effects});
    const auto effects = draw(plan, reference.table.effects, realization.drawn(), stream);
    if (!effects) continue;
    auto data = realization.with_effects(*effects, 0, n_replicates);
    if (!data) continue;
    chunk.datasets.push_back({{index, first_injected_realization + index, *effects}, std::move(*data)});
    return chunk;
  }
  ++chunk.n_left_out;
  return chunk;
}

std::string key_of(const ReferenceStudy& reference, const SelftestSettings& settings, std::uint64_t seed) {
  std::string text = "injected in " + reference.table.key;
  for (const std::uint64_t n : {static_cast<std::uint64_t>(settings.n_replicates), std::uint64_t{settings.n_nulls},
                                std::uint64_t{settings.n_injected}, std::uint64_t{settings.n_pairs}, seed}) {
    text += ' ' + std::to_string(n);
  }
  return sha256(text);
}

}  // namespace

Strength strength_of(const EffectSpec& spec) {
  if (!comes_in_strengths(spec)) return Strength::medium;
  const effects::ParameterInfo& first = effects::strength_parameter(spec);
  const double off = to_flat(first, first.off);
  const double most = std::max(to_flat(first, first.high) - off, off - to_flat(first, first.low));
  const double distance =
      std::abs(to_flat(first, spec.parameters.at(first.name)) - off) / most;  // of the prior, 0 to 1
  return static_cast<Strength>(1 + std::min(2, static_cast<int>(3.0 * distance)));
}

std::string InjectedDataset::truth() const {
  std::string text;
  for (const EffectSpec& effect : effects) text += (text.empty() ? "" : " + ") + effect.name;
  return text.empty() ? "nothing" : text;
}

std::vector<InjectedDataset> inject(const ReferenceStudy& reference, const SelftestSettings& settings,
                                    const Context& context) {
  context.begin("datasets with injected faults");
  const std::vector<Plan> plans = plans_of(reference, settings);
  const std::string key = key_of(reference, settings, context.seed);
  std::filesystem::path folder = settings.injected_folder;
  if (!folder.empty()) folder += "_" + key.substr(0, 8);  // other numbers are kept beside the first
  TableStore store(folder, key);
  std::vector<InjectedDataset> injected;
  for_each_chunk(
      store, static_cast<std::uint32_t>(plans.size()), context,
      [&](std::uint32_t index) { return inject(plans[index], index, reference, settings.n_replicates, context.seed); },
      [&](TableChunk& chunk) {
        for (SimulatedDataset& dataset : chunk.datasets) {
          const Plan& plan = plans[dataset.row.hypothesis];
          injected.push_back({plan.kind, plan.strength, std::move(dataset.row.effects),
                              statistics_of(reference.frame, reference.shape, reference.table.profile, dataset.runs)});
        }
      });
  return injected;
}

}  // namespace pirsim::reconcile
