// How much a black body radiates in the band that a PIR sensor's window lets through.
#pragma once

#include <span>
#include <vector>

#include "engine/study/study_in_force.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

/// Wavelengths that the lens and the element's filter let through (sensor makers' usual 5 to 14 um).
struct Band {
  double from_um = 5.0;
  double to_um = 14.0;
  bool operator==(const Band&) const = default;
};

[[nodiscard]] constexpr double kelvin(double celsius) noexcept { return celsius + 273.15; }

/// Of a black body, W m^-2 sr^-1; monotonic in the temperature, 0 at 0 K. Ref: [Planck1914], constants [CODATA2018].
[[nodiscard]] double band_radiance(double temperature_k, const Band& band = {});

/// Which temperature has a black body of a band radiance, degrees Celsius: the inverse, to 1e-4 K. Less than -80 or
/// more than 350 is told as these.
class Thermometer {
 public:
  explicit Thermometer(const Band& band);
  [[nodiscard]] double celsius(double radiance) const noexcept;

 private:
  std::vector<double> log_radiances_;  ///< at evenly spaced temperatures
};

// A sensor's lens as rays: for hard zones, and with weights for radiant power.

/// Unit directions in the sensor's frame of the points that stand for one zone: its centre (one), corners and centre
/// (five), or a grid that spans the zone (nine: 3 x 3, sixteen: 4 x 4). Ref: [Stefansson2021] Figure 2b.
[[nodiscard]] std::vector<Vec3> zone_directions(const SensorModelSpec& model, const ZoneSpec& zone, RaysPerZone rays);

/// The zone with every edge moved outward by `angle` (radians, as the sensor sees it; negative: inward, at most until
/// an edge passes through the centre).
[[nodiscard]] ZoneSpec grown(const SensorModelSpec& model, const ZoneSpec& zone, double angle);

/// By how much the nested copies of a zone are grown that together stand for an edge blurred by a normal distribution:
/// its quantiles at (i + 1/2) / n, radians, 0 first. Hard edges have one copy.
[[nodiscard]] std::vector<double> edge_levels(double sigma_deg);

/// Appends a sensor's rays at their rated ranges: all clusters as they are, then all of them again for every other
/// level of growth.
void append(RayBundle& bundle, const SensorSpec& sensor, const SensorModelSpec& model, RaysPerZone rays,
            std::span<const double> levels = {});

// A zone with soft edges as a few rays with weights.

struct WeightedDirection {
  Vec3 direction{0.0};          ///< unit, in the sensor's frame
  double solid_angle_sr = 0.0;  ///< that it stands for
};

/// Of the zone's outline as drawn, steradian. Ref: [VanOosterom1983].
[[nodiscard]] double solid_angle_sr(const SensorModelSpec& model, const ZoneSpec& zone);

/// Point i of n of a rank-1 lattice of the golden ratio, in the unit square.
[[nodiscard]] Vec2 lattice_point(int i, int n);
/// For each zone, one after the other, `n` >= 1 directions spread evenly (a rank-1 lattice of the golden ratio) over
/// the zone as the lens' point spread blurs it: where the zone is half as sensitive they lie half as dense. Their
/// weights sum to the zone's solid angle.
[[nodiscard]] std::vector<WeightedDirection> zone_quadrature(const SensorModelSpec& model,
                                                             std::span<const ZoneSpec> zones, int n);
/// (n_zones) The same of `n` directions, a multiple of 8: a lattice of an eighth of them, turned and mirrored in all 8
/// ways. So it is the same whichever corner comes first.
[[nodiscard]] std::vector<std::vector<WeightedDirection>> symmetric_quadrature(const SensorModelSpec& model,
                                                                               std::span<const ZoneSpec> zones, int n);

// The rays of the physical response, each with what it is worth.

/// No rated distance cuts these rays; this far they reach where no room does, metres.
inline constexpr float out_of_sight_m = 1000.0F;

/// Of the first lens step's facets.
[[nodiscard]] double aperture_m2(const OpticsSpec& optics) noexcept;

struct PowerRays {
  RayBundle bundle;
  /// (n_rays) polarity x the first lens step's aperture x solid angle, m^2 sr: times a difference of radiance it is a
  /// power. What the facets of other steps bring is as many times more as their aperture is larger, which follows from
  /// the electronics (pir::calibrate) and isn't known here.
  std::vector<double> weights;
};

/// zone_quadrature() of every zone of a lens, in order: the same for all sensors of one make.
[[nodiscard]] std::vector<WeightedDirection> lens_quadrature(const SensorModelSpec& model, int rays_per_zone);
/// Appends a sensor's rays. quadrature: of its lens, as lens_quadrature() gives it.
void append(PowerRays& rays, const SensorSpec& sensor, const SensorModelSpec& model,
            std::span<const WeightedDirection> quadrature);
/// Appends a sensor without any.
void append_blind(PowerRays& rays);

/// Cuts off the rays through a side of each of these sensors' lenses, as many as the share says. bundle: of the scene's
/// sensors.
void blind(RayBundle& bundle, const SceneSpec& scene, const BlindFieldSpec& field);

}  // namespace pirsim::pir
