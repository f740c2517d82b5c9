// Rays that go on mirrored at a glossy surface.
#pragma once

#include <span>

#include "rt/room.hpp"
#include "schema/study_in_force.hpp"

namespace pirsim::sim {

/// Adds to every zone the mirrored continuation of those of its rays (at rated range) that first meet a glossy mesh.
/// Its range is what is left of the way at which a signal weakened by the coefficient still counts: power falls with
/// the square of the way, so sqrt(coefficient) of the rated range, less the way to the mesh. One reflection a ray.
void add_reflections(RayBundle& bundle, const rt::Room& room, std::span<const TriMesh> meshes,
                     std::span<const ReflectionSpec> reflections);

}  // namespace pirsim::sim
