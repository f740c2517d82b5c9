// Walls, floor, ceiling, doors and areas of a flat.
#include <algorithm>
#include <string>
#include <vector>

#include "rooms/flat.hpp"
#include "rooms/flat_layout.hpp"
#include "rooms/floor_plan.hpp"
#include "rooms/suggested_floor.hpp"

namespace pirsim::dataset {
namespace {

constexpr double leaf_gap_m = 0.02;

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
    std::vector<Rectangle> all;
    std::map<std::string, std::vector<Rectangle>> of_area;
    for (const FlatRoom& room : plan_.rooms) {
      all.push_back(room.area);
      of_area[room.id].push_back(room.area);
    }
    const double area_m2 =
        std::accumulate(all.begin(), all.end(), 0.0, [](double sum, const Rectangle& r) { return sum + r.area_m2(); });
    constexpr double rounding_m2 = 1e-6;
    if (b.area_m2() - area_m2 < rounding_m2) all = {b};
    scene_.floor = FloorArea(outlines(all), 0.0);
    scene_.meshes.push_back(floor_mesh(all));
    for (const FlatRoom& room : plan_.rooms) {
      if (const auto area = of_area.extract(room.id))
        scene_.areas.push_back({room.id, FloorArea(outlines(area.mapped()), 0.0)});
    }
    constexpr double w = flat_wall_m, half = 0.5 * flat_wall_m;
    add_box("ceiling", {b.lower - Vec2(w), b.upper + Vec2(w)}, height_m_, height_m_ + w);
    for (const PlanSide side : {PlanSide::bottom, PlanSide::top, PlanSide::left, PlanSide::right})
      add_outer_walls(side, all);
    for (const InnerWall& wall : plan_.inner_walls) {
      const bool is_along_x = wall.from.y == wall.to.y;
      const Vec2 thick = is_along_x ? Vec2(0.0, half) : Vec2(half, 0.0);
      add_wall({{wall.from - thick, wall.to + thick}, is_along_x});
    }
    for (const Doorway& door : plan_.doorways) add_door(door);
  }

 private:
  /// Of all of them together; counter-clockwise seen from above.
  static std::vector<std::vector<Vec2>> outlines(const std::vector<Rectangle>& rectangles) {
    const Rectangle& r = rectangles.front();
    if (rectangles.size() == 1) return {{{r.lower.x, r.upper.y}, r.upper, {r.upper.x, r.lower.y}, r.lower}};
    // Traced on a grid whose lines go through all sides.
    std::set<double> xs, zs;
    for (const Rectangle& one : rectangles) {
      xs.insert({one.lower.x, one.upper.x});
      zs.insert({one.lower.y, one.upper.y});
    }
    const std::vector<double> x(xs.begin(), xs.end()), z(zs.begin(), zs.end());
    CellGrid grid({}, {}, 0.0, 1.0, 1);
    grid.n_columns = x.size() - 1, grid.n_rows = z.size() - 1;
    Cells taken(grid.size(), 0);
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const Rectangle cell{{x[i % grid.n_columns], z[i / grid.n_columns]},
                           {x[i % grid.n_columns + 1], z[i / grid.n_columns + 1]}};
      taken[i] = std::ranges::any_of(rectangles, [&](const Rectangle& one) { return overlap(one, cell); }) ? 1 : 0;
    }
    std::vector<std::vector<Vec2>> loops = outlines_of(grid, taken, 0.0);
    for (Vec2& corner : loops | std::views::join)
      corner = {x[static_cast<std::size_t>(corner.x)], z[static_cast<std::size_t>(corner.y)]};
    return loops;
  }

  void add_box(const std::string& name, const Rectangle& area, double from_y, double to_y) {
    const std::array parts{BoxPart{area, from_y, to_y}};
    scene_.meshes.push_back(boxes(name, {}, parts));
  }

  /// Where the floor reaches to that side of the bounds: who enters beside it comes through no wall.
  void add_outer_walls(PlanSide side, const std::vector<Rectangle>& floors) {
    constexpr double w = flat_wall_m, touch_m = 1e-6;
    const bool at_x = runs_along_x(side);
    const Vec2 edge = wall_of(plan_.bounds, side).from;
    const double out = side == PlanSide::bottom || side == PlanSide::right ? w : -w;
    std::vector<std::pair<double, double>> runs;  // from, to
    for (const Rectangle& r : floors) {
      const Vec2 own = wall_of(r, side).from;
      if (at_x && own.y == edge.y) runs.emplace_back(r.lower.x, r.upper.x);
      if (!at_x && own.x == edge.x) runs.emplace_back(r.lower.y, r.upper.y);
    }
    std::ranges::sort(runs);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      auto [from, to] = runs[i];
      while (i + 1 < runs.size() && runs[i + 1].first < to + touch_m) to = runs[++i].second;
      const Vec2 low = at_x ? Vec2(from - w, edge.y) : Vec2(edge.x, from);
      const Vec2 high = at_x ? Vec2(to + w, edge.y + out) : Vec2(edge.x + out, to);
      add_wall({{glm::min(low, high), glm::max(low, high)}, at_x});
    }
  }

  /// In pieces beside and above its doorways.
  void add_wall(const Straight& wall) {
    const std::string name = "wall " + std::to_string(++n_walls_);
    const auto along = [&](const Vec2& p) { return wall.is_along_x ? p.x : p.y; };
    const auto piece = [&](double from, double to) {
      return wall.is_along_x ? Rectangle{{from, wall.area.lower.y}, {to, wall.area.upper.y}}
                             : Rectangle{{wall.area.lower.x, from}, {wall.area.upper.x, to}};
    };
    std::vector<std::pair<double, double>> gaps;  // from, to
    for (const Doorway& door : plan_.doorways) {
      constexpr double touch_m = 1e-6;
      const Vec2 m = door.middle;
      const Rectangle& a = wall.area;
      const bool is_in = m.x > a.lower.x - touch_m && m.x < a.upper.x + touch_m && m.y > a.lower.y - touch_m &&
                         m.y < a.upper.y + touch_m && (door.direction.x == 0.0) == wall.is_along_x;
      if (is_in) gaps.emplace_back(along(m) - 0.5 * door.width_m, along(m) + 0.5 * door.width_m);
    }
    std::ranges::sort(gaps);
    double from = along(wall.area.lower);
    for (const auto& [begin, end] : gaps) {
      add_box(name, piece(from, begin), 0.0, height_m_);
      from = end;
      add_box(name + " above a doorway", piece(begin, end), doorway_height_m, height_m_);
    }
    add_box(name, piece(from, along(wall.area.upper)), 0.0, height_m_);
  }

  void add_door(const Doorway& door) {
    const Frame frame{rotation_from_heading(heading_of(door.direction)), Vec3(door.middle.x, 0.0, door.middle.y)};
    if (!door.from) {
      const std::string which = scene_.entrances.empty() ? "" : '_' + std::to_string(scene_.entrances.size() + 1);
      scene_.entrances.push_back({"entrance" + which, frame, door.width_m, 1.5});
    }
    if (!door.leaf) return;
    DoorSpec leaf;
    leaf.id = door.id;
    leaf.world_from_door = frame;
    leaf.width_m = door.width_m - leaf_gap_m;
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
