// Fields of sensors: optics, zones, electronics (schema/fields.hpp).
#pragma once

#include <tuple>

#include "pirsim/sensor.hpp"
#include "schema/field.hpp"
#include "schema/fields/accepted.hpp"
#include "schema/words.hpp"

namespace pirsim {

template <>
struct Fields<OpticsSpec> {
  using S = OpticsSpec;
  static constexpr const char* name = "Optics";
  static constexpr const char* about = "What the physical response needs of a lens beyond its zones.";
  static constexpr std::tuple all{
      FIELD(blur_deg, NumberRange{.min = 0.0, .max = 10.0},
            "standard deviation of the Gaussian that softens a zone's edges"),
      FIELD(aperture_mm2, NumberRange{.above = 0.0, .max = 1000.0}, "area of a facet of the first lens step")};
};
template <>
struct Fields<ElementSpec> {
  using S = ElementSpec;
  static constexpr const char* name = "Element";
  static constexpr const char* about = "The pyroelectric element's time constants.";
  static constexpr std::tuple all{FIELD(thermal_s, accepted::time_constant_s, "thermal time constant"),
                                  FIELD(electrical_s, accepted::time_constant_s, "electrical time constant")};
};
template <>
struct Fields<AmplifierSpec> {
  using S = AmplifierSpec;
  static constexpr const char* name = "Amplifier";
  static constexpr const char* about = "A band-pass with noise.";
  static constexpr std::tuple all{
      FIELD(low_hz, accepted::corner_hz, "lower corner frequency (-3 dB)"),
      FIELD(high_hz, accepted::corner_hz, "upper corner frequency (-3 dB)"),
      FIELD(order, IntegerRange{.min = 1, .max = 3}, "one-pole sections per edge, 1 to 3"),
      FIELD(volts_per_watt, NumberRange{.above = 0.0},
            "total gain from the power on the element to the output; by default calibrated on the rated distance of "
            "the first lens step"),
      FIELD(noise_v_pp, accepted::output_v, "noise at the output, peak to peak (6.6 standard deviations); 0: none"),
      FIELD(offset_v, accepted::output_v, "output at rest"),
      FIELD(lowest_v, accepted::output_v, "where the output saturates at its lower end"),
      FIELD(highest_v, accepted::output_v, "where the output saturates at its upper end")};
};
template <>
struct Fields<ComparatorSpec> {
  using S = ComparatorSpec;
  static constexpr const char* name = "Comparator";
  static constexpr const char* about = "When the amplified signal switches the output on and off.";
  static constexpr std::tuple all{
      FIELD(positive_v, accepted::threshold_v, "threshold above the offset"),
      FIELD(negative_v, accepted::threshold_v, "threshold below the offset, as a positive number"),
      FIELD(pulse_count, IntegerRange{.min = 1, .max = 8}, "number of pulses that switches the output on, 1 to 8"),
      FIELD(pulse_window_s, accepted::held_s,
            "time within which the pulses must begin; required for more than one pulse"),
      FIELD(pulse_signs, "`alternating`: a pulse counts only on the opposite side to the last")};
};
template <>
struct Fields<ReportSpec> {
  using S = ReportSpec;
  static constexpr const char* name = "Report";
  static constexpr const char* about = "When a device says that there is motion, and for how long.";
  static constexpr std::tuple all{
      FIELD(hold_s, accepted::held_s, "how long it goes on after the last motion that counts"),
      FIELD(again_s, accepted::held_s,
            "how long after motion that counted other motion doesn't; 0: the hold re-triggers"),
      FIELD(blind_s, accepted::held_s, "how long motion is ignored after it has ended")};
};
template <>
struct Fields<DetectorSpec> {
  using S = DetectorSpec;
  static constexpr const char* name = "Detector";
  static constexpr const char* about = "A sensor's electronics, for the physical response.";
  static constexpr std::tuple all{FIELD(element), FIELD(amplifier), FIELD(comparator), FIELD(report)};
};
template <>
struct Fields<ZoneSpec> {
  using S = ZoneSpec;
  static constexpr const char* name = "Zone";
  static constexpr const char* about =
      "A detection zone, drawn on the plane `plane_m` ahead of the sensor: four corners (x right, y up), metres.";
  static constexpr std::tuple all{FIELD(corners, "in order round the zone, convex"),
                                  FIELD(polarity, "+1 or -1, the sign of the element")};
};
template <>
struct Fields<ClusterSpec> {
  using S = ClusterSpec;
  static constexpr const char* name = "Cluster";
  static constexpr const char* about = "The zones of one facet of the lens.";
  static constexpr std::tuple all{
      FIELD(centre, "on the plane"),
      FIELD(range_m, NumberRange{.above = 0.0, .max = 1000.0}, "rated detection distance"),
      FIELD(lens_step, IntegerRange{.min = 1, .max = 99}, "row of the lens: 1 reaches farthest"), FIELD(zones)};
};
template <>
struct Fields<RatedTargetSpec> {
  using S = RatedTargetSpec;
  static constexpr const char* name = "RatedTarget";
  static constexpr const char* about = "The plate that facets of one lens step just detect at their rated distance.";
  static constexpr std::tuple all{
      FIELD(lens_step, IntegerRange{.min = 1, .max = 99}, "of which facets"),
      FIELD(width_m, NumberRange{.above = 0.0, .max = 10.0}, "of the plate"),
      FIELD(height_m, NumberRange{.above = 0.0, .max = 10.0}, "of the plate"),
      FIELD(speed_m_s, NumberRange{.above = 0.0, .max = 20.0}, "sideways"),
      FIELD(contrast_k, NumberRange{.above = 0.0, .max = 40.0}, "by how much it is warmer than what is behind it"),
      FIELD(zones, IntegerRange{.min = 1, .max = 2}, "that it crosses")};
};
template <>
struct Fields<SensitivitySpec> {
  using S = SensitivitySpec;
  static constexpr const char* name = "Sensitivity";
  static constexpr const char* about =
      "How sensitive units of this make are, relative to what the rated distances tell; log-normal.";
  static constexpr std::tuple all{
      FIELD(mean, NumberRange{.above = 0.0, .max = 100.0}, "over units"),
      FIELD(sd, NumberRange{.min = 0.0, .max = 2.0}, "standard deviation of the logarithm over units")};
};
template <>
struct Fields<SensorModelSpec> {
  using S = SensorModelSpec;
  static constexpr const char* name = "SensorModel";
  static constexpr const char* about = "A sensor's lens and electronics. `pirsim.sensor_model()` has the shipped ones.";
  static constexpr std::tuple all{
      FIELD(id, "as scenes name it"), LABEL(description, "free text"), LABEL(names, "of products that carry it"),
      // less leaves no digits to directions
      FIELD(plane_m, NumberRange{.min = 1e-3, .max = 1000.0}, "distance of the plane on which the zones are drawn"),
      FIELD(clusters), FIELD(targets, "of lens steps whose rated target isn't the usual one"),
      FIELD(sensitivity, "of units, relative to what is guaranteed"),
      FIELD(response, "`zones`: a change of activity is motion; `analog`: the physical response"),
      FIELD(optics, "for the physical response"), FIELD(detector, "electronics, for the physical response")};
};

}  // namespace pirsim
