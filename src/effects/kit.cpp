#include "effects/kit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace pirsim::effects {

ChoiceInfo sensor_choice() { return {"sensor", ChoiceKind::sensor, {}, "all sensors"}; }

std::string word(const EffectSpec& effect, std::string_view choice) {
  if (const auto made = effect.choices.find(choice); made != effect.choices.end()) return made->second;
  return std::ranges::find(find(effect.name).info.choices, choice, &ChoiceInfo::name)->words.front();
}

std::vector<std::uint32_t> sensors_of(const EffectSpec& effect, const SceneSpec& scene) {
  const auto named = effect.choices.find("sensor");
  std::vector<std::uint32_t> sensors;
  for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
    if (named == effect.choices.end() || named->second == scene.sensors[i].id) sensors.push_back(i);
  }
  return sensors;
}

std::vector<Stream> streams_of(const std::vector<std::uint32_t>& sensors, std::uint64_t seed, std::uint32_t run,
                               Purpose purpose) {
  std::vector<Stream> streams;
  for (const std::uint32_t sensor : sensors) streams.emplace_back(StreamKey{seed, run, sensor, purpose});
  return streams;
}

std::int64_t ticks_to_event(Stream& stream, double mean_per_tick) noexcept {
  constexpr double never = 1e15;
  return 1 + static_cast<std::int64_t>(std::min(never, std::floor(-std::log1p(-stream.uniform()) / mean_per_tick)));
}

namespace {

constexpr double spacing_m = 0.25;

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0.0 ? glm::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + t * along);
}

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// Seen from above; 0 inside.
double distance_to_triangle(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  const double ab = cross(b - a, p - a), bc = cross(c - b, p - b), ca = cross(a - c, p - c);
  const bool has_area = cross(b - a, c - a) != 0.0;
  if (has_area && ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0))) return 0.0;
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

bool clear_of(const TriMesh& mesh, const Vec2& p, double floor_m, double clear_m) {
  constexpr double step_m = 0.02, person_m = 2.0;  // what lies flat on the floor or over the head is in nobody's way
  return std::ranges::all_of(mesh.triangles, [&](const auto& triangle) {
    const Vec3 &a = mesh.positions[triangle[0]], &b = mesh.positions[triangle[1]], &c = mesh.positions[triangle[2]];
    if (std::max({a.y, b.y, c.y}) < floor_m + step_m || std::min({a.y, b.y, c.y}) > floor_m + person_m) return true;
    return distance_to_triangle(p, floor_point(a), floor_point(b), floor_point(c)) >= clear_m;
  });
}

double nearest_seat_m(const SceneSpec& scene, const Vec2& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const SeatSpec& seat : scene.seats) {
    nearest = std::min(nearest, glm::distance(p, floor_point(seat.world_from_seat.origin)));
  }
  return nearest;
}

}  // namespace

std::vector<Vec2> free_places(const SceneSpec& scene, double clear_m) {
  constexpr double from_seat_m = 0.8, from_door_m = 1.2;  // assumed: not in anybody's way
  std::vector<Vec2> places;
  const Vec2 lower = scene.floor.lower(), upper = scene.floor.upper();
  for (double x = lower.x + clear_m; x <= upper.x - clear_m; x += spacing_m) {
    for (double z = lower.y + clear_m; z <= upper.y - clear_m; z += spacing_m) {
      const Vec2 p(x, z);
      const bool free =
          scene.floor.contains(p) && nearest_seat_m(scene, p) >= from_seat_m &&
          std::ranges::none_of(scene.entrances,
                               [&](const EntranceSpec& door) {
                                 return glm::distance(p, floor_point(door.world_from_entrance.origin)) < from_door_m;
                               }) &&
          std::ranges::all_of(scene.meshes,
                              [&](const TriMesh& mesh) { return clear_of(mesh, p, scene.floor.height_m(), clear_m); });
      if (free) places.push_back(p);
    }
  }
  std::ranges::stable_sort(places, std::ranges::greater{}, [&](const Vec2& p) { return nearest_seat_m(scene, p); });
  return places;
}

Vec2 nearest_free(const SceneSpec& scene, double clear_m, const Vec2& place) {
  const std::vector<Vec2> places = free_places(scene, clear_m);
  if (places.empty()) return place;
  const Vec2 nearest = *std::ranges::min_element(places, {}, [&](const Vec2& p) { return glm::distance(p, place); });
  return glm::distance(nearest, place) <= spacing_m / std::sqrt(2.0) ? place : nearest;
}

bool draw_free_place(EffectSpec& effect, const SceneSpec& scene, double clear_m, Stream& stream) {
  const std::vector<Vec2> places = free_places(scene, clear_m);
  if (places.empty()) return false;
  const Vec2 place = places[stream.index(static_cast<std::uint32_t>(places.size()))];
  effect.parameters["x_m"] = place.x;
  effect.parameters["z_m"] = place.y;
  return true;
}

void settle_free_place(EffectSpec& effect, const SceneSpec& scene, double clear_m) {
  const Vec2 free = nearest_free(scene, clear_m, {effect.parameters.at("x_m"), effect.parameters.at("z_m")});
  effect.parameters.at("x_m") = free.x;
  effect.parameters.at("z_m") = free.y;
}

}  // namespace pirsim::effects
