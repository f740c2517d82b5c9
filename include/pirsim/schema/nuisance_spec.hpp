// What nobody knows exactly about a real room and its people: drawn anew for every simulated dataset of a
// reconciliation, never fitted.
#pragma once

namespace pirsim {

/// Half-widths of uniform distributions round the value that scene or script gives. Shared by a whole dataset, since it
/// is one real room with one real person: sensors and bodies are drawn once, seats once each.
struct NuisanceSpec {
  double seat_position_m = 0.04;  ///< of each horizontal coordinate of a seat; assumed (tried 0-0.08)
  double sensor_yaw_deg = 1.5;    ///< of each sensor; assumed (tried 0-3)
  double sensor_tilt_deg = 1.0;   ///< assumed (tried 0-2)
  double body_size = 0.03;        ///< of stature, relative; mass follows with its cube; assumed (tried 0-0.06)
  double arm_amplitude = 0.10;    ///< of desk work, relative; assumed (tried 0-0.2)
  bool operator==(const NuisanceSpec&) const = default;
};

}  // namespace pirsim
