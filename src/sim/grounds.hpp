// What is the same for all who rehearse among the same solids.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "body/footprint.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::sim {

class Grounds {
 public:
  explicit Grounds(const SceneSpec& scene) : scene_(scene) {}

  std::map<std::pair<double, std::string>, bool> open_doors;  ///< does one lead to the floor? By clearance and name
  std::map<std::array<double, 3>, bool> open_places;          ///< can one get there? By clearance and place

  struct Near {
    double away_m = std::numeric_limits<double>::infinity();
    std::uint32_t mesh = 0;
  };
  /// The solid thing that is nearest to the place, of those that walkers go round.
  [[nodiscard]] Near nearest_solid(const Vec2& place) {
    const double floor_y = scene_.floor.height_m();
    if (!solids_) solids_ = body::footprints(scene_.meshes, floor_y + body::solid_from_m, floor_y + body::solid_to_m);
    Near nearest;
    for (const body::Footprint& solid : *solids_) {
      if (body::distance_bound(place, place, solid) >= nearest.away_m) continue;
      if (const double away_m = body::distance(place, solid); away_m < nearest.away_m) nearest = {away_m, solid.mesh};
    }
    return nearest;
  }

 private:
  const SceneSpec& scene_;
  std::optional<std::vector<body::Footprint>> solids_;
};

}  // namespace pirsim::sim
