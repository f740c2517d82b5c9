// Thresholds from what data sheets promise: a target passing at the rated distance.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pirsim/sensor.hpp"

namespace pirsim::pir {

// The data sheets' test of detection: a warm plate passes a facet's zones.

/// An upright plate that faces the sensor and moves sideways through the middle of the facet's first zone (and so
/// through the one beside it). Defaults quoted from Panasonic's data sheet but for the background (`assumed`; 0 to 30).
struct TargetPass {
  double distance_m = 12.0;
  double speed_m_s = 1.0;
  double temperature_difference_k = 4.0;
  double background_c = 20.0;
  double width_m = 0.25;
  double height_m = 0.7;
};

/// One facet as a passing plate sees it.
class PassedFacet {
 public:
  /// rays_per_zone as in zone_quadrature(): at least some hundred should hit the plate.
  PassedFacet(const SensorModelSpec& model, std::size_t cluster, int rays_per_zone = 2048);

  /// Power that the facet with an aperture of `aperture_m2` brings to the element beyond the background's, watts, one
  /// value a tick: from before the plate touches a zone until it has left all (zeros at both ends).
  [[nodiscard]] std::vector<double> power(const TargetPass& pass, double aperture_m2, double tick_s) const;

 private:
  struct Spot {
    Vec2 tangent{0.0};       ///< from the facet's axis, x the way of the plate, y up
    double weight_sr = 0.0;  ///< signed by the zone's polarity
  };
  std::vector<Spot> spots_;      ///< in the order of x
  double middle_tangent_ = 0.0;  ///< y of the first zone's middle
};

/// The power that a target gives a cluster in a single pass.
[[nodiscard]] std::vector<double> target_power(const SensorModelSpec& model, std::size_t cluster,
                                               const TargetPass& pass, double aperture_m2, double tick_s,
                                               int rays_per_zone = 2048);

/// The facet of a lens step that looks most nearly ahead; the one that rated distances are taken to hold for.
[[nodiscard]] std::size_t reference_facet(const SensorModelSpec& model, int lens_step);

struct Calibration {
  double volts_per_watt = 0.0;       ///< `fitted`, unless the sensor's data give it
  std::vector<double> apertures_m2;  ///< (n_clusters); the first lens step's is data, the others' are `fitted`
};

/// Such that the data sheet's target is just detected at the rated distance of each lens step, by the step's reference
/// facet. Independent of a study's tick. Throws Error(input) if the target brings no power there.
[[nodiscard]] Calibration calibrate(const SensorModelSpec& model);

/// How far a course of power (one value a tick, at rest before and after) drives the signal towards the comparator's
/// thresholds, in units of them: 1 is just detected. Without noise and saturation.
[[nodiscard]] double excursion(const DetectorSpec& spec, double volts_per_watt, std::span<const double> power_w,
                               double tick_s);
/// How far a target that passes one facet drives the signal, in units of the thresholds.
[[nodiscard]] double excursion(const SensorModelSpec& model, const Calibration& calibration, std::size_t cluster,
                               const TargetPass& pass);

/// The greatest distance from 0.1 to 100 m at which one facet detects a target, within 0.1 %; 0 if there is none.
/// pass.distance_m is ignored.
[[nodiscard]] double detection_range(const SensorModelSpec& model, const Calibration& calibration, std::size_t cluster,
                                     TargetPass pass);

}  // namespace pirsim::pir
