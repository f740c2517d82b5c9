// All rays of all sensors of a scene, compiled once and traced every tick.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/geom/shapes.hpp"

namespace pirsim {

/// Rays grouped by zone, zones by cluster, clusters by sensor, each group contiguous and in file order.
/// `zone_rays_begin` has n_zones + 1 entries: zone z owns rays [zone_rays_begin[z], zone_rays_begin[z + 1]);
/// likewise `cluster_zones_begin` (n_clusters + 1) and `sensor_clusters_begin` (n_sensors + 1).
struct RayBundle {
  std::vector<Ray> rays;     ///< (n_rays) world frame
  std::vector<float> range;  ///< (n_rays) metres; rated range, or less where the room cuts the ray
  std::vector<std::uint32_t> zone_rays_begin{0};
  std::vector<std::uint32_t> cluster_zones_begin{0};
  std::vector<std::uint32_t> sensor_clusters_begin{0};

  [[nodiscard]] std::size_t n_zones() const noexcept { return zone_rays_begin.size() - 1; }
  [[nodiscard]] std::size_t n_clusters() const noexcept { return cluster_zones_begin.size() - 1; }
  [[nodiscard]] std::size_t n_sensors() const noexcept { return sensor_clusters_begin.size() - 1; }
};

/// Activity of every zone at one tick: 1 where at least one of the zone's rays meets a person. (n_zones)
using ZoneActivity = std::vector<std::uint8_t>;

}  // namespace pirsim
