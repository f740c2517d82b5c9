#include <cstring>

#include "core/digest.hpp"
#include "effects/catalogue.hpp"
#include "geom/triangle_surface.hpp"
#include "pirsim/io.hpp"
#include "pirsim/version.hpp"
#include "reconcile/ensemble/reference_table.hpp"

namespace pirsim::reconcile {
namespace {

/// Everything one after the other, every list with its length.
class Fingerprint {
 public:
  void add(std::string_view text) {
    add_number(text.size());
    bytes_ += text;
  }
  template <typename Number>
  void add_number(Number value) {
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    bytes_.append(raw.data(), raw.size());
  }
  void add(const Vec2& p) {
    add_number(p.x);
    add_number(p.y);
  }
  void add(const Vec3& p) {
    for (int i = 0; i < 3; ++i) add_number(p[i]);
  }
  void add(const Frame& frame) {
    add(frame.origin);
    for (int i = 0; i < 4; ++i) add_number(frame.rotation[i]);
  }
  [[nodiscard]] std::string digest() const { return sha256(bytes_); }

 private:
  std::string bytes_;
};

// Structured bindings name every field, so that a new one doesn't compile until it stands here.

/// Without its electronics: only hard zones are reconciled.
void add(Fingerprint& print, const SensorModelSpec& model) {
  const auto& [id, description, plane_m, clusters, response, optics, detector] = model;
  print.add(id);
  print.add_number(plane_m);
  print.add_number(clusters.size());
  for (const ClusterSpec& cluster : clusters) {
    const auto& [centre, range_m, lens_step, zones] = cluster;
    print.add(centre);
    print.add_number(range_m);
    print.add_number(lens_step);
    print.add_number(zones.size());
    for (const ZoneSpec& zone : zones) {
      for (const Vec2& corner : zone.corners) print.add(corner);
      print.add_number(zone.polarity);
    }
  }
}

void add(Fingerprint& print, const TriMesh& mesh) {
  const auto& [name, positions, triangles, solidity, temperature_c] = mesh;
  print.add(name);
  print.add_number(positions.size());
  for (const Vec3& p : positions) print.add(p);
  print.add_number(triangles.size());
  for (const auto& triangle : triangles) {
    for (const auto corner : triangle) print.add_number(corner);
  }
  print.add_number(solidity);
  print.add_number(temperature_c.has_value());
  print.add_number(temperature_c.value_or(0.0));
}

void add(Fingerprint& print, const SceneSpec& scene) {
  print.add_number(scene.meshes.size());
  for (const TriMesh& mesh : scene.meshes) add(print, mesh);
  print.add_number(scene.sensors.size());
  for (const SensorSpec& sensor : scene.sensors) {
    print.add(sensor.id);
    print.add(sensor.model);
    print.add(sensor.world_from_sensor);
  }
  print.add_number(scene.seats.size());
  for (const SeatSpec& seat : scene.seats) {
    const auto& [id, world_from_seat] = seat;
    print.add(id);
    print.add(world_from_seat);
  }
  print.add_number(scene.entrances.size());
  for (const EntranceSpec& entrance : scene.entrances) {
    const auto& [id, world_from_entrance, width_m, outside_m] = entrance;
    print.add(id);
    print.add(world_from_entrance);
    print.add_number(width_m);
    print.add_number(outside_m);
  }
  print.add_number(scene.floor.height_m());
  print.add_number(scene.floor.loops().size());
  for (const auto& loop : scene.floor.loops()) {
    print.add_number(loop.size());
    for (const Vec2& p : loop) print.add(p);
  }
  print.add_number(scene.sensor_models.size());
  for (const auto& [id, model] : scene.sensor_models) add(print, model);
}

/// What YAML doesn't hold of it.
void add_body_meshes(Fingerprint& print, const ScriptSpec& script) {
  for (const TrialSpec& trial : script.trials) {
    for (const PersonSpec& person : trial.people) {
      print.add_number(person.body_meshes.size());
      for (const auto& [part, mesh] : person.body_meshes) {
        print.add(part);
        add(print, mesh.surface->mesh());
      }
    }
  }
}

void add(Fingerprint& print, const NuisanceSpec& nuisance) {
  for (const double value :
       {nuisance.seat_position_m, nuisance.sensor_yaw_deg, nuisance.sensor_tilt_deg, nuisance.body_size,
        nuisance.arm_amplitude, nuisance.uneven_arms, nuisance.trunk_sway_deg}) {
    print.add_number(value);
  }
}

void add_catalogue(Fingerprint& print, const std::vector<std::string>& hypotheses) {
  for (const std::string& hypothesis : hypotheses) {
    const effects::EffectInfo& info = effects::find(hypothesis).info;
    print.add(info.name);
    for (const effects::ParameterInfo& parameter : info.parameters) {
      print.add(parameter.name);
      print.add_number(parameter.low);
      print.add_number(parameter.high);
      print.add_number(parameter.scale);
    }
  }
}

}  // namespace

std::string table_key(const RealizationSource& source, const StudyFrame& frame, int n_replicates,
                      const TableSettings& settings) {
  Fingerprint print;
  print.add(version());
  print.add(git_revision());
  add(print, source.scene);
  ScriptSpec script = source.script;
  script.seed = 0;  // realizations have seeds of their own
  script.replicates = 1;
  print.add(io::to_yaml(script));
  add_body_meshes(print, script);
  add(print, source.nuisance);
  print.add_number(source.seed);
  print.add_number(n_replicates);
  for (const auto n : {settings.n_realizations, settings.n_remembered, settings.n_traced}) print.add_number(n);
  add_catalogue(print, settings.effects);
  for (const std::string& phase : frame.counted_phases) print.add(phase);
  return print.digest();
}

}  // namespace pirsim::reconcile
