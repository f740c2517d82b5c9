#include "model/schema/check_scene.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "model/core/text.hpp"
#include "model/geom/floor.hpp"
#include "model/schema/checks.hpp"
#include "model/schema/columns.hpp"
#include "model/schema/fields.hpp"
#include "model/schema/fingerprint.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {
namespace {

std::vector<FloorArea> outlines_of(const std::vector<AreaSpec>& areas) {
  std::vector<FloorArea> outlines;
  for (const AreaSpec& area : areas) outlines.push_back(area.outline);
  return outlines;
}

/// What is below a sensor or, of one on a wall, close before it: a border may run along the wall that it hangs on.
std::optional<std::size_t> area_before(const Frame& world_from_sensor, const std::vector<AreaSpec>& areas) {
  constexpr double first_m = 0.02, last_m = 0.5, step_m = 0.04;  // assumed: a thick wall (last: 0.3-1)
  constexpr double level = 0.1;  // assumed: a horizontal part of the axis that means a direction
  const Vec2 below = floor_point(world_from_sensor.origin), axis = floor_point(world_from_sensor.forward());
  const auto area_at = [&](const Vec2& point) -> std::optional<std::size_t> {
    const auto found = std::ranges::find_if(areas, [&](const AreaSpec& area) { return area.outline.contains(point); });
    if (found == areas.end()) return std::nullopt;
    return static_cast<std::size_t>(found - areas.begin());
  };
  if (glm::length(axis) < level) return area_at(below);
  const Vec2 direction = glm::normalize(axis);
  for (double away_m = first_m; away_m < last_m; away_m += step_m) {
    if (const auto area = area_at(below + away_m * direction)) return area;
  }
  return std::nullopt;
}

struct Unit {
  const char* name;
  double metres;
};
constexpr std::array units{Unit{"millimetres", 0.001}, Unit{"centimetres", 0.01}, Unit{"inches", 0.0254},
                           Unit{"feet", 0.3048}};

struct Range {
  double least, most;
  [[nodiscard]] bool contains(double value) const noexcept { return value >= least && value <= most; }
};

// What may be metres; assumed. The longest halls span some hundred metres (tried 200-500), the highest some thirty
// (30-60), and no stool is higher than a metre (1-1.5).
constexpr double longest_floor_m = 300.0, highest_room_m = 40.0, highest_seat_m = 1.3;
// What another unit has to make of the sizes; assumed.
constexpr Range room_height_m{1.9, 12.0}, floor_side_m{0.8, longest_floor_m}, seat_height_m{0.3, 1.0};
constexpr double usual_height_m = 2.6, usual_floor_m = 6.0;

struct Sizes {
  Vec2 floor;
  std::optional<double> height, seat;  ///< of the room; of the middle one of all pelvis points. Above the floor.
};

Sizes sizes_of(const SceneSpec& scene) {
  Sizes sizes{scene.floor.upper() - scene.floor.lower(), {}, {}};
  double top = -std::numeric_limits<double>::infinity();
  for (const SensorSpec& sensor : scene.sensors) top = std::max(top, sensor.world_from_sensor.origin.y);
  for (const TriMesh& mesh : scene.meshes) {
    for (const Vec3& p : mesh.positions) top = std::max(top, p.y);
  }
  if (std::isfinite(top)) sizes.height = top - scene.floor.height_m();
  std::vector<double> seats;
  for (const SeatSpec& seat : scene.seats) seats.push_back(seat.world_from_seat.origin.y - scene.floor.height_m());
  if (!seats.empty()) {
    const auto middle = seats.begin() + static_cast<std::ptrdiff_t>(seats.size() / 2);
    std::ranges::nth_element(seats, middle);
    sizes.seat = *middle;
  }
  return sizes;
}

bool is_long(const Sizes& sizes) { return std::max(sizes.floor.x, sizes.floor.y) > longest_floor_m; }

bool is_plausible(const Sizes& sizes, const Unit& unit) {
  return floor_side_m.contains(sizes.floor.x * unit.metres) && floor_side_m.contains(sizes.floor.y * unit.metres) &&
         (!sizes.height || room_height_m.contains(*sizes.height * unit.metres)) &&
         (!sizes.seat || seat_height_m.contains(*sizes.seat * unit.metres));
}

/// How many times too large or too small, the lower the better.
double oddity(const Sizes& sizes, const Unit& unit) {
  const double height = sizes.height ? std::abs(std::log(*sizes.height * unit.metres / usual_height_m)) : 0.0;
  return height + std::abs(std::log(std::max(sizes.floor.x, sizes.floor.y) * unit.metres / usual_floor_m));
}

const Unit* likeliest_unit(const Sizes& sizes) {
  const Unit* best = nullptr;
  for (const Unit& unit : units) {
    if (is_plausible(sizes, unit) && (best == nullptr || oddity(sizes, unit) < oddity(sizes, *best))) best = &unit;
  }
  return best;
}

std::string spans(const Vec2& floor, int decimals) {
  return fixed(floor.x, decimals) + " m x " + fixed(floor.y, decimals) + " m";
}

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
        !faults_.few(path.field("arrays"), scene_.arrays.size(), limits::arrays) ||
        !faults_.few(path.field("seats"), scene_.seats.size(), limits::seats) ||
        !faults_.few(path.field("places"), scene_.places.size(), limits::places) ||
        !faults_.few(path.field("entrances"), scene_.entrances.size(), limits::entrances) ||
        !faults_.few(path.field("areas"), scene_.areas.size(), limits::areas) ||
        !faults_.few(path.field("doors"), scene_.doors.size(), limits::doors)) {
      return;
    }
    check_meshes(path);
    Names sensors("sensor"), seats("seat"), entrances("entrance");
    for (std::size_t i = 0; i < scene_.sensors.size(); ++i)
      check_sensor(path.item("sensors", i), scene_.sensors[i], Frames::none, sensors);
    for (std::size_t i = 0; i < scene_.arrays.size(); ++i)
      check_sensor(path.item("arrays", i), scene_.arrays[i], Frames::given, sensors);
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
      faults_.fields(scene_.places[i], place);
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

  enum class Frames { none, given };
  void check_sensor(const SpecPath& path, const SensorSpec& sensor, Frames frames, Names& ids) {
    check_id(sensor.id, path, ids);
    faults_.error_if(path.field("id"), column_fault(sensor.id));
    static_cast<void>(check_frame(sensor.world_from_sensor, path.field("world_from_sensor")));
    faults_.fields(sensor, path);
    faults_.error_if(path.field("area"), area_fault(sensor, scene_.areas));
    if (const auto model = scene_.sensor_models.find(sensor.model); model != scene_.sensor_models.end()) {
      if (model->second.array.has_value() != (frames == Frames::given)) {
        faults_.error(path.field("model"), "'" + sensor.model + "' is " + (model->second.array ? "an" : "no") +
                                               " array: it belongs into scene." +
                                               (model->second.array ? "arrays" : "sensors"));
      }
      return;
    }
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

constexpr double least_common_m2 = 1e-4;  // assumed: less is rounding along a common border (1e-6 to 1e-3 would do)
constexpr double flat_m = 0.1;            // assumed: areas may be drawn a little above the floor, to be seen (0.02-0.2)

std::string named(const AreaSpec& area) { return "area '" + area.id + "'"; }

/// Of one that is on no floor. A message or none.
std::string off_floor_fault(const AreaSpec& area, const FloorArea& floor) {
  const double up_m = area.outline.height_m() - floor.height_m();
  if (std::abs(up_m) > flat_m)
    return named(area) + " lies " + fixed(std::abs(up_m), 2) + " m " + (up_m > 0.0 ? "above" : "below") + " the floor";
  return common_m2(area.outline, floor) < least_common_m2 ? named(area) + " lies off the floor" : "";
}

// All assumed. Nobody runs faster (10-15); somebody who crosses a room is faster than the walk (0.2-0.4).
constexpr double fastest_m_s = 12.0, slowest_walk_m_s = 0.3, walk_m = 2.0;

/// How a file's numbers may be meant: scale times (x, z), or (z, x).
struct Reading {
  const char* name;
  double scale = 1.0;
  Vec2 signs{1.0};
  bool is_swapped = false;
  [[nodiscard]] Vec2 of(const Vec2& p) const { return scale * signs * (is_swapped ? Vec2(p.y, p.x) : p); }
};
const std::array readings{Reading{"z turned round", 1.0, {1.0, -1.0}},
                          Reading{"centimetres", 0.01},
                          Reading{"millimetres", 0.001},
                          Reading{"feet", 0.3048},
                          Reading{"inches", 0.0254},
                          Reading{"x and z exchanged", 1.0, {1.0, 1.0}, true},
                          Reading{"x turned round", 1.0, {-1.0, 1.0}},
                          Reading{"x and z turned round", 1.0, {-1.0, -1.0}},
                          Reading{"centimetres with z turned round", 0.01, {1.0, -1.0}},
                          Reading{"millimetres with z turned round", 0.001, {1.0, -1.0}}};

struct Step {
  double metres = 0.0, seconds = 0.0, at_s = 0.0;
  const TrackSpec* track = nullptr;
  [[nodiscard]] double speed() const { return metres / seconds; }
};

std::string in_metres(const Vec2& size) { return fixed(size.x, 2) + " m x " + fixed(size.y, 2) + " m"; }

class Doubts {
 public:
  Doubts(const FloorArea& floor, const PositionsSpec& positions) : floor_(floor), positions_(positions) {
    for (const TrackSpec& track : positions.tracks) {
      for (std::size_t i = 0; i < track.points.size(); ++i) add(track, i);
    }
  }

  [[nodiscard]] std::optional<std::string> text() const {
    if (n_ == 0 || floor_.empty()) return std::nullopt;
    if (auto told = off_the_floor()) return told;
    if (auto told = too_fast()) return told;
    if (auto told = too_slow()) return told;
    return in_a_corner();
  }

 private:
  void add(const TrackSpec& track, std::size_t i) {
    ++n_;
    lower_ = glm::min(lower_, track.points[i]);
    upper_ = glm::max(upper_, track.points[i]);
    if (i == 0) return;
    const double seconds = track.times_s[i] - track.times_s[i - 1];
    const Step step{glm::distance(track.points[i], track.points[i - 1]), seconds, track.times_s[i], &track};
    longest_step_s_ = std::max(longest_step_s_, seconds);
    shortest_step_s_ = std::min(shortest_step_s_, seconds);
    if (fastest_.track == nullptr || step.speed() > fastest_.speed()) fastest_ = step;
    farthest_m_ = std::max(farthest_m_, glm::distance(track.points[i], track.points.front()));
  }

  [[nodiscard]] double share_on_floor(const Reading& reading) const {
    std::size_t n = 0;
    for (const TrackSpec& track : positions_.tracks)
      n += static_cast<std::size_t>(
          std::ranges::count_if(track.points, [&](const Vec2& p) { return floor_.contains(reading.of(p)); }));
    return static_cast<double>(n) / static_cast<double>(n_);
  }

  [[nodiscard]] std::optional<std::string> off_the_floor() const {
    constexpr double few = 0.5, most = 0.9;  // assumed: people wait behind doors, and trackers see beyond walls
    const double on = share_on_floor({"as they are"});
    if (on >= few) return std::nullopt;
    const auto* meant = std::ranges::find_if(readings, [&](const Reading& one) { return share_on_floor(one) >= most; });
    if (on > 0.0 && meant == readings.end()) return std::nullopt;
    return (on > 0.0 ? "only " + percent(on) + " of the positions are over the floor"
                     : std::string("nobody is ever over the floor")) +
           ": they span x " + fixed(lower_.x, 2) + " to " + fixed(upper_.x, 2) + ", z " + fixed(lower_.y, 2) + " to " +
           fixed(upper_.y, 2) + ", the floor x " + fixed(floor_.lower().x, 2) + " to " + fixed(floor_.upper().x, 2) +
           ", z " + fixed(floor_.lower().y, 2) + " to " + fixed(floor_.upper().y, 2) +
           (meant == readings.end() ? "" : std::string(". They look like ") + meant->name) +
           "; metres of the scene are expected";
  }

  [[nodiscard]] std::optional<std::string> too_fast() const {
    if (fastest_.track == nullptr || fastest_.speed() <= fastest_m_s) return std::nullopt;
    return "'" + fastest_.track->person + "' goes " + fixed(fastest_.metres, 2) + " m in " +
           fixed(fastest_.seconds, 2) + " s, until second " + fixed(fastest_.at_s, 1) + ": " +
           fixed(fastest_.speed(), 0) + " m/s. Are places metres and times seconds, and is it one person throughout?";
  }

  /// Frames, as 0, 1, 2, ... of a camera, are far longer when they are taken for seconds, and milliseconds are.
  [[nodiscard]] std::optional<std::string> too_slow() const {
    constexpr double frame_s = 1.5, rare_s = 100.0,
                     slowest_m_s = 0.03;  // assumed: of rows far apart people rest between
    const bool are_frames = longest_step_s_ <= frame_s && fastest_.speed() < slowest_walk_m_s;
    const bool are_ms = shortest_step_s_ >= rare_s && fastest_.speed() < slowest_m_s;
    if (farthest_m_ < walk_m || !(are_frames || are_ms)) return std::nullopt;
    return "people cross " + fixed(farthest_m_, 1) + " m of the room, and nobody is faster than " +
           fixed(fastest_.speed(), 3) + " m/s: the times look like " + (are_frames ? "frames" : "milliseconds") +
           " rather than seconds";
  }

  [[nodiscard]] std::optional<std::string> in_a_corner() const {
    constexpr double of_several = 0.2, of_one = 0.1;  // assumed (0.1-0.3, 0.05-0.2), of the floor's sides
    const double share = positions_.tracks.size() > 1 ? of_several : of_one;
    const Vec2 size = upper_ - lower_, floor = floor_.upper() - floor_.lower();
    if (n_ < 3 || size.x > share * floor.x || size.y > share * floor.y || size == Vec2(0.0)) return std::nullopt;
    return "all positions lie within " + in_metres(size) + " of a floor of " + in_metres(floor) +
           ": metres of the scene are expected";
  }

  const FloorArea& floor_;
  const PositionsSpec& positions_;
  std::size_t n_ = 0;
  Vec2 lower_{std::numeric_limits<double>::max()}, upper_{std::numeric_limits<double>::lowest()};
  Step fastest_{};
  double longest_step_s_ = 0.0, shortest_step_s_ = std::numeric_limits<double>::max(), farthest_m_ = 0.0;
};

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

void check(const ClusterSpec& cluster, const SpecPath& path, SpecFaults& faults) {
  faults.fields(cluster, path);
  if (cluster.zones.empty()) faults.error(path.field("zones"), "expected a list that isn't empty");
  for (std::size_t i = 0; i < cluster.zones.size(); ++i) {
    const ZoneSpec& zone = cluster.zones[i];
    const SpecPath here = path.item("zones", i);
    faults.error_if(here.field("corners"), corners_fault(zone));
    if (zone.polarity != 1 && zone.polarity != -1) {
      faults.error(here.field("polarity"), "expected one of 1, -1, got " + std::to_string(zone.polarity));
    }
  }
}

}  // namespace

