#include <cmath>
#include <set>

#include "pirsim/scene.hpp"
#include "schema/column_names.hpp"

namespace pirsim {
namespace {

bool is_finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

class SceneCheck {
 public:
  SceneCheck(const SceneSpec& scene, Diagnostics& diagnostics) : scene_(scene), diagnostics_(diagnostics) {}

  void run() {
    for (const TriMesh& mesh : scene_.meshes) check(mesh);
    std::set<std::string> sensors, seats, entrances;
    for (const SensorSpec& sensor : scene_.sensors) {
      check("sensor", sensor.id, sensor.world_from_sensor, sensors);
      if (is_column_name(sensor.id)) error("sensor id '" + sensor.id + "' is the name of a column of rows");
      if (!scene_.sensor_models.contains(sensor.model)) {
        error("sensor '" + sensor.id + "': there is no sensor model '" + sensor.model + "'");
      }
    }
    for (const SeatSpec& seat : scene_.seats) check("seat", seat.id, seat.world_from_seat, seats);
    for (const EntranceSpec& entrance : scene_.entrances) {
      check("entrance", entrance.id, entrance.world_from_entrance, entrances);
      if (!(entrance.width_m >= 0.3 && entrance.width_m <= 20.0)) outside("entrance", entrance.id, "width_m");
      if (!(entrance.outside_m >= 0.3 && entrance.outside_m <= 50.0)) outside("entrance", entrance.id, "outside_m");
    }
    for (const auto& [name, model] : scene_.sensor_models) check(name, model);
    check_floor();
  }

 private:
  void error(std::string message) { diagnostics_.error({scene_.name}, std::move(message)); }
  void outside(const std::string& what, const std::string& id, const std::string& quantity) {
    error(what + " '" + id + "': " + quantity + " is outside of what is accepted");
  }

  void check(const TriMesh& mesh) {
    for (const Vec3& p : mesh.positions) {
      if (is_finite(p)) continue;
      error("mesh '" + mesh.name + "' has a corner that isn't finite");
      break;
    }
    for (const auto& triangle : mesh.triangles) {
      if (triangle[0] < mesh.positions.size() && triangle[1] < mesh.positions.size() &&
          triangle[2] < mesh.positions.size())
        continue;
      error("mesh '" + mesh.name + "' has a triangle with a corner that doesn't exist");
      break;
    }
  }

  void check(const std::string& what, const std::string& id, const Frame& frame, std::set<std::string>& ids) {
    if (id.empty()) error(what + " without an id");
    if (!ids.insert(id).second) error("a second " + what + " '" + id + "'");
    const double length = glm::length(frame.rotation);
    if (!is_finite(frame.origin) || !(std::abs(length - 1.0) < 1e-6)) {
      error(what + " '" + id + "': its frame isn't a place and a rotation (a quaternion of length 1)");
    }
  }

  void check(const std::string& name, const SensorModelSpec& model) {
    bool sound = std::isfinite(model.plane_m) && model.plane_m > 0.0;
    for (const ClusterSpec& cluster : model.clusters) {
      sound = sound && std::isfinite(cluster.range_m) && cluster.range_m > 0.0;
      for (const ZoneSpec& zone : cluster.zones) {
        for (const Vec2& corner : zone.corners) sound = sound && std::isfinite(corner.x) && std::isfinite(corner.y);
      }
    }
    if (!sound) error("sensor model '" + name + "': planes and ranges are above 0, corners finite");
  }

  void check_floor() {
    if (scene_.floor.empty()) error("no floor");
    bool finite = std::isfinite(scene_.floor.height_m());
    for (const auto& loop : scene_.floor.loops()) {
      if (loop.size() < 3) error("the floor has an outline of fewer than three corners");
      for (const Vec2& corner : loop) finite = finite && std::isfinite(corner.x) && std::isfinite(corner.y);
    }
    if (!finite) error("the floor has a corner that isn't finite");
  }

  const SceneSpec& scene_;
  Diagnostics& diagnostics_;
};

}  // namespace

void check(const SceneSpec& scene, Diagnostics& diagnostics) { SceneCheck(scene, diagnostics).run(); }

}  // namespace pirsim
