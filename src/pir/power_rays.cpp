#include "pir/power_rays.hpp"

#include <glm/geometric.hpp>

#include "pir/zone_quadrature.hpp"

namespace pirsim::pir {

void append(PowerRays& rays, const SensorSpec& sensor, const SensorModelSpec& model,
            std::span<const double> apertures_m2, int rays_per_zone) {
  const Frame& frame = sensor.world_from_sensor;
  RayBundle& bundle = rays.bundle;
  for (std::size_t i = 0; i < model.clusters.size(); ++i) {
    for (const ZoneSpec& zone : model.clusters[i].zones) {
      for (const WeightedDirection& each : zone_quadrature(model, zone, rays_per_zone)) {
        bundle.rays.push_back({Vec3f(frame.origin), Vec3f(glm::normalize(frame.rotation * each.direction))});
        bundle.range.push_back(out_of_sight_m);
        rays.weights.push_back(zone.polarity * apertures_m2[i] * each.solid_angle_sr);
      }
      bundle.zone_rays_begin.push_back(static_cast<std::uint32_t>(bundle.rays.size()));
    }
    bundle.cluster_zones_begin.push_back(static_cast<std::uint32_t>(bundle.n_zones()));
  }
  append_blind(rays);
}

void append_blind(PowerRays& rays) {
  rays.bundle.sensor_clusters_begin.push_back(static_cast<std::uint32_t>(rays.bundle.n_clusters()));
}

}  // namespace pirsim::pir
