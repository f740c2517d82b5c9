// A coverage study as plain data: which moving target stands where for how long, and how sensors are read.
#pragma once

#include <string>
#include <vector>

#include "pirsim/core/error.hpp"
#include "pirsim/geom/frame.hpp"
#include "pirsim/schema/script_spec.hpp"

namespace pirsim {

/// A steady turn about an axis of the frame that the turn before it made; the first one is in the world.
struct TurnSpec {
  Vec3 axis{0.0, 1.0, 0.0};
  double deg_per_s = 100.0;
};

/// Upright crosses of two round bars at right angles, turning on the spot. Ref: [Stefansson2021] section 3.2.
struct XShapesSpec {
  std::vector<double> heights_m{1.0, 0.25};  ///< of the crosses' middles over the floor
  double bar_length_m = 0.40;                ///< from tip to tip, caps included
  double bar_width_m = 0.07;                 ///< diameter
  double temperature_c = 33.5;               ///< for the analog response (`assumed`: as skin; 24 to 36.9 tried)
  std::vector<TurnSpec> turns{{{0.0, 1.0, 0.0}, 100.0}, {{0.0, 0.0, 1.0}, 100.0}};
};

struct CoverageSpec {
  std::string name;
  SensingSpec sensing;
  double spacing_m = 0.03;           ///< of the squares
  double duration_s = 60.0;          ///< in every square; a whole number of windows
  std::vector<std::string> without;  ///< things taken out of the room: meshes of this name, or of this first word
  std::vector<Where> without_where;  ///< (n of `without`) for messages
  XShapesSpec target;
};

}  // namespace pirsim
