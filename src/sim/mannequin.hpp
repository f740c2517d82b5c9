// A person's solids, posture after posture.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "body/poser.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::sim {

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

}  // namespace pirsim::sim
