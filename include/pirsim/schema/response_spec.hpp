// How a sensor turns what stands in its zones into motion, as plain data.
#pragma once

namespace pirsim {

enum class Response {
  zones,  ///< hard zones: a change in which of them see a person is motion (the paper's)
  analog  ///< physical: radiant power, pyroelectric element, amplifier, comparator (docs/physics/analog.md)
};

/// What the physical response needs of a lens beyond its zones.
struct OpticsSpec {
  /// Standard deviation of the Gaussian that softens a zone's edges, degrees (`assumed`; 0 to 1.1, half a gap, tried).
  double blur_deg = 0.5;
  /// Of a facet of the first lens step, mm^2 (`assumed`; its size cancels out when the threshold is calibrated). The
  /// other steps' follow from their rated distances (`fitted`).
  double aperture_mm2 = 20.0;
};

}  // namespace pirsim
