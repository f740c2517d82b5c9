// The rule of motion the slow way, byte by byte: what pir::Channels is tested against.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/script.hpp"

namespace pirsim::test {

/// bits[s] becomes 1 where, from one tick to the next, a beam's zone of sensor s changes its activity, or a cluster of
/// them, which is active where any of its zones is. before, after: (n_zones); bits: (n_sensors).
inline void mark_motion(const RayBundle& bundle, ChangePer change_per, std::span<const std::uint8_t> before,
                        std::span<const std::uint8_t> after, std::span<std::uint8_t> bits) {
  const auto any = [](std::span<const std::uint8_t> activity, std::uint32_t first, std::uint32_t last) {
    const auto zones = activity.subspan(first, last - first);
    return std::ranges::any_of(zones, [](std::uint8_t active) { return active != 0; });
  };
  for (std::size_t sensor = 0; sensor < bundle.n_sensors(); ++sensor) {
    for (auto c = bundle.sensor_clusters_begin[sensor]; c < bundle.sensor_clusters_begin[sensor + 1]; ++c) {
      const auto first = bundle.cluster_zones_begin[c], last = bundle.cluster_zones_begin[c + 1];
      if (change_per == ChangePer::cluster && any(before, first, last) != any(after, first, last)) bits[sensor] = 1;
      for (auto zone = first; zone < last && change_per == ChangePer::beam; ++zone) {
        if ((before[zone] != 0) != (after[zone] != 0)) bits[sensor] = 1;
      }
    }
  }
}

}  // namespace pirsim::test
