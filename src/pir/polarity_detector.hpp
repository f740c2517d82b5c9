// The pyroelectric pair: zones of either sign, a band-pass, a threshold.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "schema/study_in_force.hpp"

namespace pirsim::pir {

/// A sensor triggers while the filtered sum of its active zones, each with its element's sign, is beyond the threshold
/// on either side. Zones of both signs under one person cancel, slow changes leak away. A value.
class PolarityDetector {
 public:
  /// n_levels: copies of every zone (pir::append), which share its weight.
  PolarityDetector(const SceneSpec& scene, const DualPolaritySpec& spec, std::size_t n_levels, double tick_s);

  /// rest: (n_sensors) sums of the signs of zones that have been active for long.
  void begin_run(std::span<const double> rest) noexcept;
  /// sums: (n_sensors) of the signs of active zones.
  void add_up(const ZoneSet& zones, std::span<double> sums) const noexcept;
  /// One tick; sets triggers[s] (n_sensors) where sensor s triggers.
  void tick(std::span<const double> sums, std::span<std::uint8_t> triggers) noexcept;
  [[nodiscard]] std::size_t n_sensors() const noexcept { return filters_.size(); }
  bool operator==(const PolarityDetector&) const = default;

 private:
  struct Filter {
    double fast = 0.0;  ///< low-passed sum
    double slow = 0.0;  ///< what the high-pass takes off it
    bool operator==(const Filter&) const = default;
  };
  std::vector<double> weight_;         ///< (n_zones)
  std::vector<std::uint32_t> sensor_;  ///< (n_zones)
  double threshold_;
  double fast_share_, slow_share_;  ///< of the difference that is taken over in a tick
  std::vector<Filter> filters_;     ///< (n_sensors)
};

}  // namespace pirsim::pir
