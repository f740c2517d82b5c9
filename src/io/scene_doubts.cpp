// What a scene may say, but hardly means: each a warning.
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "io/scene_parts.hpp"

namespace pirsim::io::detail {
namespace {

struct Box {
  Vec3 least{std::numeric_limits<double>::max()}, most{std::numeric_limits<double>::lowest()};
  [[nodiscard]] bool is_over(const Vec3& p) const {
    return p.x >= least.x && p.x <= most.x && p.z >= least.z && p.z <= most.z;
  }
};

Box box_of(const TriMesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.least = glm::min(box.least, p), box.most = glm::max(box.most, p);
  return box;
}

std::string extent(double width, double depth) {
  std::ostringstream text;
  text << std::llround(width) << " m x " << std::llround(depth) << " m";
  return text.str();
}

/// Nobody means metres by thousands of them.
std::string unit_of(double metres) { return metres >= 1000.0 ? "millimetres?" : "centimetres?"; }

class Doubts {
 public:
  Doubts(const SceneSpec& scene, const MarkedNodes& nodes, const DoubtSink& tell)
      : scene_(scene), nodes_(nodes), tell_(tell) {
    for (const TriMesh& mesh : scene.meshes) boxes_.push_back(box_of(mesh));
  }

  void run() {
    sizes();
    for (std::size_t i = 0; i < scene_.entrances.size(); ++i) entrance(scene_.entrances[i], nodes_.entrances[i]);
    for (std::size_t i = 0; i < scene_.seats.size(); ++i) seat(scene_.seats[i], nodes_.seats[i]);
  }

 private:
  void sizes() {
    // assumed: the largest halls span some hundred metres, and what stands in a room isn't ten times its size
    constexpr double longest_floor_m = 300.0, longest_m = 100.0, to_floor = 10.0;
    const Vec2 floor = scene_.floor.upper() - scene_.floor.lower();
    const double across = glm::length(floor);
    if (std::max(floor.x, floor.y) > longest_floor_m) {
      tell_(nodes_.floor,
            "the floor spans " + extent(floor.x, floor.y) + ": " + unit_of(across) + " glTF's unit is the metre");
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (scene_.meshes[i].positions.empty()) continue;
      const Vec3 size = boxes_[i].most - boxes_[i].least;
      const double longest = std::max({size.x, size.y, size.z});
      if (longest <= std::max(longest_m, to_floor * across)) continue;
      tell_(nodes_.meshes[i], "its mesh spans " + extent(size.x, size.z) + " and is " +
                                  std::to_string(std::llround(size.y)) + " m high, beside a floor of " +
                                  extent(floor.x, floor.y) + ": " + unit_of(longest));
    }
  }

  void entrance(const EntranceSpec& entrance, int node) {
    const auto is_floor = [&](double z) {
      return scene_.floor.contains(floor_point(entrance.world_from_entrance * Vec3(0, 0, z)));
    };
    constexpr double step_m = 0.5;  // assumed: more than a threshold is deep, less than a corridor is wide
    if (!is_floor(-step_m) && is_floor(step_m)) {
      tell_(node, "entrance '" + entrance.id +
                      "' is turned round: the floor lies behind it, and its -Z must point into the room");
    }
  }

  void seat(const SeatSpec& seat, int node) {
    // The trunk stands above the pelvis; a cushion or an arm's rest is lower (assumed).
    const Vec3 hip = seat.world_from_seat.origin;
    if (const int within = crossed(hip, hip.y + 0.15, hip.y + 0.6); within >= 0) {
      tell_(node,
            "seat '" + seat.id + "' is inside of '" + name(within) + "': the sitter's trunk would pass through it");
      return;
    }
    if (table(seat, -1.0) >= 0) return;
    if (const int behind = table(seat, 1.0); behind >= 0) {
      tell_(node, "seat '" + seat.id + "' faces away from '" + name(behind) + "': sitters look along the node's -Z");
    }
  }

  /// The mesh of a table before the seat (towards -Z) or behind it, or -1.
  [[nodiscard]] int table(const SeatSpec& seat, double towards_z) const {
    constexpr double lowest_m = 0.6, highest_m = 0.9;  // above the floor; assumed: of desks and tables to sit at
    const double floor_m = scene_.floor.height_m();
    for (const double away_m : {0.35, 0.45, 0.55}) {  // beyond a chair's back, within the arms' reach
      const Vec3 place = seat.world_from_seat * Vec3(0, 0, towards_z * away_m);
      if (const int mesh = crossed(place, floor_m + lowest_m, floor_m + highest_m); mesh >= 0) return mesh;
    }
    return -1;
  }

  /// The first mesh that an upright line through the place intersects between two heights, or -1.
  [[nodiscard]] int crossed(const Vec3& place, double from_y, double to_y) const {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (!boxes_[i].is_over(place) || boxes_[i].most.y < from_y || boxes_[i].least.y > to_y) continue;
      const TriMesh& mesh = scene_.meshes[i];
      for (const auto& [a, b, c] : mesh.triangles) {
        const auto y = height_at(mesh.positions[a], mesh.positions[b], mesh.positions[c], place);
        if (y && *y >= from_y && *y <= to_y) return static_cast<int>(i);
      }
    }
    return -1;
  }
  [[nodiscard]] static std::optional<double> height_at(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    const auto side = [](const Vec3& u, const Vec3& v, const Vec3& w) {
      return (v.x - u.x) * (w.z - u.z) - (v.z - u.z) * (w.x - u.x);
    };
    const double whole = side(a, b, c);
    if (std::abs(whole) < 1e-12) return std::nullopt;  // upright itself
    const double at_a = side(p, b, c) / whole, at_b = side(a, p, c) / whole, at_c = side(a, b, p) / whole;
    if (std::min({at_a, at_b, at_c}) < 0.0) return std::nullopt;
    return at_a * a.y + at_b * b.y + at_c * c.y;
  }
  [[nodiscard]] const std::string& name(int mesh) const { return scene_.meshes[static_cast<std::size_t>(mesh)].name; }

  const SceneSpec& scene_;
  const MarkedNodes& nodes_;
  const DoubtSink& tell_;
  std::vector<Box> boxes_;  ///< (n_meshes)
};

}  // namespace

void doubt(const SceneSpec& scene, const MarkedNodes& nodes, const DoubtSink& tell) {
  Doubts(scene, nodes, tell).run();
}

}  // namespace pirsim::io::detail
