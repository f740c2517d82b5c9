// The sensors of a scene that answer physically: the power that each of their rays brings, and what their circuits make
// of it. The compiled part.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "body/body_part.hpp"
#include "pir/analog_circuit.hpp"
#include "pir/optics.hpp"
#include "pirsim/script.hpp"
#include "rt/tracer.hpp"

namespace pirsim::sim {

/// Power in whole steps of `watts_per_step`: sums don't depend on their order, so that no tracer and no memory changes
/// a bit, what cancels is zero, and swapped polarity is a changed sign. Good for half a watt; one ray on a person is
/// some 1e9 steps.
using PowerSteps = std::int64_t;
inline constexpr double watts_per_step = 0x1p-64;

/// Radiance of each of a person's parts, W m^-2 sr^-1.
using BodyRadiance = std::array<double, body::n_parts>;

/// Immutable. Sensors whose response is `zones` have no rays here.
class PowerModel {
 public:
  /// apertures_m2: (n_sensors) of each sensor's clusters; empty for a sensor that isn't analog.
  PowerModel(const SceneSpec& scene, const SensingSpec& sensing, const rt::Room& room,
             std::span<const std::vector<double>> apertures_m2);

  [[nodiscard]] const pir::PowerRays& rays() const noexcept { return *rays_; }
  /// The rays cut at the room.
  [[nodiscard]] const RayBundle& clipped() const noexcept { return *clipped_; }
  [[nodiscard]] std::size_t n_sensors() const noexcept { return clipped_->n_sensors(); }
  [[nodiscard]] std::uint32_t sensor_of(std::uint32_t ray) const noexcept { return sensors_[ray]; }
  /// Of the room where the ray hits it, or of the surroundings; W m^-2 sr^-1.
  [[nodiscard]] double background(std::uint32_t ray) const noexcept { return backgrounds_[ray]; }
  /// What the sensor receives more because a ray ends on a surface of this radiance and not in the background.
  [[nodiscard]] PowerSteps power(std::uint32_t ray, double radiance) const noexcept {
    return static_cast<PowerSteps>(rays_->weights[ray] * (radiance - backgrounds_[ray]) / watts_per_step);
  }

 private:
  std::unique_ptr<pir::PowerRays> rays_;
  std::unique_ptr<RayBundle> clipped_;
  std::vector<std::uint32_t> sensors_;  ///< (n_rays)
  std::vector<double> backgrounds_;     ///< (n_rays)
};

[[nodiscard]] BodyRadiance radiance_of(const WarmthSpec& warmth, double ambient_c);

/// One make of sensor, calibrated by its rated distances (pir::calibrate).
struct CalibratedSensor {
  pir::AnalogCircuit detector;
  pir::AnalogFilter silent_filter;   ///< the detector's element and amplifier, without noise
  std::vector<double> apertures_m2;  ///< (n_clusters)
};

class AnalogModel {
 public:
  AnalogModel(const SceneSpec& scene, const SensingSpec& sensing, const rt::Room& room);

  /// Is there any analog sensor?
  [[nodiscard]] static bool is_needed(const SceneSpec& scene, const SensingSpec& sensing);

  [[nodiscard]] const PowerModel& power() const noexcept { return *power_; }
  /// (n_sensors) nothing for a sensor that answers by its zones.
  [[nodiscard]] const std::vector<std::optional<CalibratedSensor>>& sensors() const noexcept { return sensors_; }

 private:
  std::vector<std::optional<CalibratedSensor>> sensors_;
  std::unique_ptr<PowerModel> power_;
};

}  // namespace pirsim::sim