Areas::Areas(const SceneSpec& scene) : parts_(scene.floor, outlines_of(scene.areas)), names_(ids_of(scene.areas)) {
  if (parts_.has_rest()) names_.emplace_back(elsewhere);
  for (const SensorSpec& sensor : scene.sensors) {
    const auto said = std::ranges::find(scene.areas, sensor.area.value_or(""), &AreaSpec::id);
    of_sensors_.push_back(said != scene.areas.end()
                              ? std::optional(static_cast<std::size_t>(said - scene.areas.begin()))
                              : area_before(sensor.world_from_sensor, scene.areas));
  }
}

std::string_view Areas::name_of_sensor(std::size_t sensor) const noexcept {
  if (empty()) return {};
  const std::optional<std::size_t> area = of_sensors_[sensor];
  return area ? std::string_view(names_[*area]) : elsewhere;
}

std::vector<std::size_t> Areas::sensors_of(std::size_t area) const {
  std::vector<std::size_t> sensors;
  for (std::size_t i = 0; i < of_sensors_.size(); ++i) {
    if (of_sensors_[i] == area) sensors.push_back(i);
  }
  return sensors;
}

std::optional<std::string> doubt_of_unit(const SceneSpec& scene) {
  Sizes sizes = sizes_of(scene);
  const bool is_high = sizes.height && *sizes.height > highest_room_m;
  if (!is_long(sizes) && !is_high && !(sizes.seat && *sizes.seat > highest_seat_m)) return std::nullopt;
  const Unit* unit = likeliest_unit(sizes);
  if (unit == nullptr && is_long(sizes)) {  // only the floor is, then
    sizes.height = sizes.seat = std::nullopt;
    unit = likeliest_unit(sizes);
  }
  if (unit == nullptr) {
    if (!is_long(sizes)) return std::nullopt;
    return "the floor spans " + spans(sizes.floor, 0) + ": glTF's unit is the metre";
  }
  const auto high = [&](double metres, int decimals) {
    return sizes.height ? " and the room is " + fixed(*sizes.height * metres, decimals) + " m high" : "";
  };
  return "the floor spans " + spans(sizes.floor, 0) + high(1.0, 0) + ": " + unit->name + "? In " + unit->name +
         " the floor spans " + spans(sizes.floor * unit->metres, 1) + high(unit->metres, 1) +
         "; glTF's unit is the metre";
}

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

