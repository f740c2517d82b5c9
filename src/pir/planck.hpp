// How much a black body radiates in the band that a PIR sensor's window lets through.
#pragma once

namespace pirsim::pir {

/// Wavelengths that the lens and the element's filter let through (sensor makers' usual 5 to 14 um).
struct Band {
  double from_um = 5.0;
  double to_um = 14.0;
};

[[nodiscard]] constexpr double kelvin(double celsius) noexcept { return celsius + 273.15; }

/// Of a black body, W m^-2 sr^-1; monotonic in the temperature, 0 at 0 K. Ref: [Planck1914], constants [CODATA2018].
[[nodiscard]] double band_radiance(double temperature_k, const Band& band = {});

}  // namespace pirsim::pir
