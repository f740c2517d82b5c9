// A better set of sensors, looked for along mounting lines.
#pragma once

#include <functional>
#include <vector>

#include "pirsim/look.hpp"
#include "studies/best_cover.hpp"

namespace pirsim::studies {

/// Called after each set that is tried; by seats, after each place.
using Tried = std::function<void()>;

/// By area: seen area, by NLopt's DIRECT-L and then SBPLX. By seats: judges single places, evenly along the lines and
/// those of even spacing, and covers seats, then seats that are surely noticed, then area,
/// with the best of them (studies/best_cover.hpp). By false-offs: the same places, in sight of the light's people
/// (studies/light_search.hpp). Starts from even
/// spacing. Throws as score() does. Sets at_work and light of neither.
[[nodiscard]] PlacementSearch search_placement(
    const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search, unsigned threads = 0,
    const Tried& tried = [] {});

/// Sensors at these shares, in [0, 1], of the lines' joint length.
[[nodiscard]] SensorSetSpec sensors_along(const PlacementSearchSpec& search, const std::vector<double>& shares,
                                          std::string id);

/// What sensors at these shares notice, each by itself: all seats, then the same seats if they are surely noticed, then
/// all squares of the floor. A seat is worth more than all that comes after.
[[nodiscard]] Cover cover_of(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
                             const std::vector<double>& shares, unsigned threads, const Tried& tried);

}  // namespace pirsim::studies
