// A sensor's rays as they run at one moment, for pictures and exports.
#pragma once

#include <cstddef>
#include <vector>

#include "pirsim/state.hpp"

namespace pirsim::sim {

struct BeamSegment {
  Vec3 from{0.0};
  Vec3 to{0.0};  ///< where the ray ends: at a person, at the room, or at its rated range
  bool sees_person = false;
};

/// One segment a ray of the sensor (index into scene().sensors), people as they stand in `state`.
[[nodiscard]] std::vector<BeamSegment> beams_of(const Model& model, const State& state, std::size_t sensor);

}  // namespace pirsim::sim
