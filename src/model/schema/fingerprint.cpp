#include "model/schema/fingerprint.hpp"

#include "model/geom/shapes.hpp"

namespace pirsim {

void Fingerprint::add(std::string_view text) {
  add(text.size());
  digest_.add(text);
}

void Fingerprint::add(const Frame& frame) {
  const auto& [rotation, origin] = frame;
  for (int i = 0; i < 4; ++i) add(rotation[i]);
  add(origin);
}

void Fingerprint::add(const FloorArea& floor) { add_each(floor.height_m(), floor.loops()); }

void Fingerprint::add(const MeshSolid& solid) { add(solid.surface->mesh()); }

}  // namespace pirsim
