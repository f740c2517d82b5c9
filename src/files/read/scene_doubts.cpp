#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "files/read/scene_parts.hpp"
#include "model/core/text.hpp"
#include "model/geom/floor.hpp"
#include "model/geom/shapes.hpp"
#include "model/schema/check_scene.hpp"
#include "model/schema/door_leaf.hpp"

// What a scene may say, but hardly means: each a warning.

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
  return std::to_string(std::llround(width)) + " m x " + std::to_string(std::llround(depth)) + " m";
}

/// "0.25 m"
std::string in_metres(double length_m) { return fixed(length_m, 2) + " m"; }

/// Nobody means metres by thousands of them.
std::string unit_of(double metres) { return metres >= 1000.0 ? "millimetres?" : "centimetres?"; }

class SceneDoubts {
 public:
  SceneDoubts(const SceneSpec& scene, const MarkedNodes& nodes, const DoubtSink& tell)
      : scene_(scene), nodes_(nodes), tell_(tell) {
    for (const TriMesh& mesh : scene.meshes) boxes_.push_back(box_of(mesh));
  }

  void run() {
    const auto unit = nodes_.as_meant.contains(nodes_.floor) ? std::nullopt : doubt_of_unit(scene_);
    if (unit) return tell("unit", nodes_.floor, "the floor", *unit);
    sizes();
    for (std::size_t i = 0; i < scene_.areas.size(); ++i) area(scene_.areas[i], nodes_.areas[i]);
    for (std::size_t i = 0; i < scene_.entrances.size(); ++i) entrance(scene_.entrances[i], nodes_.entrances[i]);
    for (std::size_t i = 0; i < scene_.seats.size(); ++i) seat(scene_.seats[i], nodes_.seats[i]);
    for (std::size_t i = 0; i < scene_.places.size(); ++i) place(scene_.places[i], nodes_.places[i]);
    neighbours();
    for (std::size_t i = 0; i < scene_.doors.size(); ++i) door(i);
  }

 private:
  void tell(const char* kind, int node, std::string name, std::string message) const {
    if (!nodes_.as_meant.contains(node)) tell_({kind, node, std::move(name), std::move(message)});
  }