// What areas must hold among each other and on their floor.

std::string area_id_fault(const std::string& id) {
  if (id == elsewhere) return "area id '" + id + "' is what pirsim calls the floor that is in no area";
  return column_fault(id, "area");
}

std::string area_fault(const SensorSpec& sensor, const std::vector<AreaSpec>& areas) {
  if (!sensor.area || std::ranges::find(areas, *sensor.area, &AreaSpec::id) != areas.end()) return {};
  return "there is no area '" + *sensor.area + "'" +
         (areas.empty() ? ": the scene has none" : near_or_all(*sensor.area, ids_of(areas)));
}

void check_together(const std::vector<AreaSpec>& areas, const FloorArea& floor,
                    const std::function<void(std::size_t, const std::string&)>& tell) {
  std::size_t n_corners = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    for (const auto& loop : areas[i].outline.loops()) n_corners += loop.size();
    if (n_corners > limits::floor_corners) return tell(i, too_many_corners("area"));
  }
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const std::string fault = off_floor_fault(areas[i], floor);
    if (!fault.empty()) tell(i, fault);
    for (std::size_t k = 0; k < i; ++k) {
      const double common = common_m2(areas[k].outline, areas[i].outline);
      if (common < least_common_m2) continue;
      tell(i, named(areas[i]) + " overlaps " + named(areas[k]) + " by " + fixed(common, common < 0.01 ? 4 : 2) + " m2");
      break;  // the first is enough to find the fault
    }
  }
}

