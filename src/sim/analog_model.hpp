// The sensors of a scene that answer physically: the power that each of their rays brings, and what their circuits make
// of it. The compiled part.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "body/body_part.hpp"
#include "pir/analog_circuit.hpp"
#include "pir/optics.hpp"
#include "rt/tracer.hpp"
#include "schema/study_in_force.hpp"

namespace pirsim::sim {

/// Power in whole steps of `watts_per_step`, as if every facet had the aperture of its lens' first step: sums don't
/// depend on their order, so that no tracer and no memory changes a bit, what cancels is zero, and swapped polarity is
/// a changed sign. Good for half a watt; one ray on a person is some 1e9 steps.
using PowerSteps = std::int64_t;
inline constexpr double watts_per_step = 0x1p-64;

/// Radiance of each of a person's parts, W m^-2 sr^-1.
using BodyRadiance = std::array<double, body::n_parts>;

/// The rays of analog sensors and what they are worth: optics alone, whatever the electronics. Sensors whose response
/// is `zones` have no rays here. Immutable.
///
/// A *receiver* is one lens step of one sensor. What each receives is kept apart: by how much the steps' apertures
/// differ follows from the electronics, and powers that were measured once serve any of them.
class PowerModel {
 public:
  /// like: a model whose lenses are shared where they are the same, or null.
  PowerModel(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room, const PowerModel* like);

  [[nodiscard]] const pir::PowerRays& rays() const noexcept { return *rays_; }
  /// The rays cut at the room.
  [[nodiscard]] const RayBundle& clipped() const noexcept { return *clipped_; }
  [[nodiscard]] std::size_t n_receivers() const noexcept { return receivers_begin_.back(); }
  /// (n_sensors + 1) sensor s has the receivers [begin[s], begin[s + 1]), in ascending order of their lens steps.
  [[nodiscard]] const std::vector<std::uint32_t>& receivers_begin() const noexcept { return receivers_begin_; }
  [[nodiscard]] std::uint32_t receiver_of(std::uint32_t ray) const noexcept { return receivers_[ray]; }
  /// Of the room where the ray hits it, or of the surroundings; W m^-2 sr^-1.
  [[nodiscard]] double background(std::uint32_t ray) const noexcept { return backgrounds_[ray]; }
  /// What the receiver gets more because a ray ends on a surface of this radiance and not in the background.
  [[nodiscard]] PowerSteps power(std::uint32_t ray, double radiance) const noexcept {
    return static_cast<PowerSteps>(rays_->weights[ray] * (radiance - backgrounds_[ray]) / watts_per_step);
  }

 private:
  /// One make's rays, and what they follow from.
  struct Lens {
    SensorModelSpec model;  ///< as blurred as effects make it
    int rays_per_zone = 0;
    std::vector<pir::WeightedDirection> quadrature;
  };
  using Lenses = std::map<std::string, std::shared_ptr<const Lens>, std::less<>>;  ///< by the model's id
  [[nodiscard]] const Lens& lens(const SensorModelSpec& model, const SensingInForce& sensing, const PowerModel* like);

  Lenses lenses_;
  std::unique_ptr<pir::PowerRays> rays_;
  std::unique_ptr<RayBundle> clipped_;
  std::vector<std::uint32_t> receivers_begin_{0};  ///< (n_sensors + 1)
  std::vector<std::uint32_t> receivers_;           ///< (n_rays)
  std::vector<double> backgrounds_;                ///< (n_rays)
};

[[nodiscard]] BodyRadiance radiance_of(const WarmthSpec& warmth, double ambient_c);

/// One make of sensor, calibrated by its rated distances (pir::calibrate) through the lens as it was made: what blurs
/// it later leaves the gain as it is.
struct CalibratedSensor {
  SensorModelSpec model;
  double tick_s, gain;
  pir::AnalogCircuit detector;
  pir::AnalogFilter silent_filter;           ///< the detector's element and amplifier, without noise
  std::vector<double> rated_watts_per_step;  ///< (n_lens_steps) of power through facets with the step's own aperture
  std::vector<double> watts_per_step;        ///< the same times the gain

  /// powers: (n_lens_steps)
  [[nodiscard]] double watts(std::span<const PowerSteps> powers) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < powers.size(); ++i) sum += static_cast<double>(powers[i]) * watts_per_step[i];
    return sum;
  }
};

class AnalogModel {
 public:
  /// like: a model whose lenses and calibrated sensors are shared where they are the same, or null.
  AnalogModel(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room,
              const AnalogModel* like = nullptr);

  /// Is there any analog sensor?
  [[nodiscard]] static bool is_needed(const SceneSpec& scene, const SensingSpec& sensing);

  [[nodiscard]] const PowerModel& power() const noexcept { return *power_; }
  /// What one step of a receiver's power is worth with its own aperture.
  [[nodiscard]] double watts_per_step(std::size_t sensor, std::size_t receiver) const noexcept {
    return sensors_[sensor]->watts_per_step[receiver - power_->receivers_begin()[sensor]];
  }
  /// All that an analog sensor receives. powers: (n_receivers)
  [[nodiscard]] double watts(std::size_t sensor, std::span<const PowerSteps> powers) const noexcept {
    const std::vector<std::uint32_t>& begin = power_->receivers_begin();
    return sensors_[sensor]->watts(powers.subspan(begin[sensor], begin[sensor + 1] - begin[sensor]));
  }
  /// (n_sensors) null for a sensor that answers by its zones; of one make the same, of models made alike too.
  [[nodiscard]] const std::vector<std::shared_ptr<const CalibratedSensor>>& sensors() const noexcept {
    return sensors_;
  }

 private:
  std::vector<std::shared_ptr<const CalibratedSensor>> sensors_;
  std::unique_ptr<PowerModel> power_;
};

}  // namespace pirsim::sim
