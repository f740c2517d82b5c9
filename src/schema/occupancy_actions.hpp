// People who are where data say, as people of a script.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// Of places or positions; nobody of counts. begin_s: of the run, in the seconds of the data; what ended before it is
/// left out. tick_s: of the run. Seats are looked for when a Model is compiled.
[[nodiscard]] std::vector<PersonSpec> scripted_people(const OccupancySpec& occupancy, const SceneSpec& scene,
                                                      double begin_s, double tick_s, std::uint64_t seed);

}  // namespace pirsim
