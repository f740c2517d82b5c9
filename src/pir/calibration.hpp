// What a data sheet's rated distance says about the amplifier's gain and the facets' apertures.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pir/target_pass.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

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
/// The same for a target that passes one facet.
[[nodiscard]] double excursion(const SensorModelSpec& model, const Calibration& calibration, std::size_t cluster,
                               const TargetPass& pass);

/// The greatest distance from 0.1 to 100 m at which one facet detects a target, within 0.1 %; 0 if there is none.
/// pass.distance_m is ignored.
[[nodiscard]] double detection_range(const SensorModelSpec& model, const Calibration& calibration, std::size_t cluster,
                                     TargetPass pass);

}  // namespace pirsim::pir
