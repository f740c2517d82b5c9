// A sensor as plain data: the zones that its lens throws into the room, and the electronics behind it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim {

// How a sensor turns what stands in its zones into motion, as plain data.

enum class Response {
  zones,   ///< hard zones: a change in which of them see a person is motion (the paper's)
  analog,  ///< physical: radiant power, pyroelectric element, amplifier, comparator (docs/physics/analog.md)
  beam     ///< a light barrier or a range finder: on while anything is nearer than a share of the idle distance
};

/// What the physical response needs of a lens beyond its zones.
struct OpticsSpec {
  /// Standard deviation of the Gaussian that softens a zone's edges, degrees (`assumed`; 0 to 1.1, half a gap, tried).
  double blur_deg = 0.5;
  /// Of a facet of the first lens step, mm^2 (`assumed`; its size cancels out when the threshold is calibrated). The
  /// other steps' follow from their rated distances (`fitted`).
  double aperture_mm2 = 20.0;
};

// A sensor's element, amplifier and comparator as plain data. Defaults stand for the EKMC family.

/// H(s) = K s tau_th / ((1 + s tau_th)(1 + s tau_el)): docs/physics/analog.md.
struct ElementSpec {
  double thermal_s = 0.15;    ///< how fast the element's heat leaks away (`assumed`; 0.05 to 1)
  double electrical_s = 1.0;  ///< how fast its charge does (`assumed`; 0.3 to 3)
};

struct AmplifierSpec {
  double low_hz = 0.3;   ///< where the lower edge has lost 3 dB (published reference designs: 0.3 and 0.7)
  double high_hz = 6.5;  ///< where the upper edge has lost 3 dB (the same: 6.5 and 10.6)
  int order = 2;         ///< equal one-pole sections an edge, 1 to 3 (the same: two amplifier stages)
  /// Volts at the output per watt that reaches the element, K and the amplifier's gain in one. Without it the response
  /// is calibrated on the rated distance of the first lens step.
  std::optional<double> volts_per_watt;
  double noise_v_pp = 0.080;  ///< peak to peak at the output: 6.6 standard deviations (quoted: 80 mV; up to 150 mV)
  double offset_v = 1.1;      ///< of the output at rest (quoted)
  double lowest_v = 0.2;      ///< where the output saturates (quoted)
  double highest_v = 1.9;     ///< the same
};

/// Which pulses are counted.
enum class PulseSigns {
  any,         ///< each time the signal leaves the window
  alternating  ///< only if on the other side than the last
};

struct ComparatorSpec {
  double positive_v = 0.45;     ///< above the offset (`assumed`; 0.2 to 0.6)
  double negative_v = 0.45;     ///< below the offset, as a positive number (`assumed`; 0.2 to 0.6)
  int pulse_count = 1;          ///< pulses that switch the output on
  double pulse_window_s = 0.0;  ///< within which they must begin; of no meaning for one pulse
  PulseSigns pulse_signs = PulseSigns::any;
};

/// What a device makes of its comparator's output: when it says "motion", and for how long. All 0: it follows the
/// comparator. Derivation of the four ways in which devices report: docs/formats/sensor.md.
struct ReportSpec {
  double hold_s = 0.0;  ///< it stays on after the last motion that counts; 0: not at all
  double again_s =
      0.0;  ///< motion counts again this long after it last counted; 0: always, so that the hold re-triggers
  double blind_s = 0.0;  ///< after it went off nothing counts
};

struct DetectorSpec {
  ElementSpec element;
  AmplifierSpec amplifier;
  ComparatorSpec comparator;
  ReportSpec report;
};

// A sensor's optics as plain data: which zones its lens throws into the room.

/// One detection zone: the image of one pyroelectric element through one lens facet, drawn on the plane
/// `plane_m` ahead of the sensor (x to the right, y up, metres). The direction of a point is
/// normalise(x, y, -plane_m) in the sensor's frame.
struct ZoneSpec {
  std::array<Vec2, 4> corners{};  ///< in order round the zone, convex
  int polarity = 1;               ///< +1 or -1, sign of the element (`assumed`: checkerboard on the quad)
};

/// The zones of one facet: what the paper calls a cluster of beams.
struct ClusterSpec {
  Vec2 centre{0.0};      ///< on the plane, metres
  double range_m = 0.0;  ///< rated detection distance of the facet's lens step
  int lens_step = 1;     ///< 1 for the farthest-reaching row
  std::vector<ZoneSpec> zones;
};

/// What the maker says is just detected at the rated distance of a lens step's facets: an upright plate that crosses
/// their zones. Defaults quoted from Panasonic's data sheet of the EKMC.
struct RatedTargetSpec {
  int lens_step = 1;
  double width_m = 0.25;
  double height_m = 0.7;
  double speed_m_s = 1.0;
  double contrast_k = 4.0;  ///< warmer than what is behind it
  int zones = 2;            ///< that it crosses, 1 or 2
};

/// How sensitive sensors of one make are where they hang, relative to what the rated distances tell: log-normal. Mount,
/// trimmer, age and what stands before it are the installation's, which all sensors of a room share; the rest is the
/// unit's own.
struct SensitivitySpec {
  double median = 1.0;
  double installation_sd = 0.0;  ///< of the logarithm, over rooms
  double sd = 0.0;               ///< of the logarithm, over units of a room
};

/// A thermopile array: a field of pixels, each of which tells the temperature of a black body of the radiance that it
/// sees (docs/physics/arrays.md).
struct ArraySpec {
  int rows = 8, columns = 8;
  double wide_deg = 60.0, tall_deg = 60.0;  ///< field of view, from the outer edge of the first pixel to the last one's
  std::optional<double>
      pixel_deg;         ///< full width at half of a pixel's Gaussian response; none: as far as its neighbour
  double rate_hz = 1.0;  ///< frames a second; where there are two sub-pages, sub-pages
  int sub_pages = 1;     ///< 2: each frame renews every other pixel, as the squares of a chess board
  double netd_k = 0.0;   ///< noise of one pixel at 1 frame/s, rms; it grows as the root of the rate
  double centre_noise = 1.0, corner_noise = 1.0;         ///< times that, in the middle and in a corner
  double common_k = 0.0;                                 ///< the same, of what all pixels of one frame have in common
  double offset_k = 0.0, column_k = 0.0, fixed_k = 0.0;  ///< rms over units: of all, of a column, of a pixel
  int dead_pixels = 0;                                   ///< of a unit; they read nothing
  double step_k = 0.0;                                   ///< readings are multiples of it; 0: any number
  double from_um = 5.0, to_um = 14.0;                    ///< wavelengths that the window lets through
  int rays_per_pixel = 24;
};

struct SensorModelSpec {
  std::string id;  ///< as scenes name it, "EKMC1604111"
  std::string description;
  std::vector<std::string> names;  ///< of products that carry it, "Everything Presence One"
  double plane_m = 1.0;            ///< distance of the plane on which the zones are drawn
  std::vector<ClusterSpec> clusters;
  std::vector<RatedTargetSpec> targets;  ///< of lens steps whose target isn't the default
  SensitivitySpec sensitivity;
  Response response = Response::analog;
  OpticsSpec optics;
  DetectorSpec detector;           ///< electronics, for the physical response
  double idle_share = 1.0;         ///< of a beam: what is nearer than this share of the distance to the room breaks it
  std::optional<ArraySpec> array;  ///< it is a thermopile array and nothing else; SceneSpec::arrays name it
};

}  // namespace pirsim
