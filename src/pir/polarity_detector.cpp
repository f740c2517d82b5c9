#include "pir/polarity_detector.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "pirsim/geometry.hpp"

namespace pirsim::pir {

PolarityDetector::PolarityDetector(const SceneSpec& scene, const DualPolaritySpec& spec, std::size_t n_levels,
                                   double tick_s)
    : threshold_(spec.threshold),
      fast_share_(-std::expm1(-2.0 * pi * spec.low_pass_hz * tick_s)),
      slow_share_(-std::expm1(-2.0 * pi * spec.high_pass_hz * tick_s)),
      filters_(scene.sensors.size()) {
  for (std::uint32_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
    for (std::size_t level = 0; level < n_levels; ++level) {
      for (const ClusterSpec& cluster : scene.sensor_models.at(scene.sensors[sensor].model).clusters) {
        for (const ZoneSpec& zone : cluster.zones) {
          weight_.push_back(zone.polarity / static_cast<double>(n_levels));
          sensor_.push_back(sensor);
        }
      }
    }
  }
}

void PolarityDetector::begin_run(std::span<const double> rest) noexcept {
  for (std::size_t s = 0; s < filters_.size(); ++s) filters_[s] = {rest[s], rest[s]};
}

void PolarityDetector::add_up(const ZoneSet& zones, std::span<double> sums) const noexcept {
  std::ranges::fill(sums, 0.0);
  std::size_t first = 0;
  for (ZoneSet::Word word : zones.words()) {
    for (; word != 0; word &= word - 1) {
      const std::size_t zone = first + static_cast<std::size_t>(std::countr_zero(word));
      sums[sensor_[zone]] += weight_[zone];
    }
    first += ZoneSet::bits_per_word;
  }
}

void PolarityDetector::tick(std::span<const double> sums, std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t s = 0; s < filters_.size(); ++s) {
    Filter& filter = filters_[s];
    filter.fast += fast_share_ * (sums[s] - filter.fast);
    filter.slow += slow_share_ * (filter.fast - filter.slow);
    if (std::abs(filter.fast - filter.slow) > threshold_) triggers[s] = 1;
  }
}

}  // namespace pirsim::pir
