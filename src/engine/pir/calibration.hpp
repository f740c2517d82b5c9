// Thresholds from what data sheets promise: a target passing at the rated distance.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "engine/pir/analog_circuit.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

// The data sheets' test of detection: a warm plate crosses a facet's zones.

/// A target that faces the sensor and moves sideways.
struct TargetPass {
  RatedTargetSpec target;
  double distance_m = 12.0;
  double background_c = 20.0;  ///< `assumed`; 0 to 30
};

/// One way of a plate through a facet: through the middle of a zone and of its neighbour, along a row or a column of
/// the lens's drawing. The plate stands across its way.
class Crossing {
 public:
  struct Spot {
    Vec2 tangent{0.0};       ///< from the middle of the way, x along it
    double weight_sr = 0.0;  ///< signed by the zone's polarity
  };
  explicit Crossing(std::vector<Spot> spots);

  /// Power that the facet with an aperture of `aperture_m2` brings to the element beyond the background's, watts, one
  /// value a tick: from before the plate touches a zone until it has left all (zeros at both ends).
  [[nodiscard]] std::vector<double> power(const TargetPass& pass, double aperture_m2, double tick_s) const;

 private:
  std::vector<Spot> spots_;  ///< in the order of x
};

/// The ways of a plate past the sensor through so many zones of a facet, there and back: along rows or columns of the
/// drawing, whichever lies more nearly square to the direction in which the facet is off the lens's axis, so that the
/// plate keeps its distance; both if they are equal. One zone: of it alone, whichever. Two: there may be none, as in a
/// facet of one zone; then a zone is crossed for itself. All this turns and is mirrored with the drawing.
/// rays_per_zone: a multiple of 8; at least some hundred should hit the plate.
[[nodiscard]] std::vector<Crossing> crossings(const SensorModelSpec& model, std::size_t cluster, int zones,
                                              int rays_per_zone = 2048);

/// What a lens step's rated distance holds for (`assumed`): the facets nearest to straight ahead, several if they are
/// equally near.
[[nodiscard]] std::vector<std::size_t> reference_facets(const SensorModelSpec& model, int lens_step);

/// A lens step as its reference facets see targets: the mean over them and over the ways through them.
class RatedStep {
 public:
  RatedStep(const SensorModelSpec& model, int lens_step, int rays_per_zone = 2048);

  /// The maker's target at the maker's distance.
  [[nodiscard]] const TargetPass& rated() const noexcept { return rated_; }
  /// How far a target drives the signal towards the comparator's thresholds, in units of them (1 is just detected), for
  /// each square metre of aperture and volt per watt. Without noise and saturation.
  [[nodiscard]] double excursion(const TargetPass& pass) const;
  /// The greatest distance from 0.1 to 100 m at which a target is detected, within 0.1 %; 0 if there is none.
  /// pass.distance_m is ignored. gain: aperture times volts per watt.
  [[nodiscard]] double detection_range(double gain_m2_v_per_w, TargetPass pass) const;

 private:
  ComparatorSpec comparator_;
  AnalogFilter filter_;
  std::vector<Crossing> ways_;
  TargetPass rated_;
};

/// The same electronics, silent.
[[nodiscard]] DetectorSpec without_noise(DetectorSpec spec);

struct Calibration {
  double volts_per_watt = 0.0;         ///< `fitted`, unless the sensor's data give it
  std::map<int, double> apertures_m2;  ///< by lens step; the first one's is data, the others' are `fitted`
};

/// Such that each lens step just detects its rated target at its rated distance. Independent of a study's tick. Throws
/// Error(input) if a target brings no power there.
[[nodiscard]] Calibration calibrate(const SensorModelSpec& model);

}  // namespace pirsim::pir