std::vector<Issue> doubts_of_positions(const SceneSpec& scene, const ScriptSpec& script) {
  Diagnostics remarks;
  std::set<std::string> told;
  for (const TrialSpec& trial : script.trials) {
    if (!trial.occupancy || !trial.occupancy->positions || trial.occupancy->positions->tracks.empty()) continue;
    const PositionsSpec& positions = *trial.occupancy->positions;
    const std::optional<std::string> text = Doubts(scene.floor, positions).text();
    if (text && told.insert(*text).second) remarks.warning(positions.tracks.front().where, "positions: " + *text);
  }
  return remarks.issues();
}

void check_together(const AmplifierSpec& amplifier, const TellFault& tell) {
  if (amplifier.low_hz >= amplifier.high_hz) tell("high_hz", "expected high_hz above low_hz");
  if (amplifier.lowest_v >= amplifier.offset_v || amplifier.offset_v >= amplifier.highest_v) {
    tell("offset_v", "expected offset_v between lowest_v and highest_v");
  }
}

void check_together(const ComparatorSpec& comparator, const TellFault& tell) {
  if (comparator.pulse_count > 1 && comparator.pulse_window_s <= 0.0) {
    tell("pulse_count", "several pulses need a pulse_window_s");
  }
}

void check_together(const DetectorSpec& detector, const TellFault& tell) {
  const auto& [element, amplifier, comparator, report] = detector;
  const double up = amplifier.highest_v - amplifier.offset_v, down = amplifier.offset_v - amplifier.lowest_v;
  const bool levels_make_sense = up > 0.0 && down > 0.0;
  if (levels_make_sense && (comparator.positive_v >= up || comparator.negative_v >= down)) {
    tell("comparator", "the output saturates before it reaches a threshold");
  }
}

