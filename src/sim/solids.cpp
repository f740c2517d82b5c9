#include "sim/solids.hpp"

#include "sim/run_state.hpp"

namespace pirsim::sim {

void append_solids(const body::Humanoid& humanoid, const body::Posture& posture, std::vector<PosedShape>& solids) {
  for (std::size_t i = 0; i < body::n_parts; ++i) solids.push_back(place(humanoid.solids()[i], posture[i]));
}

void append_solids(const Actor& actor, std::vector<PosedShape>& solids) {
  if (actor.present()) append_solids(actor.person().humanoid, actor.motion().posture(), solids);
}

std::vector<BeamSegment> beams_of(const Model& model, const State& state, std::size_t sensor) {
  const RayBundle& bundle = model.rays();
  const std::vector<float> range = model.compiled().array().range(state.run_state().crowd.doors().steps());
  const auto first_ray = [&](std::uint32_t cluster) {
    return bundle.zone_rays_begin[bundle.cluster_zones_begin[cluster]];
  };
  std::vector<PosedShape> solids;
  for (const Actor& actor : state.run_state().crowd.actors()) append_solids(actor, solids);
  std::vector<BeamSegment> beams;
  for (auto i = first_ray(bundle.sensor_clusters_begin[sensor]);
       i < first_ray(bundle.sensor_clusters_begin[sensor + 1]); ++i) {
    const Ray& ray = bundle.rays[i];
    float reach = range[i];
    bool sees_person = false;
    for (const PosedShape& solid : solids) {
      if (const auto distance = entry_distance(ray, solid, reach)) {
        reach = *distance;
        sees_person = true;
      }
    }
    beams.push_back({Vec3(ray.origin), Vec3(ray.origin + reach * ray.direction), sees_person});
  }
  return beams;
}

}  // namespace pirsim::sim
