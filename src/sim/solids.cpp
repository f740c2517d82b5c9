#include "sim/solids.hpp"

namespace pirsim::sim {

void append_solids(const body::Humanoid& humanoid, const body::Posture& posture, std::vector<PosedShape>& solids) {
  for (std::size_t i = 0; i < body::n_parts; ++i) solids.push_back(place(humanoid.solids()[i], posture[i]));
}

void append_solids(const Actor& actor, std::vector<PosedShape>& solids) {
  if (actor.present()) append_solids(actor.person().humanoid, actor.motion().posture(), solids);
}

}  // namespace pirsim::sim
