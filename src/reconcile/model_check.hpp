// Can the model with effects put in have made the data?
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pirsim/reconcile/reconcile.hpp"

namespace pirsim::reconcile {

struct ModelCheckSettings {
  double level = 0.025;  ///< of the global test
  std::uint64_t seed = 0;
  unsigned threads = 0;
};

/// Level of the global test of a model into which so many effects were put: halved with every one.
[[nodiscard]] double level_with(std::size_t n_put_in, double alpha);

/// p of the global test of the model with these effects, its datasets simulated in worlds that no table has seen. What
/// was fitted isn't known for sure: in every world the parameters are other ones of those that are equally likely.
/// Datasets are simulated only until they surely don't refuse the model, and all of them if they do, so that looking
/// more than once refuses no more models than the level allows. 0 if people can hardly get about in it.
/// map: of the plain model, with the trials to be looked at; observed: statistics of the data.
[[nodiscard]] double p_with(std::span<const FittedEffect> put_in, const Laboratory& lab, const FeatureMap& map,
                            std::span<const float> observed, const ModelCheckSettings& settings);

}  // namespace pirsim::reconcile
