#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/text.hpp"
#include "pirsim/scene.hpp"
#include "schema/columns.hpp"
#include "schema/limits.hpp"
#include "schema/spec_faults.hpp"

namespace pirsim {
namespace {

constexpr double least_upright = 0.9962;  // cos 5 deg; assumed: a seat or doorway tilted more is a mistake of axes

bool is_finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// A message or none.
std::string place_fault(const Vec3& p) {
  if (!is_finite(p)) return "isn't finite";
  return is_in_world(p) ? "" : "lies more than 100 km from the origin";
}

class SceneCheck {
 public:
  SceneCheck(const SceneSpec& scene, Diagnostics& diagnostics) : scene_(scene), faults_(scene.name, diagnostics) {}

  void run() {
    const SpecPath path("scene");
    if (!faults_.few(path.field("sensors"), scene_.sensors.size(), limits::sensors) ||
        !faults_.few(path.field("seats"), scene_.seats.size(), limits::seats) ||
        !faults_.few(path.field("places"), scene_.places.size(), limits::places) ||
        !faults_.few(path.field("entrances"), scene_.entrances.size(), limits::entrances) ||
        !faults_.few(path.field("areas"), scene_.areas.size(), limits::areas) ||
        !faults_.few(path.field("doors"), scene_.doors.size(), limits::doors)) {
      return;
    }
    check_meshes(path);
    Names sensors("sensor"), seats("seat"), entrances("entrance");
    for (std::size_t i = 0; i < scene_.sensors.size(); ++i) check_sensor(path.item("sensors", i), i, sensors);
    for (std::size_t i = 0; i < scene_.seats.size(); ++i) {
      const SpecPath seat = path.item("seats", i);
      check_id(scene_.seats[i].id, seat, seats);
      check_upright(scene_.seats[i].world_from_seat, seat.field("world_from_seat"));
      faults_.fields(scene_.seats[i], seat);
      check_uses(scene_.seats[i].uses, seat);
    }
    for (std::size_t i = 0; i < scene_.places.size(); ++i) {
      const SpecPath place = path.item("places", i);
      check_id(scene_.places[i].id, place, seats);  // names are those of places, to sit or otherwise
      check_upright(scene_.places[i].world_from_place, place.field("world_from_place"));
      check_uses(scene_.places[i].uses, place);
    }
    for (std::size_t i = 0; i < scene_.entrances.size(); ++i) {
      const SpecPath entrance = path.item("entrances", i);
      check_id(scene_.entrances[i].id, entrance, entrances);
      check_upright(scene_.entrances[i].world_from_entrance, entrance.field("world_from_entrance"));
      faults_.fields(scene_.entrances[i], entrance);
    }
    Names doors("door");
    for (std::size_t i = 0; i < scene_.doors.size(); ++i) {
      const SpecPath door = path.item("doors", i);
      check_id(scene_.doors[i].id, door, doors);
      check_upright(scene_.doors[i].world_from_door, door.field("world_from_door"));
      faults_.fields(scene_.doors[i], door);
    }
    for (const auto& [name, model] : scene_.sensor_models) {
      const std::string key = "sensor_models['" + name + "']";
      faults_.error_if(path.field(key), name_fault(name));
      check(model, path.field(key), faults_);
    }
    check_floor(path.field("floor"));
    check_areas(path);
  }

 private:
  void check_meshes(const SpecPath& path) {
    std::size_t n_elements = 0;
    for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
      const TriMesh& mesh = scene_.meshes[i];
      n_elements += mesh.positions.size() + mesh.triangles.size();
      const SpecPath here = path.item("meshes", i);
      check_corners(mesh, here);
      faults_.fields(mesh, here);
    }
    if (n_elements <= limits::scene_elements) return;
    faults_.error(path.field("meshes"),
                  "more than " + std::to_string(limits::scene_elements) + " vertices and triangles");
  }

  /// The first fault of each kind.
  void check_corners(const TriMesh& mesh, const SpecPath& path) {
    const auto bad_place = std::ranges::find_if_not(mesh.positions, is_in_world);
    if (bad_place != mesh.positions.end()) {
      faults_.error(path.item("positions", static_cast<std::size_t>(bad_place - mesh.positions.begin())),
                    place_fault(*bad_place));
    }
    const std::size_t n = mesh.positions.size();
    const auto bad_triangle = std::ranges::find_if(mesh.triangles, [&](const auto& corners) {
      return std::ranges::any_of(corners, [&](auto i) { return i >= n; });
    });
    if (bad_triangle == mesh.triangles.end()) return;
    faults_.error(path.item("triangles", static_cast<std::size_t>(bad_triangle - mesh.triangles.begin())),
                  "has a corner that doesn't exist: the mesh has " + std::to_string(n) + " vertices");
  }

  void check_id(const std::string& id, const SpecPath& path, Names& ids) {
    const std::string fault = name_fault(id);
    if (!fault.empty()) faults_.error(path.field("id"), "'" + id + "': " + fault);
    faults_.error_if(path.field("id"), ids.fault_of_adding(id));
  }

  void check_uses(const std::vector<std::string>& uses, const SpecPath& path) {
    for (std::size_t i = 0; i < uses.size(); ++i) faults_.error_if(path.item("uses", i), use_fault(uses[i]));
  }

  void check_sensor(const SpecPath& path, std::size_t index, Names& ids) {
    const SensorSpec& sensor = scene_.sensors[index];
    check_id(sensor.id, path, ids);
    faults_.error_if(path.field("id"), column_fault(sensor.id));
    static_cast<void>(check_frame(sensor.world_from_sensor, path.field("world_from_sensor")));
    faults_.fields(sensor, path);
    faults_.error_if(path.field("area"), area_fault(sensor, scene_.areas));
    if (scene_.sensor_models.contains(sensor.model)) return;
    std::vector<std::string> names;
    for (const auto& [name, model] : scene_.sensor_models) names.push_back(name);
    faults_.error(path.field("model"), "there is no sensor model '" + sensor.model + "' in scene.sensor_models" +
                                           near_or_all(sensor.model, names));
  }

