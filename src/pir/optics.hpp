// From a sensor's lens data to rays.
#pragma once

#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

/// Unit directions in the sensor's frame of the points that stand for one zone: its centre (one), corners and centre
/// (five), or a grid that spans the zone (nine: 3 x 3, sixteen: 4 x 4). Ref: [Stefansson2021] Figure 2b.
[[nodiscard]] std::vector<Vec3> zone_directions(const SensorModelSpec& model, const ZoneSpec& zone, RaysPerZone rays);

/// The zone with every edge moved outward by `angle` (radians, as the sensor sees it; negative: inward, at most until
/// an edge meets the centre).
[[nodiscard]] ZoneSpec grown(const SensorModelSpec& model, const ZoneSpec& zone, double angle);

/// By how much the nested copies of a zone are grown that together stand for an edge blurred by a normal distribution:
/// its quantiles at (i + 1/2) / n, radians, 0 first. Hard edges have one copy.
[[nodiscard]] std::vector<double> edge_levels(double sigma_deg);

/// Appends a sensor's rays at their rated ranges: all clusters as they are, then all of them again for every other
/// level of growth.
void append(RayBundle& bundle, const SensorSpec& sensor, const SensorModelSpec& model, RaysPerZone rays,
            std::span<const double> levels = {});

}  // namespace pirsim::pir