void move_arrays(SceneSpec& scene) {
  const auto first = std::stable_partition(scene.sensors.begin(), scene.sensors.end(), [&](const SensorSpec& sensor) {
    return !scene.sensor_models.at(sensor.model).array;
  });
  std::move(first, scene.sensors.end(), std::back_inserter(scene.arrays));
  scene.sensors.erase(first, scene.sensors.end());
}

void refuse_arrays(const SceneSpec& scene, const std::string& who) {
  if (scene.arrays.empty()) return;
  throw Error(ErrorCode::input, Where{scene.name},
              who + " works on rows of motion, which a thermal array doesn't give: leave out '" +
                  scene.arrays.front().id + "' (" + scene.arrays.front().model + ")");
}

void check_together(const ArraySpec& array, const TellFault& tell) {
  if (array.to_um <= array.from_um) tell("to_um", "expected to_um above from_um");
}

void check_together(const SensorModelSpec& model, const TellFault& tell) {
  std::set<int> known, told;
  for (const ClusterSpec& cluster : model.clusters) known.insert(cluster.lens_step);
  for (const RatedTargetSpec& target : model.targets) {
    const std::string step = "lens step " + std::to_string(target.lens_step);
    if (!known.contains(target.lens_step)) tell("targets", "no facet is of " + step);
    if (!told.insert(target.lens_step).second) tell("targets", step + " has two targets");
  }
}

