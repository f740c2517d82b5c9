#include "schema/scene_unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/text.hpp"

namespace pirsim {
namespace {

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

}  // namespace

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

}  // namespace pirsim
