// What each sensor can see of a standing and a seated person: the report of `pirsim check`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pirsim/model.hpp"

namespace pirsim::studies {

struct SensorSight {
  std::string sensor;
  std::size_t rays = 0;
  std::size_t rays_cut = 0;        ///< rays that end at the room before their rated range
  double longest_m = 0.0;          ///< of the rays as cut
  std::string outside;             ///< see hangs_outside()
  std::size_t places = 0;          ///< places of the floor where a zone sees a standing person
  std::vector<std::string> seats;  ///< seats where a zone sees a sitter at rest
  [[nodiscard]] bool sees_nothing() const noexcept { return places == 0 && seats.empty(); }
};

struct SightReport {
  double spacing_m = 0.25;  ///< of the places tried
  std::size_t places = 0;   ///< walkable places of the floor area
  std::size_t places_seen_by_any = 0;
  std::vector<SensorSight> sensors;  ///< in the scene's order
};

/// Stands a person (the script's first, or the default one) on every place of a grid and on every seat.
[[nodiscard]] SightReport look_around(const Model& model);

/// "it hangs outside of the room, 70.0 m from the floor's edge", or empty: on a wall is as good as inside.
[[nodiscard]] std::string hangs_outside(const FloorArea& floor, const Vec3& place);

/// Of sensors that see nothing, a warning for each reason; none where it follows from the scene's unit.
[[nodiscard]] std::vector<Issue> warnings(const SightReport& report, const SceneSpec& scene);

}  // namespace pirsim::studies
