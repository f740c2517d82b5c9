// Everything immutable about the sensors of a scene that answer physically.
#pragma once

#include <optional>
#include <vector>

#include "pir/analog_detector.hpp"
#include "sim/power_model.hpp"

namespace pirsim::sim {

/// One make of sensor, calibrated by its rated distances (pir::calibrate).
struct CalibratedSensor {
  pir::AnalogDetector detector;
  pir::AnalogFilter silent_filter;   ///< the detector's element and amplifier, without noise
  std::vector<double> apertures_m2;  ///< (n_clusters)
};

class AnalogModel {
 public:
  AnalogModel(const SceneSpec& scene, const SensingSpec& sensing, const rt::Room& room);

  /// How sensor `sensor` answers: as the study wants it, or as its own data says.
  [[nodiscard]] static Response response(const SceneSpec& scene, const SensingSpec& sensing, std::size_t sensor);
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
