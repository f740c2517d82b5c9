#include "engine/effects/kit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace pirsim::effects {

ChoiceInfo sensor_choice() { return {"sensor", ChoiceKind::sensor, {}, "all sensors"}; }

ChoiceInfo trend_choice() { return {"trend", ChoiceKind::variant, {"steady", "growing"}, "the same in all runs"}; }

void draw_trend(EffectSpec& effect, const SceneSpec&, const ScriptSpec& script, Stream&) {
  const std::size_t n_runs = script.trials.size() * static_cast<std::size_t>(script.replicates);
  if (n_runs < fewest_runs_of_a_trend) effect.choices["trend"] = trend_choice().words.front();
}

Trend::Trend(const EffectSpec& effect, const StageContext& context)
    : kind_(word(effect, "trend") == "growing" ? Kind::growing : Kind::steady), n_runs_(context.n_runs) {}

double Trend::in_run(double mean, std::uint32_t run) const noexcept {
  return kind_ == Kind::steady ? mean : mean * 2.0 * (1.0 + run) / (1.0 + n_runs_);
}

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
double floor_distance_to_triangle(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  const double ab = cross(b - a, p - a), bc = cross(c - b, p - b), ca = cross(a - c, p - c);
  const bool has_area = cross(b - a, c - a) != 0.0;
  if (has_area && ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0))) return 0.0;
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

/// What lies flat on the floor or over the head isn't.
bool is_in_the_way(const Vec3& a, const Vec3& b, const Vec3& c, double floor_m) {
  constexpr double step_m = 0.02, person_m = 2.0;
  return std::max({a.y, b.y, c.y}) >= floor_m + step_m && std::min({a.y, b.y, c.y}) <= floor_m + person_m;
}

bool clear_of(const TriMesh& mesh, const Vec2& p, double floor_m, double clear_m) {
  return std::ranges::all_of(mesh.triangles, [&](const auto& triangle) {
    const Vec3 &a = mesh.positions[triangle[0]], &b = mesh.positions[triangle[1]], &c = mesh.positions[triangle[2]];
    return !is_in_the_way(a, b, c, floor_m) ||
           floor_distance_to_triangle(p, floor_point(a), floor_point(b), floor_point(c)) >= clear_m;
  });
}

double nearest_seat_m(const SceneSpec& scene, const Vec2& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const SeatSpec& seat : scene.seats) {
    nearest = std::min(nearest, glm::distance(p, floor_point(seat.world_from_seat.origin)));
  }
  return nearest;
}

bool crosses(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  return c_side * d_side <= 0.0 && a_side * b_side <= 0.0 && (c_side != d_side || a_side != b_side);
}

/// What bars the way of whoever walks, seen from above.
struct Barrier {
  std::array<Vec2, 3> corners;
  Vec2 lower, upper;

  [[nodiscard]] bool bars(const Vec2& a, const Vec2& b) const {
    if (std::max(a.x, b.x) < lower.x || std::min(a.x, b.x) > upper.x || std::max(a.y, b.y) < lower.y ||
        std::min(a.y, b.y) > upper.y)
      return false;
    return floor_distance_to_triangle(a, corners[0], corners[1], corners[2]) == 0.0 ||
           crosses(a, b, corners[0], corners[1]) || crosses(a, b, corners[1], corners[2]) ||
           crosses(a, b, corners[2], corners[0]);
  }
};

std::vector<Barrier> barriers_of(const SceneSpec& scene) {
  std::vector<Barrier> barriers;
  for (const TriMesh& mesh : scene.meshes) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
      if (!is_in_the_way(p, q, r, scene.floor.height_m())) continue;
      Barrier barrier{{floor_point(p), floor_point(q), floor_point(r)}, {}, {}};
      const auto& [u, v, w] = barrier.corners;
      barrier.lower = glm::min(u, glm::min(v, w)), barrier.upper = glm::max(u, glm::max(v, w));
      barriers.push_back(barrier);
    }
  }
  return barriers;
}

