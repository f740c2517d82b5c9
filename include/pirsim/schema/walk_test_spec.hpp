// A virtual walk test as plain data: which movements are tried at every point, and what is required of the sensors.
#pragma once

#include <string>

#include "pirsim/schema/script_spec.hpp"

namespace pirsim {

/// In `within_s` seconds of a movement, motion has to be reported in at least `probability` of the tries.
struct WalkRequirement {
  double within_s = 2.0;
  double probability = 0.9;
  int directions = 8;  ///< tries: evenly round the circle
};

struct WalkTestSpec {
  std::string name;
  SensingSpec sensing;
  double spacing_m = 0.5;
  PersonSpec person;
  /// A person crosses the point, starting to walk half of `path_m` before it.
  WalkRequirement major;
  double path_m = 2.0;
  /// A person who sits over the point moves both forearms to and fro.
  WalkRequirement minor{10.0, 0.9, 8};
  double seat_height_m = 0.531;  ///< of the pelvis
  double desk_height_m = 0.74;   ///< on which the forearms move; the desk itself hides nothing
  double arm_amplitude_m = 0.1;
  double arm_period_s = 3.0;
};

}  // namespace pirsim
