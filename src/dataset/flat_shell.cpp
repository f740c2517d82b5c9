#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "dataset/flat_furnish.hpp"
#include "dataset/flat_names.hpp"

namespace pirsim::dataset {
namespace {

constexpr double leaf_m = doorway_m - 0.02;

/// A wall seen from above, along x or along z, with gaps from its lower end on.
struct Straight {
  Rectangle area;
  bool is_along_x = true;
};

class Shell {
 public:
  Shell(const FlatPlan& plan, double height_m, SceneSpec& scene) : plan_(plan), height_m_(height_m), scene_(scene) {}

  void build() {
    const Rectangle& b = plan_.bounds;
    scene_.floor = FloorArea({outline(b)}, 0.0);
    scene_.meshes.push_back(floor_mesh({b}));
    for (const FlatRoom& room : plan_.rooms) scene_.areas.push_back({room.id, FloorArea({outline(room.area)}, 0.0)});
    constexpr double w = flat_wall_m, half = 0.5 * flat_wall_m;
    add_box("ceiling", {b.lower - Vec2(w), b.upper + Vec2(w)}, height_m_, height_m_ + w);
    add_wall({{{b.lower.x - w, b.upper.y}, {b.upper.x + w, b.upper.y + w}}, true});
    add_wall({{{b.lower.x - w, b.lower.y - w}, {b.upper.x + w, b.lower.y}}, true});
    add_wall({{{b.lower.x - w, b.lower.y}, {b.lower.x, b.upper.y}}, false});
    add_wall({{{b.upper.x, b.lower.y}, {b.upper.x + w, b.upper.y}}, false});
    for (const InnerWall& wall : plan_.inner_walls) {
      const bool is_along_x = wall.from.y == wall.to.y;
      const Vec2 thick = is_along_x ? Vec2(0.0, half) : Vec2(half, 0.0);
      add_wall({{wall.from - thick, wall.to + thick}, is_along_x});
    }
    for (const Doorway& door : plan_.doorways) add_door(door);
  }

 private:
  /// Counter-clockwise seen from above.
  static std::vector<Vec2> outline(const Rectangle& r) {
    return {{r.lower.x, r.upper.y}, r.upper, {r.upper.x, r.lower.y}, r.lower};
  }

  void add_box(const std::string& name, const Rectangle& area, double from_y, double to_y) {
    const std::array parts{BoxPart{area, from_y, to_y}};
    scene_.meshes.push_back(boxes(name, {}, parts));
  }

  /// In pieces beside and above its doorways.
  void add_wall(const Straight& wall) {
    const std::string name = "wall " + std::to_string(++n_walls_);
    const auto along = [&](const Vec2& p) { return wall.is_along_x ? p.x : p.y; };
    const auto piece = [&](double from, double to) {
      return wall.is_along_x ? Rectangle{{from, wall.area.lower.y}, {to, wall.area.upper.y}}
                             : Rectangle{{wall.area.lower.x, from}, {wall.area.upper.x, to}};
    };
    std::vector<double> gaps;
    for (const Doorway& door : plan_.doorways) {
      constexpr double touch_m = 1e-6;
      const Vec2 m = door.middle;
      const Rectangle& a = wall.area;
      const bool is_in = m.x > a.lower.x - touch_m && m.x < a.upper.x + touch_m && m.y > a.lower.y - touch_m &&
                         m.y < a.upper.y + touch_m && (door.direction.x == 0.0) == wall.is_along_x;
      if (is_in) gaps.push_back(along(m));
    }
    std::ranges::sort(gaps);
    double from = along(wall.area.lower);
    for (const double gap : gaps) {
      add_box(name, piece(from, gap - 0.5 * doorway_m), 0.0, height_m_);
      from = gap + 0.5 * doorway_m;
      add_box(name + " above a doorway", piece(gap - 0.5 * doorway_m, from), doorway_height_m, height_m_);
    }
    add_box(name, piece(from, along(wall.area.upper)), 0.0, height_m_);
  }

  void add_door(const Doorway& door) {
    const Frame frame{rotation_from_heading(heading_of(door.direction)), Vec3(door.middle.x, 0.0, door.middle.y)};
    if (!door.from) scene_.entrances.push_back({"entrance", frame, doorway_m, 1.5});
    if (!door.leaf) return;
    DoorSpec leaf;
    leaf.id = door.from ? plan_.rooms[door.into].id : front_door_name;
    leaf.world_from_door = frame;
    leaf.width_m = leaf_m;
    leaf.hinge = door.hinge;
    leaf.state = *door.leaf;
    scene_.doors.push_back(leaf);
  }

  const FlatPlan& plan_;
  double height_m_;
  SceneSpec& scene_;
  int n_walls_ = 0;
};

}  // namespace

void build_shell(const FlatPlan& plan, double height_m, SceneSpec& scene) { Shell(plan, height_m, scene).build(); }

}  // namespace pirsim::dataset