/// A grid over the floor, in parts within which one can go about.
class Parts {
 public:
  /// xs, zs: (n_columns), (n_rows) of the grid.
  Parts(const SceneSpec& scene, std::vector<double> xs, std::vector<double> zs)
      : xs_(std::move(xs)), zs_(std::move(zs)), labels_(xs_.size() * zs_.size(), outside) {
    const std::vector<Barrier> barriers = barriers_of(scene);
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (scene.floor.contains(place(i))) labels_[i] = unknown;
    }
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (labels_[i] == unknown) fill(i, barriers);
    }
    open_ = parts_behind(scene.entrances);
  }
  /// Do people get there, from an entrance or, without any, from much of the floor?
  [[nodiscard]] bool is_open(std::size_t column, std::size_t row) const {
    const int label = labels_[column * zs_.size() + row];
    return label >= 0 && open_[static_cast<std::size_t>(label)];
  }

 private:
  static constexpr int outside = -1, unknown = -2;
  [[nodiscard]] Vec2 place(std::size_t i) const { return {xs_[i / zs_.size()], zs_[i % zs_.size()]}; }

  void fill(std::size_t seed, const std::vector<Barrier>& barriers) {
    const int label = static_cast<int>(sizes_.size());
    const std::size_t rows = zs_.size();
    sizes_.push_back(0);
    std::vector<std::size_t> pending{seed};
    labels_[seed] = label;
    while (!pending.empty()) {
      const std::size_t i = pending.back();
      pending.pop_back();
      ++sizes_.back();
      const auto go_on = [&](std::size_t next) {
        const auto bars = [&](const Barrier& barrier) { return barrier.bars(place(i), place(next)); };
        if (labels_[next] != unknown || std::ranges::any_of(barriers, bars)) return;
        labels_[next] = label;
        pending.push_back(next);
      };
      if (i >= rows) go_on(i - rows);
      if (i + rows < labels_.size()) go_on(i + rows);
      if (i % rows > 0) go_on(i - 1);
      if (i % rows + 1 < rows) go_on(i + 1);
    }
  }

  /// By label. Without an entrance that leads in: the largest, and others of at least half its size.
  [[nodiscard]] std::vector<bool> parts_behind(const std::vector<EntranceSpec>& doors) const {
    std::vector<bool> open(sizes_.size(), false);
    for (const EntranceSpec& door : doors) {
      constexpr double reach_m = 1.0;  // assumed: what is right behind a threshold (tried 0.7-1.5)
      const Frame door_from_world = inverse(door.world_from_entrance);
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        const Vec3 p = door_from_world * Vec3(place(i).x, door.world_from_entrance.origin.y, place(i).y);
        const bool is_behind = p.z <= 0.0 && p.z >= -reach_m && 2.0 * std::abs(p.x) <= door.width_m;
        if (is_behind && labels_[i] >= 0) open[static_cast<std::size_t>(labels_[i])] = true;
      }
    }
    if (sizes_.empty() || std::ranges::find(open, true) != open.end()) return open;
    const std::size_t largest = *std::ranges::max_element(sizes_);
    for (std::size_t part = 0; part < sizes_.size(); ++part) open[part] = 2 * sizes_[part] >= largest;
    return open;
  }

  std::vector<double> xs_, zs_;
  std::vector<int> labels_;         ///< (n_columns x n_rows)
  std::vector<std::size_t> sizes_;  ///< by label
  std::vector<bool> open_;          ///< by label
};

std::vector<double> steps(double from, double to) {
  std::vector<double> values;
  for (double value = from; value <= to; value += spacing_m) values.push_back(value);
  return values;
}

}  // namespace

std::vector<Vec2> free_places(const SceneSpec& scene, double clear_m) {
  constexpr double from_seat_m = 0.8, from_door_m = 1.2;  // assumed: not in anybody's way
  const Vec2 lower = scene.floor.lower(), upper = scene.floor.upper();
  const std::vector<double> xs = steps(lower.x + clear_m, upper.x - clear_m);
  const std::vector<double> zs = steps(lower.y + clear_m, upper.y - clear_m);
  const Parts parts(scene, xs, zs);
  std::vector<Vec2> places;
  for (std::size_t column = 0; column < xs.size(); ++column) {
    for (std::size_t row = 0; row < zs.size(); ++row) {
      const Vec2 p(xs[column], zs[row]);
      const auto is_in_doorway = [&](const EntranceSpec& door) {
        return glm::distance(p, floor_point(door.world_from_entrance.origin)) < from_door_m;
      };
      const auto is_clear = [&](const TriMesh& mesh) { return clear_of(mesh, p, scene.floor.height_m(), clear_m); };
      const bool free = parts.is_open(column, row) && nearest_seat_m(scene, p) >= from_seat_m &&
                        std::ranges::none_of(scene.entrances, is_in_doorway) &&
                        std::ranges::all_of(scene.meshes, is_clear);
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
