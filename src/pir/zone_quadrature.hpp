// A zone with soft edges as a few rays with weights.
#pragma once

#include <vector>

#include "pirsim/geometry.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

struct WeightedDirection {
  Vec3 direction{0.0};          ///< unit, in the sensor's frame
  double solid_angle_sr = 0.0;  ///< that it stands for
};

/// Of the zone's outline as drawn, steradian. Ref: [VanOosterom1983].
[[nodiscard]] double solid_angle_sr(const SensorModelSpec& model, const ZoneSpec& zone);

/// `n` >= 1 directions spread evenly (a rank-1 lattice of the golden ratio) over the zone as the lens' point spread
/// blurs it: where the zone is half as sensitive they lie half as dense. Their weights sum to the zone's solid angle.
[[nodiscard]] std::vector<WeightedDirection> zone_quadrature(const SensorModelSpec& model, const ZoneSpec& zone, int n);

}  // namespace pirsim::pir
