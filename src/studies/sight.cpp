#include "studies/sight.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ranges>
#include <sstream>

#include "body/motion.hpp"
#include "core/grouped_warnings.hpp"
#include "geom/floor_distance.hpp"
#include "schema/scene_unit.hpp"
#include "sim/compiled_study.hpp"
#include "studies/sitters.hpp"

namespace pirsim::studies {
namespace {

constexpr double beside_m = 0.5;  // assumed: a sensor on the far side of a wall isn't nearer (tried 0.3-1)
constexpr double buried_m = 0.5;  // assumed: 0.3 to 1 m would do; walls are thinner, and nobody comes so near

/// Traces single postures and tells which sensors have an active zone.
class Onlooker {
 public:
  Onlooker(const Model& model, const body::Humanoid& humanoid)
      : rays_(model.compiled().array().rated()),
        humanoid_(humanoid),
        tracer_(model.compiled().array().make_tracer(model.compiled().tracer(), sim::ZonesOf::all_sensors)) {}

  /// (n_sensors) whether the sensor sees the posture.
  std::vector<bool> sensors_that_see(const body::Posture& posture) {
    std::vector<PosedShape> solids;
    for (std::size_t i = 0; i < body::n_parts; ++i) solids.push_back(place(humanoid_.solids()[i], posture[i]));
    ZoneSet zones(rays_.n_zones());
    tracer_->add(0, solids, zones);
    std::vector<bool> seen;
    for (std::size_t sensor = 0; sensor < rays_.n_sensors(); ++sensor) {
      const auto first = rays_.cluster_zones_begin[rays_.sensor_clusters_begin[sensor]];
      const auto last = rays_.cluster_zones_begin[rays_.sensor_clusters_begin[sensor + 1]];
      seen.push_back(std::ranges::any_of(std::views::iota(first, last), [&](auto zone) { return zones.test(zone); }));
    }
    return seen;
  }

 private:
  const RayBundle& rays_;
  const body::Humanoid& humanoid_;
  std::unique_ptr<rt::Tracer> tracer_;
};

body::Posture seated_posture(const Model& model, const body::Humanoid& humanoid, const SeatSpec& seat) {
  try {
    return seated(humanoid, {seat.world_from_seat, model.scene().floor.height_m(), std::nullopt}, model.tick_s())
        .posture();
  } catch (const Error& fault) {  // the body knows no names
    throw Error(fault.code(), Where{model.scene().name}, "seat '" + seat.id + "': " + fault.issues().front().message);
  }
}

void count_rays(const Model& model, std::size_t sensor, SensorSight& sight) {
  const RayBundle& rated = model.compiled().array().rated();
  const RayBundle& clipped = model.rays();
  const auto ray_of_cluster = [&](std::uint32_t cluster) {
    return rated.zone_rays_begin[rated.cluster_zones_begin[cluster]];
  };
  const auto first = ray_of_cluster(rated.sensor_clusters_begin[sensor]);
  const auto last = ray_of_cluster(rated.sensor_clusters_begin[sensor + 1]);
  sight.rays = last - first;
  for (auto ray = first; ray < last; ++ray) {
    if (clipped.range[ray] < rated.range[ray]) ++sight.rays_cut;
    sight.longest_m = std::max(sight.longest_m, static_cast<double>(clipped.range[ray]));
  }
}

}  // namespace

SightReport look_around(const Model& model) {
  const SceneSpec& scene = model.compiled().scene();
  const auto& people = model.compiled().trials().front().people;
  const body::Humanoid humanoid(people.empty() ? PersonInForce{} : people.front().spec);
  const body::WalkableFloor floor(scene.floor, {}, scene.meshes, humanoid.clearance_radius_m());
  Onlooker onlooker(model, humanoid);

  SightReport report;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    SensorSight& sight = report.sensors.emplace_back();
    sight.sensor = scene.sensors[i].id;
    sight.outside = hangs_outside(scene.floor, scene.sensors[i].world_from_sensor.origin);
    count_rays(model, i, sight);
  }
  const Vec2 lower = scene.floor.lower(), upper = scene.floor.upper();
  for (double z = lower.y + report.spacing_m / 2; z < upper.y; z += report.spacing_m) {
    for (double x = lower.x + report.spacing_m / 2; x < upper.x; x += report.spacing_m) {
      if (!scene.floor.contains({x, z}) || !floor.walkable({x, z})) continue;
      const body::Motion standing(humanoid, {x, z}, 0.0, scene.floor.height_m(), model.tick_s());
      const std::vector<bool> seen = onlooker.sensors_that_see(standing.posture());
      ++report.places;
      if (std::ranges::find(seen, true) != seen.end()) ++report.places_seen_by_any;
      for (std::size_t i = 0; i < seen.size(); ++i) report.sensors[i].places += seen[i] ? 1 : 0;
    }
  }
  for (const SeatSpec& seat : scene.seats) {
    const std::vector<bool> seen = onlooker.sensors_that_see(seated_posture(model, humanoid, seat));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i]) report.sensors[i].seats.push_back(seat.id);
    }
  }
  return report;
}

std::string hangs_outside(const FloorArea& floor, const Vec3& place) {
  const Vec2 below = floor_point(place);
  const double away_m = distance_to_edge_m(floor, below);
  if (floor.contains(below) || away_m <= beside_m) return {};
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << away_m;
  return "it hangs outside of the room, " + text.str() + " m from the floor's edge";
}

namespace {

/// Was the scene told to be in another unit than metres? Then that is why.
bool is_told_of_unit(const SceneSpec& scene) {
  const auto doubt = doubt_of_unit(scene);
  return doubt &&
         std::ranges::any_of(scene.warnings, [&](const Issue& told) { return told.message.ends_with(*doubt); });
}

void note_blind(const SensorSight& sight, const std::string& scene, GroupedWarnings& warnings) {
  const std::string name = "sensor '" + sight.sensor + "'", blind = name + " can see NOBODY: ";
  if (!sight.outside.empty()) return warnings.add("outside", {scene, 0, 0}, name, blind + sight.outside);
  if (sight.rays > 0 && sight.longest_m < buried_m) {
    return warnings.add("buried", {scene, 0, 0}, name,
                        blind + "all of its rays end within " +
                            std::to_string(std::lround(std::ceil(100.0 * sight.longest_m))) +
                            " cm (is it inside a wall, or right before one?)");
  }
  warnings.add("astray", {scene, 0, 0}, name,
               blind +
                   "no zone reaches a standing or seated person anywhere on the floor area (does it look at a "
                   "wall, along -Z of its node?)");
}

}  // namespace

std::vector<Issue> warnings(const SightReport& report, const SceneSpec& scene) {
  if (is_told_of_unit(scene)) return {};
  GroupedWarnings blind;
  for (const SensorSight& sight : report.sensors) {
    if (sight.sees_nothing()) note_blind(sight, scene.name, blind);
  }
  Diagnostics remarks;
  blind.tell(remarks);
  const auto cut = [](const SensorSight& sight) { return sight.rays_cut > 0; };
  if (!report.sensors.empty() && std::ranges::none_of(report.sensors, cut)) {
    remarks.warning({scene.name, 0, 0},
                    "no ray of any sensor ends at the room: without walls sensors see people outside, too");
  }
  return remarks.issues();
}

}  // namespace pirsim::studies