  void sizes() {
    constexpr double longest_m = 100.0, to_floor = 10.0;  // assumed: what stands in a room isn't ten times its size
    const Vec2 floor = scene_.floor.upper() - scene_.floor.lower();
    const double across = glm::length(floor);
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (scene_.meshes[i].positions.empty()) continue;
      const Vec3 size = boxes_[i].most - boxes_[i].least;
      const double longest = std::max({size.x, size.y, size.z});
      if (longest <= std::max(longest_m, to_floor * across)) continue;
      tell("size", nodes_.meshes[i], "'" + scene_.meshes[i].name + "'",
           "its mesh spans " + extent(size.x, size.z) + " and is " + std::to_string(std::llround(size.y)) +
               " m high, beside a floor of " + extent(floor.x, floor.y) + ": " + unit_of(longest));
    }
  }

  void area(const AreaSpec& area, int node) {
    constexpr double worth_telling_m2 = 0.01;  // assumed: less is rounding along the walls (0.001-0.05)
    const double whole_m2 = area.outline.area_m2();
    const double off_m2 = whole_m2 - common_m2(area.outline, scene_.floor);
    if (off_m2 < worth_telling_m2) return;
    tell("off the floor", node, "area '" + area.id + "'",
         fixed(off_m2, 2) + " m2 of area '" + area.id + "' (" + fixed(std::max(1.0, 100.0 * off_m2 / whole_m2), 0) +
             " %) lie off the floor, where nobody counts");
  }

  void entrance(const EntranceSpec& entrance, int node) {
    const auto is_floor = [&](double z) {
      return scene_.floor.contains(floor_point(entrance.world_from_entrance * Vec3(0, 0, z)));
    };
    constexpr double step_m = 0.5;  // assumed: more than a threshold is deep, less than a corridor is wide
    if (!is_floor(-step_m) && is_floor(step_m)) {
      tell("turned round", node, "entrance '" + entrance.id + "'",
           "entrance '" + entrance.id +
               "' is turned round: the floor lies behind it, and its -Z must point into the room");
    }
    threshold(entrance, node);
    doorway(entrance, node);
  }

  /// Its node is the middle of the threshold, where the floor ends.
  void threshold(const EntranceSpec& entrance, int node) {
    // assumed: what walkers step over, and half of a thick wall (0.1-0.2)
    constexpr double most_above_m = 0.1, most_aside_m = 0.2;
    const Vec3 at = entrance.world_from_entrance.origin;
    if (const double above_m = at.y - scene_.floor.height_m(); std::abs(above_m) > most_above_m) {
      tell("height", node, "entrance '" + entrance.id + "'",
           "entrance '" + entrance.id + "' isn't on the floor, but " + in_metres(std::abs(above_m)) +
               (above_m > 0.0 ? " above it" : " below it"));
    }
    const Vec2 place = floor_point(at);
    if (const double aside_m = distance_to_edge_m(scene_.floor, place); aside_m > most_aside_m) {
      tell("edge", node, "entrance '" + entrance.id + "'",
           "entrance '" + entrance.id + "' isn't at the floor's edge, but " + in_metres(aside_m) +
               (scene_.floor.contains(place) ? " inside" : " outside") +
               " of it: its node is the middle of the threshold");
    }
  }

  /// How much of its width is a wall, or furniture right before or behind it.
  void doorway(const EntranceSpec& entrance, int node) {
    constexpr double share_in_doubt = 0.25;  // assumed: more than a frame and an open leaf take (0.05-0.2)
    const Closed closed = closed_of(entrance.world_from_entrance, entrance.width_m);
    if (closed.share <= share_in_doubt) return;
    tell("doorway", node, "entrance '" + entrance.id + "'",
         "entrance '" + entrance.id + "': '" + name(closed.mesh) + "' stands in " +
             in_metres(entrance.width_m * closed.share) + " of its width of " + in_metres(entrance.width_m));
  }
  /// Of the width of an opening.
  struct Closed {
    double share = 0.0;
    int mesh = -1;  ///< one that is met there
  };
  [[nodiscard]] Closed closed_of(const Frame& opening, double width_m) const {
    constexpr int n_across = 20;
    std::array<int, n_across> by{};  // the mesh that is met there
    by.fill(-1);
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (reaches(boxes_[i], opening, width_m)) close(opening, width_m, static_cast<int>(i), by);
    }
    const auto closed = std::ranges::count_if(by, [](int mesh) { return mesh >= 0; });
    return {static_cast<double>(closed) / n_across, *std::ranges::max_element(by)};
  }

  /// Its frame, what it sweeps and what it leads between.
  void door(std::size_t index) {
    constexpr double tick_s = 0.05, beside_m = 0.1;  // assumed: half of a jamb (0.05-0.2)
    const DoorSpec& door = scene_.doors[index];
    const int node = nodes_.doors[index];
    const std::string named = "door '" + door.id + "'";
    const auto say = [&](const char* kind, const std::string& what) { tell(kind, node, named, named + what); };
    const double above_m = door.world_from_door.origin.y - scene_.floor.height_m();
    if (std::abs(above_m) > 0.1)
      say("door height",
          " isn't on the floor, but " + in_metres(std::abs(above_m)) + (above_m > 0.0 ? " above it" : " below it"));
    const DoorLeaf leaf(door, tick_s);
    const Closed in_leaf = closed_of(door.world_from_door, door.width_m);
    if (in_leaf.share > 0.0)
      say("door width", ": '" + name(in_leaf.mesh) + "' stands in " + in_metres(in_leaf.share * door.width_m) +
                            " of its leaf's width of " + in_metres(door.width_m));
    if (closed_of(door.world_from_door, door.width_m + 2.0 * beside_m).share == 0.0)
      say("no wall", " is in no wall: there is nothing beside its leaf");
    for (std::size_t other = 0; other < index; ++other) {
      const double apart_m = glm::distance(door.world_from_door.origin, scene_.doors[other].world_from_door.origin);
      if (apart_m < 0.2) say("same door", " is at the place of door '" + scene_.doors[other].id + "'");
    }
    if (!areas_.empty()) {
      constexpr double away_m = 0.4;  // assumed: beyond a thick wall (0.3-0.6)
      const Vec2 before = floor_point(door.world_from_door * Vec3(0, 0, away_m));
      const Vec2 behind = floor_point(door.world_from_door * Vec3(0, 0, -away_m));
      const bool leads_out = !scene_.floor.contains(before) || !scene_.floor.contains(behind);
      if (!leads_out && areas_.at(before) == areas_.at(behind))
        say("areas",
            " doesn't lie between two areas: both of its sides are '" + std::string(areas_.name_at(before)) + "'");
    }
    for (const SeatSpec& seat : scene_.seats) {
      constexpr double room_m = 0.25, knees_m = 0.45;  // assumed: half of a body, the length of a thigh
      const Vec2 at = floor_point(seat.world_from_seat.origin);
      const Vec2 knees = floor_point(seat.world_from_seat * Vec3(0, 0, -knees_m));
      if (std::min(leaf.distance_to_sweep_m(at), leaf.distance_to_sweep_m(knees)) < room_m)
        say("leaf hits", ": its leaf hits who sits on seat '" + seat.id + "'");
    }
  }

  static constexpr double half_depth_m = 0.25;  ///< of a doorway; assumed: most of a wall, less than a person needs
  [[nodiscard]] static bool reaches(const Box& box, const Frame& opening, double width_m) {
    const double reach_m = 0.5 * width_m + half_depth_m;
    const Vec3 at = opening.origin;
    return box.least.x <= at.x + reach_m && box.most.x >= at.x - reach_m && box.least.z <= at.z + reach_m &&
           box.most.z >= at.z - reach_m;
  }
  /// Notes the mesh wherever it crosses a line through the doorway at the height of shins, hips or heads.
  template <std::size_t n_across>
  void close(const Frame& opening, double width_m, int mesh, std::array<int, n_across>& by) const {
    const Frame opening_from_world = inverse(opening);
    const TriMesh& given = scene_.meshes[static_cast<std::size_t>(mesh)];
    const double floor_y = scene_.floor.height_m() - opening.origin.y;
    const auto local = [&](std::uint32_t corner) {  // so that a line through the doorway is upright
      const Vec3 p = opening_from_world * given.positions[corner];
      return Vec3(p.x, p.z, p.y - floor_y);
    };
    for (const auto& [a, b, c] : given.triangles) {
      const Vec3 at_a = local(a), at_b = local(b), at_c = local(c);
      const Vec3 least = glm::min(at_a, glm::min(at_b, at_c)), most = glm::max(at_a, glm::max(at_b, at_c));
      if (least.y > half_depth_m || most.y < -half_depth_m) continue;
      if (2.0 * least.x > width_m || 2.0 * most.x < -width_m) continue;
      for (std::size_t i = 0; i < n_across; ++i) {
        const double x = width_m * ((static_cast<double>(i) + 0.5) / n_across - 0.5);
        for (const double height_m : {0.3, 1.0, 1.7}) {
          const auto depth_m = height_at(at_a, at_b, at_c, {x, 0.0, height_m});
          if (depth_m && std::abs(*depth_m) <= half_depth_m) by[i] = mesh;
        }
      }
    }
  }

  struct Spot {
    std::string name;
    Vec3 at{0.0};
    int node = 0;
  };
  void neighbours() {
    std::vector<Spot> seats, beds, stands;
    for (std::size_t i = 0; i < scene_.seats.size(); ++i)
      seats.push_back({"seat '" + scene_.seats[i].id + "'", scene_.seats[i].world_from_seat.origin, nodes_.seats[i]});
    for (std::size_t i = 0; i < scene_.places.size(); ++i) {
      const PlaceSpec& place = scene_.places[i];
      (place.posture == PlacePosture::lie ? beds : stands)
          .push_back({"place '" + place.id + "'", place.world_from_place.origin, nodes_.places[i]});
    }
    neighbours(seats, "two sitters would sit in each other");
    neighbours(beds, "two would lie in each other");
    neighbours(stands, "two would stand in each other");
  }
  /// Spots as near as this are one that was copied, or two for one person; assumed: less than any chair is wide.
  void neighbours(const std::vector<Spot>& spots, const std::string& so) {
    constexpr double least_apart_m = 0.4;
    std::vector<std::size_t> along_x(spots.size());
    std::iota(along_x.begin(), along_x.end(), std::size_t{0});
    std::ranges::stable_sort(along_x, {}, [&](std::size_t i) { return spots[i].at.x; });
    for (auto i = along_x.begin(); i != along_x.end(); ++i) {
      for (auto k = i; k != along_x.begin() && spots[*i].at.x - spots[*(k - 1)].at.x < least_apart_m; --k) {
        const double apart_m = glm::distance(spots[*i].at, spots[*(k - 1)].at);
        if (apart_m >= least_apart_m) continue;
        const auto [first, second] = std::minmax(*i, *(k - 1));
        tell("neighbours", spots[second].node, spots[second].name,
             spots[second].name + " is " + in_metres(apart_m) + " from " + spots[first].name + ": " + so);
        break;
      }
    }
  }

  void place(const PlaceSpec& place, int node) {
    const std::string name = "place '" + place.id + "'";
    const auto doubt = [&](const char* kind, const std::string& message) { tell(kind, node, name, name + message); };
    if (!scene_.floor.contains(floor_point(place.world_from_place.origin))) {
      return doubt("off the floor", " lies off the floor: who is there isn't counted in the column `people`");
    }
    if (place.posture == PlacePosture::lie) return bed(place, doubt);
    constexpr double most_above_m = 0.1;  // assumed, as of entrances
    const double above_m = place.world_from_place.origin.y - scene_.floor.height_m();
    if (std::abs(above_m) <= most_above_m) return;
    doubt("height",
          " isn't on the floor, but " + in_metres(std::abs(above_m)) + (above_m > 0.0 ? " above it" : " below it"));
  }
  /// There must be something to lie on, from head to feet, and nothing in the way of the body.
  template <typename Tell>
  void bed(const PlaceSpec& place, const Tell& doubt) const {
    constexpr double head_m = 0.7, feet_m = 0.8, chest_m = 0.15;  // assumed: of somebody 1.6 m tall
    const auto at = [&](double z, double up) { return place.world_from_place * Vec3(0, up, z); };
    const auto lies_on = [&](double z) { return crossed(at(z, 0.0), at(z, -0.15).y, at(z, 0.1).y) >= 0; };
    if (!lies_on(0.0)) return doubt("in the air", " is in the air: there is nothing to lie on up to 0.15 m below it");
    if (const int wall = pierced(at(head_m, chest_m), at(-feet_m, chest_m)); wall >= 0)
      return doubt("inside",
                   ": '" + this->name(wall) + "' goes through whoever lies there, from the head (+Z) to the feet");
    const std::string end = " of its point: too short, or the point isn't under the pelvis (the head lies towards +Z)";
    if (!lies_on(head_m))
      return doubt("too short", ": nothing is under the head, " + in_metres(head_m) + " to the +Z" + end);
    if (!lies_on(-feet_m))
      return doubt("too short", ": nothing is under the feet, " + in_metres(feet_m) + " to the -Z" + end);
  }
  /// The first mesh that the way from a to b goes through, or -1.
  [[nodiscard]] int pierced(const Vec3& a, const Vec3& b) const {
    for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
      const TriMesh& mesh = scene_.meshes[i];
      for (const auto& [p, q, r] : mesh.triangles) {
        const double share = distance_to_triangle(a, b - a, mesh.positions[p], mesh.positions[q], mesh.positions[r]);
        if (share >= 0.0 && share <= 1.0) return static_cast<int>(i);
      }
    }
    return -1;
  }

  void seat(const SeatSpec& seat, int node) {
    if (!scene_.floor.contains(floor_point(seat.world_from_seat.origin))) {
      tell("off the floor", node, "seat '" + seat.id + "'",
           "seat '" + seat.id + "' lies off the floor: who sits there isn't counted in the column `people`");
    }
    // The trunk stands above the pelvis; a cushion or an arm's rest is lower (assumed).
    const Vec3 hip = seat.world_from_seat.origin;
    if (const int within = crossed(hip, hip.y + 0.15, hip.y + 0.6); within >= 0) {
      tell("inside", node, "seat '" + seat.id + "'",
           "seat '" + seat.id + "' is inside of '" + name(within) + "': the sitter's trunk would pass through it");
      return;
    }
    if (table(seat, -1.0)) return;
    if (const auto behind = table(seat, 1.0); behind && is_deep(seat, *behind) && !is_its_back(seat, *behind)) {
      tell("faces away", node, "seat '" + seat.id + "'",
           "seat '" + seat.id + "' faces away from '" + name(behind->mesh) + "': sitters look along the node's -Z");
    }
  }

  struct Table {
    int mesh;
    double away_m;  ///< from the seat's point
  };
  /// Of what stands before the seat (towards -Z) or behind it.
  [[nodiscard]] std::optional<Table> table(const SeatSpec& seat, double towards_z) const {
    for (const double away_m : {0.35, 0.45, 0.55}) {  // beyond a chair's back, within the arms' reach
      if (const int mesh = table_at(seat, towards_z * away_m); mesh >= 0) return Table{mesh, away_m};
    }
    return std::nullopt;
  }
  /// The mesh at a table's height at z in the seat's frame, or -1.
  [[nodiscard]] int table_at(const SeatSpec& seat, double z) const {
    constexpr double lowest_m = 0.6, highest_m = 0.9;  // above the floor; assumed: of desks and tables to sit at
    const double floor_m = scene_.floor.height_m();
    return crossed(seat.world_from_seat * Vec3(0, 0, z), floor_m + lowest_m, floor_m + highest_m);
  }
  /// Is there room for forearms on it? A sofa's back or a cistern has none.
  [[nodiscard]] bool is_deep(const SeatSpec& seat, const Table& behind) const {
    for (const double more_m : {0.1, 0.2, 0.3}) {  // assumed: of tables to sit at (tried 0.2-0.4)
      if (table_at(seat, behind.away_m + more_m) < 0) return false;
    }
    return true;
  }
  /// Does what the sitter sits on reach back there without a gap? Then that is its back: a sofa's, say.
  [[nodiscard]] bool is_its_back(const SeatSpec& seat, const Table& behind) const {
    constexpr double step_m = 0.05;  // assumed: no gap between a chair and a table is narrower (tried 0.03-0.1)
    constexpr double from_m = 0.1, head_m = 0.6;  // assumed: above feet and carpets, up to the sitter's neck
    const double floor_m = scene_.floor.height_m(), pelvis_m = seat.world_from_seat.origin.y;
    for (double away_m = 0.0; away_m < behind.away_m; away_m += step_m) {
      if (crossed(seat.world_from_seat * Vec3(0, 0, away_m), floor_m + from_m, pelvis_m + head_m) < 0) return false;
    }
    return true;
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
  const Areas areas_ = Areas(scene_);
  const MarkedNodes& nodes_;
  const DoubtSink& tell_;
  std::vector<Box> boxes_;  ///< (n_meshes)
};

}  // namespace

void doubt(const SceneSpec& scene, const MarkedNodes& nodes, const DoubtSink& tell) {
  SceneDoubts(scene, nodes, tell).run();
}

}  // namespace pirsim::io::detail