  [[nodiscard]] bool check_frame(const Frame& frame, const SpecPath& path) {
    const std::string fault = place_fault(frame.origin);
    faults_.error_if(path.field("origin"), fault);
    const bool is_rotation = std::abs(glm::length(frame.rotation) - 1.0) < 1e-6;
    if (!is_rotation) faults_.error(path.field("rotation"), "isn't a rotation (a quaternion of length 1)");
    return fault.empty() && is_rotation;
  }
  void check_upright(const Frame& frame, const SpecPath& path) {
    if (check_frame(frame, path) && !is_upright(frame)) faults_.error(path, "must stand upright (its +Y up)");
  }

  void check_floor(const SpecPath& path) {
    if (scene_.floor.empty()) return faults_.error(path, "no floor");
    faults_.number(path.field("height_m"), scene_.floor.height_m(), accepted::in_world_m);
    faults_.error_if(path.field("loops"), outline_fault(scene_.floor));
  }

  void check_areas(const SpecPath& path) {
    if (scene_.areas.empty()) return;
    Names ids("area");
    bool are_outlined = !scene_.floor.empty() && outline_fault(scene_.floor).empty();
    for (std::size_t i = 0; i < scene_.areas.size(); ++i) {
      const AreaSpec& area = scene_.areas[i];
      const SpecPath here = path.item("areas", i);
      check_id(area.id, here, ids);
      faults_.error_if(here.field("id"), area_id_fault(area.id));
      const std::string fault = area.outline.empty() ? "the area has no outline" : outline_fault(area.outline, "area");
      faults_.error_if(here.field("outline"), fault);
      are_outlined = are_outlined && fault.empty();
    }
    if (!are_outlined) return;
    check_together(scene_.areas, scene_.floor, [&](std::size_t i, const std::string& message) {
      faults_.error(path.item("areas", i).field("outline"), message);
    });
  }

  const SceneSpec& scene_;
  SpecFaults faults_;
};

/// Twice the signed area of a triangle.
double side(const Vec2& a, const Vec2& b, const Vec2& p) noexcept {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Two segments that cross in their inner points; touching is allowed.
bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) noexcept {
  // Rounding must not make touching edges cross: within this many square metres a point is on the line.
  constexpr double on_line = 1e-9;
  const auto opposite = [&](double s, double t) {
    return (s > on_line && t < -on_line) || (s < -on_line && t > on_line);
  };
  return opposite(side(a, b, c), side(a, b, d)) && opposite(side(c, d, a), side(c, d, b));
}

}  // namespace

std::string name_fault(std::string_view name) {
  const auto fits = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
  };
  if (!name.empty() && name.front() != '.' && std::ranges::all_of(name, fits)) return {};
  return "it needs letters, digits, '_', '-' or '.'";
}

std::string use_fault(const std::string& use) {
  const std::vector<std::string> known(place_uses.begin(), place_uses.end());
  if (std::ranges::find(known, use) != known.end()) return {};
  return "'" + use + "' isn't a use of a place" + near_or_all(use, known);
}

std::string column_fault(std::string_view id, const std::string& type) {
  const std::string named = type + " id '" + std::string(id) + "' ";
  if (is_column_of_area(id)) return named + "begins as the columns of areas do: '" + std::string(area_prefix) + "'";
  if (is_column_of_door(id)) return named + "begins as the columns of doors do: '" + std::string(door_prefix) + "'";
  return is_column_name(id) ? named + "is the name of a column of rows" : "";
}

std::string Names::fault_of_adding(const std::string& name) {
  return names_.insert(name).second ? std::string() : "a second " + kind_ + " '" + name + "'";
}

bool is_in_world(const Vec3& place) noexcept {
  constexpr NumberRange world = accepted::in_world_m;
  return world.holds(place.x) && world.holds(place.y) && world.holds(place.z);
}

bool is_upright(const Frame& frame) noexcept { return frame.up().y >= least_upright; }

bool outlines_cross(const std::vector<Vec2>& first, const std::vector<Vec2>& second) noexcept {
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = 0; j < second.size(); ++j) {
      if (cross(first[i], first[(i + 1) % first.size()], second[j], second[(j + 1) % second.size()])) return true;
    }
  }
  return false;
}

std::string too_many_corners(const std::string& what) {
  return "the outline of " + what + "s has more than " + std::to_string(limits::floor_corners) + " corners";
}

std::string outline_fault(const FloorArea& floor, const std::string& what) {
  const auto& loops = floor.loops();
  const std::string the = "the " + what;
  std::size_t n_corners = 0;
  for (const auto& loop : loops) {
    if (loop.size() < 3) return the + " has an outline of fewer than three corners";
    n_corners += loop.size();
    for (const Vec2& p : loop) {
      if (!accepted::in_world_m.holds(p.x) || !accepted::in_world_m.holds(p.y))
        return the + " reaches more than 100 km from the origin";
    }
  }
  if (n_corners > limits::floor_corners) return too_many_corners(what);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      if (outlines_cross(loops[i], loops[j])) return "the outline of " + the + " crosses itself";
    }
  }
  return floor.area_m2() < 1e-6 ? the + " has no area" : "";
}

void check(const SceneSpec& scene, Diagnostics& diagnostics) { SceneCheck(scene, diagnostics).run(); }

}  // namespace pirsim
