// From a sensor's lens data to rays.
#pragma once

#include <vector>

#include "pirsim/geom/ray_bundle.hpp"
#include "pirsim/schema/scene_spec.hpp"
#include "pirsim/schema/script_spec.hpp"
#include "pirsim/schema/sensor_model_spec.hpp"

namespace pirsim::pir {

/// Unit directions in the sensor's frame of the points that stand for one zone: its centre (one), corners and centre
/// (five), or a grid that spans the zone (nine: 3 x 3, sixteen: 4 x 4). Ref: [Stefansson2021] Figure 2b.
[[nodiscard]] std::vector<Vec3> zone_directions(const SensorModelSpec& model, const ZoneSpec& zone, RaysPerZone rays);

/// Appends a sensor's rays at their rated ranges.
void append(RayBundle& bundle, const SensorSpec& sensor, const SensorModelSpec& model, RaysPerZone rays);

}  // namespace pirsim::pir
