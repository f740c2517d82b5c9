// People as the solids that sensors see, and the rays that end at them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "body/poser.hpp"
#include "pirsim/shapes.hpp"
#include "pirsim/state.hpp"
#include "sim/actor.hpp"

namespace pirsim::sim {

/// Appends the thirteen posed solids of a posture, or of a person if present, in the order of body::Part.
void append_solids(const body::Humanoid& humanoid, const body::Posture& posture, std::vector<PosedShape>& solids);
void append_solids(const Actor& actor, std::vector<PosedShape>& solids);

/// Keeps what doesn't change from one posture to the next.
class Mannequin {
 public:
  /// (n_parts) as append_solids() gives them; valid until the next call. humanoid: outlives this.
  [[nodiscard]] std::span<const PosedShape> pose(const body::Humanoid& humanoid, const body::Outline& outline) {
    if (!poser_ || &poser_->humanoid() != &humanoid) poser_.emplace(humanoid);
    const body::Posture& posture = poser_->posture(outline);
    for (std::size_t part = 0; part < body::n_parts; ++part) {
      if ((poser_->renewed() >> part & 1U) != 0) solids_[part] = place(humanoid.solids()[part], posture[part]);
    }
    return solids_;
  }

 private:
  std::optional<body::Poser> poser_;
  std::vector<PosedShape> solids_ = std::vector<PosedShape>(body::n_parts);
};

struct BeamSegment {
  Vec3 from{0.0};
  Vec3 to{0.0};  ///< where the ray ends: at a person, at the room, or at its rated range
  bool sees_person = false;
};

/// One segment a ray of the sensor (index into scene().sensors), people as they stand in `state`.
[[nodiscard]] std::vector<BeamSegment> beams_of(const Model& model, const State& state, std::size_t sensor);

}  // namespace pirsim::sim
