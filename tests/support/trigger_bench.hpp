// Triggers made by hand, for effects that act on them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "pirsim/random.hpp"

namespace pirsim::test {

/// With typical values for what isn't given.
inline EffectSpec effect(const std::string& name, std::map<std::string, double, std::less<>> parameters,
                         std::map<std::string, std::string, std::less<>> choices = {}) {
  return effects::resolved(effects::find(name), {name, std::move(parameters), std::move(choices), {}});
}

/// Two sensors that see nothing.
struct Bench {
  SceneSpec scene;
  SensingSpec sensing;
  RayBundle rays;
  std::uint32_t n_runs = 1;

  Bench() {
    scene.name = "bench";
    scene.sensors = {{"A", "none", {}}, {"B", "none", {}}};
  }
  [[nodiscard]] effects::Pipeline pipeline(const std::vector<EffectSpec>& effects, std::uint32_t run = 0) const {
    effects::Pipeline pipeline(effects, {scene, sensing, rays, n_runs});
    pipeline.begin_run(1, run);
    return pipeline;
  }
};

using Series = std::vector<std::uint8_t>;  ///< (n_ticks) of one sensor, from tick 1 on

inline Series random_triggers(std::size_t n, double probability) {
  Stream stream({3, 0, 0, Purpose::test});
  Series series(n);
  for (std::uint8_t& trigger : series) trigger = stream.uniform() < probability ? 1 : 0;
  return series;
}

}  // namespace pirsim::test
