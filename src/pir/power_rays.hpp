// The rays of the physical response, each with what it is worth.
#pragma once

#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

/// No rated distance cuts these rays; this far they reach where no room does, metres.
inline constexpr float out_of_sight_m = 1000.0F;

struct PowerRays {
  RayBundle bundle;
  /// (n_rays) polarity x facet's aperture x solid angle, m^2 sr: times a difference of radiance it is a power.
  std::vector<double> weights;
};

/// Appends a sensor's rays; apertures_m2: (n_clusters of the model).
void append(PowerRays& rays, const SensorSpec& sensor, const SensorModelSpec& model,
            std::span<const double> apertures_m2, int rays_per_zone);
/// Appends a sensor without any.
void append_blind(PowerRays& rays);

}  // namespace pirsim::pir
