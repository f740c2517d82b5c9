// Can the model with effects applied have made the data?
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "reconcile/inference/reference_study.hpp"

namespace pirsim::reconcile {

/// Level of the global test of a model into which so many effects were applied: halved with every one.
[[nodiscard]] double level_with(std::size_t n_applied, double alpha);

/// What is asked of one model.
struct PatchedModel {
  std::span<const FittedEffect> applied;
  std::span<const float> observed;  ///< statistics of the data
};

/// p of each model's global test, its datasets simulated in realizations that no table has seen. What was fitted isn't
/// known for sure: in every realization the parameters are other ones of those that are equally likely. Datasets are
/// simulated only until they surely don't refuse the model, and all of them if they do, so that looking more than once
/// refuses no more models than the level allows. 0 if people can hardly get about in it. A realization is traced once
/// for all models; what is said of one doesn't depend on the others. map: of the plain model, with the trials to be
/// looked at; level: of the global test; on_look is told how many models are still simulated, and in how many
/// realizations.
[[nodiscard]] std::vector<double> p_with(std::span<const PatchedModel> models, const ReferenceStudy& reference,
                                         const FeatureMap& map, double level, const Context& context,
                                         const std::function<void(std::size_t, std::uint32_t)>& on_look = {});

}  // namespace pirsim::reconcile
