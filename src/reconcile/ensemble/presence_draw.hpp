// What counts of people don't tell: when exactly somebody comes or goes, and which seats they are used to. Private to
// reconcile.
#pragma once

#include "pirsim/occupancy.hpp"
#include "pirsim/random.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim::reconcile {

/// Counts whose changes come up to within_s earlier or later, each by itself; what is between two of them is moved in
/// proportion. The first and the last reading stay, and so does the order.
[[nodiscard]] CountsSpec with_other_times(const CountsSpec& counts, double within_s, Stream& stream);

/// Draws both into an occupancy, if it has counts. Seats: people who share a room for long have their own, so that some
/// of those that aren't needed are nobody's.
void draw_presence(const SceneSpec& scene, const NuisanceSpec& nuisance, Stream& stream, OccupancySpec& occupancy);

}  // namespace pirsim::reconcile