std::string corners_fault(const ZoneSpec& zone) {
  int left = 0;
  int right = 0;
  for (std::size_t i = 0; i < zone.corners.size(); ++i) {
    const Vec2& corner = zone.corners[i];
    if (!accepted::on_lens_plane_m.holds(corner.x) || !accepted::on_lens_plane_m.holds(corner.y)) {
      return "expected coordinates that are " + accepted::on_lens_plane_m.text();
    }
    // All turns of the outline go the same way.
    const Vec2 in = zone.corners[(i + 1) % 4] - corner;
    const Vec2 out = zone.corners[(i + 2) % 4] - zone.corners[(i + 1) % 4];
    (cross(in, out) > 0.0 ? left : right) += cross(in, out) != 0.0 ? 1 : 0;
  }
  return left == 4 || right == 4 ? "" : "expected the corners of a convex area in order round it";
}

namespace {

/// What a kind of sensor hasn't can't be set, as files refuse its keys.
void check_kind(const SensorModelSpec& model, const SpecPath& path, SpecFaults& faults) {
  const bool is_beam = model.response == Response::beam && !model.array;
  const std::string kind = model.array ? "a thermal array" : is_beam ? "a beam" : "a PIR sensor";
  each_field<SensorModelSpec>([&](const auto& field) {
    const std::string_view name = field.name;
    const bool is_of_all = name == "id" || name == "description" || name == "names" || name == "response";
    const bool is_of_zones = name == "plane_m" || name == "clusters";
    const bool is_its_own = model.array ? name == "array"
                            : is_beam   ? is_of_zones || name == "idle_share"
                                        : name != "idle_share";
    if (is_of_all || is_its_own) return;
    Fingerprint given, usual;
    given.add(model.*field.member);
    usual.add(SensorModelSpec{}.*field.member);
    if (given.digest() != usual.digest())
      faults.error(path.field(field.name), "is set, which " + kind + " doesn't have");
  });
}

}  // namespace

void check(const SensorModelSpec& model, const SpecPath& path, SpecFaults& faults) {
  if (model.id.empty()) faults.error(path.field("id"), "expected a text that isn't empty");
  faults.fields(model, path);
  check_kind(model, path, faults);
  if (model.array) {
    faults.fields(*model.array, path.field("array"));
    return faults.together(*model.array, path.field("array"));
  }
  if (model.clusters.empty()) faults.error(path.field("clusters"), "expected a list that isn't empty");
  for (std::size_t i = 0; i < model.clusters.size(); ++i) check(model.clusters[i], path.item("clusters", i), faults);
  for (std::size_t i = 0; i < model.targets.size(); ++i) faults.fields(model.targets[i], path.item("targets", i));
  faults.together(model, path);
  faults.fields(model.sensitivity, path.field("sensitivity"));
  faults.fields(model.optics, path.field("optics"));
  const SpecPath detector = path.field("detector");
  faults.fields(model.detector.element, detector.field("element"));
  faults.fields(model.detector.amplifier, detector.field("amplifier"));
  faults.together(model.detector.amplifier, detector.field("amplifier"));
  faults.fields(model.detector.comparator, detector.field("comparator"));
  faults.together(model.detector.comparator, detector.field("comparator"));
  faults.fields(model.detector.report, detector.field("report"));
  faults.together(model.detector, detector);
}

}  // namespace pirsim
