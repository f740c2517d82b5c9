// Numbers of a sensor that mean nothing to the response that a study gives it.
#pragma once

#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// A warning for each sensor model that hard zones leave numbers of unused: those that differ from the defaults, which
/// stand for the EKMC family.
[[nodiscard]] std::vector<Issue> idle_sensor_keys(const SceneSpec& scene, const SensingSpec& sensing);

}  // namespace pirsim
