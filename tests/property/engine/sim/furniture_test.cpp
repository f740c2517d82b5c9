// Sofas, armchairs, beds and benches wherever they may stand: reached, or refused for a true reason.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/body/seating.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/random_scene.hpp"

using namespace pirsim;

namespace {

constexpr double mm = 1e-3;
constexpr double door_x = 0.8;  ///< of the doorway's middle, in the wall at z = 0

/// A box turned about the vertical: middle, half extents in its own frame, heights.
struct Block {
  std::string name;
  Vec2 middle{0.0}, half{0.0};
  double heading = 0.0, from_y = 0.0, to_y = 0.0;

  [[nodiscard]] Vec2 local(const Vec2& p) const {
    const Vec2 ahead = direction_of(heading), right(-ahead.y, ahead.x), way = p - middle;
    return {glm::dot(way, right), glm::dot(way, ahead)};
  }
  /// Negative inside.
  [[nodiscard]] double distance(const Vec2& p) const {
    const Vec2 q = glm::abs(local(p)) - half;
    return glm::length(glm::max(q, Vec2(0.0))) + std::min(0.0, std::max(q.x, q.y));
  }
  [[nodiscard]] TriMesh mesh() const {
    TriMesh box = testing::box_mesh({-half.x, from_y, -half.y}, {half.x, to_y, half.y});
    for (Vec3& p : box.positions) p = rotation_from_heading(heading) * p + Vec3(middle.x, 0.0, middle.y);
    box.name = name;
    return box;
  }
};

struct Furnished {
  double width_m = 0.0, depth_m = 0.0;
  std::vector<Block> blocks;
  Vec3 seat{0.0};
  double heading = 0.0;
  std::string kind;
};

/// x to the right of the seat's point, z behind it.
void add(Furnished& room, const char* name, const Vec2& x, const Vec2& z, double from_y, double to_y) {
  const Vec2 ahead = direction_of(room.heading), right(-ahead.y, ahead.x);
  const Vec2 middle = floor_point(room.seat) + 0.5 * (x.x + x.y) * right - 0.5 * (z.x + z.y) * ahead;
  room.blocks.push_back({name, middle, {0.5 * (x.y - x.x), 0.5 * (z.y - z.x)}, room.heading, from_y, to_y});
}

/// Against a wall, in a corner or anywhere; half of them before a table or a cupboard.
Furnished furnished(testing::Draw& draw) {
  Furnished room;
  room.width_m = draw.between(2.4, 5.0), room.depth_m = draw.between(2.4, 4.5);
  const auto kind = draw.index(4);
  const double behind_m = kind == 3 ? 0.25 : kind == 2 ? draw.between(0.65, 1.8) : 0.55;
  const Vec2 whole(room.width_m, room.depth_m);
  const auto side = draw.index(4);
  room.heading = 0.5 * pi * side;
  const Vec2 ahead = direction_of(room.heading), right(-ahead.y, ahead.x);
  const double gap_m = draw.index(3) == 0 ? draw.between(0.0, 1.5) : 0.01;
  const double along = draw.index(3) == 0 ? (draw.index(2) == 0 ? -1.0 : 1.0) * draw.between(0.5, 1.0)
                                          : draw.between(-0.6, 0.6);  // corners too
  const Vec2 at = 0.5 * whole - (0.5 * std::abs(glm::dot(whole, ahead)) - behind_m - gap_m) * ahead +
                  along * 0.4 * std::abs(glm::dot(whole, right)) * right;
  if (draw.index(3) == 0) room.heading += draw.between(-0.6, 0.6);
  const double top_m = draw.between(0.38, 0.5), half_m = draw.between(0.35, 1.0);
  room.seat = {at.x, top_m + 0.09, at.y};
  const double front_m = draw.between(0.2, 0.42);
  switch (kind) {
    case 0:
      room.kind = "sofa";
      add(room, "sofa", {-half_m, half_m}, {-front_m, 0.5}, 0.0, top_m);
      add(room, "sofa's back", {-half_m, half_m}, {0.2, 0.5}, 0.0, 0.85);
      break;
    case 1:
      room.kind = "armchair";
      add(room, "armchair", {-0.3, 0.3}, {-front_m, 0.5}, 0.0, top_m);
      add(room, "armchair's back", {-0.45, 0.45}, {0.2, 0.5}, 0.0, 0.95);
      add(room, "left arm", {-0.45, -0.3}, {-front_m, 0.2}, 0.0, 0.62);
      add(room, "right arm", {0.3, 0.45}, {-front_m, 0.2}, 0.0, 0.62);
      break;
    case 2:
      room.kind = "bed";
      add(room, "bed", {-half_m, half_m + 0.4}, {-front_m, behind_m - 0.1}, 0.05, top_m);
      break;
    default:
      room.kind = "bench";
      add(room, "bench", {-half_m, half_m}, {-0.2, 0.2}, 0.0, top_m);
      break;
  }
  if (draw.index(2) == 0) {
    const double away_m = (kind == 3 ? 0.2 : front_m) + draw.between(0.05, 0.9);
    const bool is_table = draw.index(2) == 0;
    const double wide_m = draw.between(0.3, 0.8), aside_m = draw.between(-0.5, 0.5);
    add(room, is_table ? "table" : "cupboard", {aside_m - wide_m, aside_m + wide_m}, {-away_m - 0.5, -away_m},
        is_table ? 0.7 : 0.0, is_table ? 0.75 : 1.8);
  }
  // Walls beside the floor, with a doorway.
  const double w = room.width_m, d = room.depth_m, thick = 0.1;
  const auto wall = [&](const Vec2& low, const Vec2& high) {
    room.blocks.push_back({"wall", 0.5 * (low + high), 0.5 * (high - low), 0.0, 0.0, 2.5});
  };
  wall({-thick, 0.0}, {0.0, d});
  wall({w, 0.0}, {w + thick, d});
  wall({-thick, d}, {w + thick, d + thick});
  wall({-thick, -thick}, {door_x - 0.5, 0.0});
  wall({door_x + 0.5, -thick}, {w + thick, 0.0});
  return room;
}

SceneSpec scene_of(const Furnished& room) {
  SceneSpec scene;
  scene.name = "room";
  for (const Block& block : room.blocks) scene.meshes.push_back(block.mesh());
  scene.seats.push_back({"S", {rotation_from_heading(room.heading), room.seat}});
  scene.entrances.push_back({"door", {rotation_from_heading(pi), {door_x, 0.0, 0.0}}});
  scene.floor = FloorArea({{{0, 0}, {room.width_m, 0}, {room.width_m, room.depth_m}, {0, room.depth_m}}}, 0.0);
  return scene;
}

ScriptSpec script_of(double stature_m) {
  ScriptSpec script;
  script.name = "script";
  PersonSpec person;
  person.id = "who";
  person.stature_m = stature_m;
  person.actions = {
      {action::Enter{"door"}, {}, {}, {}}, {action::Sit{"S"}, {}, {}, {}}, {action::Wait{1.0}, {}, {}, {}}};
  script.trials.push_back({"t", {person}});
  return script;
}

/// Where can somebody stand and from there get onto the seat? On a grid of 2 cm, by distances to boxes.
class BruteForce {
 public:
  /// more_m: room that is wanted beyond what people need; negative: less will do.
  BruteForce(const Furnished& room, const body::Humanoid& person, double more_m)
      : room_(room), person_(person), more_m_(more_m) {}

  [[nodiscard]] bool reaches_seat() {
    for (const double keep_m :
         {person_.clearance_radius_m(), std::min(person_.half_width_m(), person_.clearance_radius_m())}) {
      // Ways are looked for on squares of 0.1 m, which may miss a gap that is just wide enough.
      flood(keep_m + (more_m_ > 0.0 ? 3.0 : 1.0) * more_m_);
      if (from_front() || from_behind()) return true;
    }
    return false;
  }

 private:
  static constexpr double cell_m = 0.02, outside_m = 1.5;

  [[nodiscard]] bool is_solid(const Block& block) const { return block.to_y > 0.1 && block.from_y < 2.0; }
  [[nodiscard]] double room_at(const Vec2& p) const {
    double least = 10.0;
    for (const Block& block : room_.blocks) {
      if (is_solid(block)) least = std::min(least, block.distance(p));
    }
    return least;
  }
  [[nodiscard]] bool on_floor(const Vec2& p) const {
    const bool in_doorway = p.y >= -outside_m && p.y <= 0.0 && std::abs(p.x - door_x) <= 0.45;
    return in_doorway || (p.x >= 0.0 && p.y >= 0.0 && p.x <= room_.width_m && p.y <= room_.depth_m);
  }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }
  [[nodiscard]] Vec2 centre(int column, int row) const {
    return cell_m * Vec2(column + 0.5, row + 0.5) - Vec2(0.0, outside_m);
  }

  void flood(double keep_m) {
    keep_m_ = keep_m;
    columns_ = static_cast<int>(room_.width_m / cell_m), rows_ = static_cast<int>((room_.depth_m + outside_m) / cell_m);
    reached_.assign(static_cast<std::size_t>(columns_ * rows_), 0);
    std::vector<std::pair<int, int>> open;
    const auto visit = [&](int column, int row) {
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_ || reached_[index(column, row)] != 0) return;
      if (!on_floor(centre(column, row)) || room_at(centre(column, row)) < keep_m_) return;
      reached_[index(column, row)] = 1;
      open.emplace_back(column, row);
    };
    visit(static_cast<int>(door_x / cell_m), 0);
    while (!open.empty()) {
      const auto [column, row] = open.back();
      open.pop_back();
      visit(column + 1, row), visit(column - 1, row), visit(column, row + 1), visit(column, row - 1);
    }
  }
  /// By a straight step, at most half a metre long, that brings nobody nearer to anything.
  [[nodiscard]] bool can_get_to(const Vec2& spot) const {
    const int reach = static_cast<int>(0.5 / cell_m);
    const int column = static_cast<int>(spot.x / cell_m), row = static_cast<int>((spot.y + outside_m) / cell_m);
    for (int dz = -reach; dz <= reach; ++dz) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int c = column + dx, r = row + dz;
        if (c < 0 || r < 0 || c >= columns_ || r >= rows_ || reached_[index(c, r)] == 0) continue;
        const Vec2 from = centre(c, r);
        if (glm::distance(from, spot) <= 0.5 - std::max(0.0, more_m_) && leads(from, spot)) return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool leads(const Vec2& from, const Vec2& spot) const {
    return std::ranges::all_of(room_.blocks, [&](const Block& block) {
      if (!is_solid(block)) return true;
      const double keep_m = std::min(keep_m_, block.distance(spot));
      for (double share = 0.0; share <= 1.0; share += 0.1) {
        if (block.distance(from + share * (spot - from)) < keep_m - 5.0 * mm) return false;
      }
      return true;
    });
  }
  /// Nobody has to stand in the doorway.
  [[nodiscard]] bool may_stand(const Vec2& p) const { return on_floor(p) && (more_m_ < 0.0 || p.y > 0.0); }
  [[nodiscard]] bool can_stand(const Vec2& spot, const Vec2& facing, double depth_m) const {
    const double beside_m = person_.clearance_radius_m() - depth_m;
    const Vec2 right(-facing.y, facing.x);
    for (double share = -1.0; share <= 1.0; share += 0.1) {
      const Vec2 p = spot + share * beside_m * right;
      if (!may_stand(p) || room_at(p) < depth_m + more_m_) return false;
    }
    return true;
  }
  /// Does anything stand there at that height?
  [[nodiscard]] bool is_barred(const Vec2& from, const Vec2& to, double height_m) const {
    return std::ranges::any_of(room_.blocks, [&](const Block& block) {
      if (height_m < block.from_y || height_m > block.to_y) return false;
      for (double share = 0.0; share <= 1.0; share += 0.01) {
        if (block.distance(from + share * (to - from)) < 0.0) return true;
      }
      return false;
    });
  }
  [[nodiscard]] body::SeatPlace seat() const { return {{rotation_from_heading(room_.heading), room_.seat}, 0.0, {}}; }

  [[nodiscard]] bool from_front() const {
    const double falls_m = body::fall_back_m(person_, seat());
    const double thigh_m = person_.measures().thigh_m, calf_m = person_.radius_m(body::Part::left_shank);
    const Vec2 ahead = direction_of(room_.heading), right(-ahead.y, ahead.x), pelvis = floor_point(room_.seat);
    constexpr double forward_m = 0.3;  // by which one sits before the point of a seat that is deeper than thighs
    const double farthest_m = thigh_m - calf_m + person_.half_depth_m() + forward_m - more_m_;
    for (double aside_m = -0.2; aside_m <= 0.2001; aside_m += 0.02) {
      if (more_m_ > 0.0 && std::abs(std::remainder(aside_m, 0.1)) > mm) continue;
      for (double away_m = falls_m; away_m <= farthest_m; away_m += 0.01) {
        const Vec2 spot = pelvis + away_m * ahead + aside_m * right;
        if (!can_stand(spot, ahead, person_.half_depth_m()) || !can_get_to(spot)) continue;
        const Vec2 over = pelvis + away_m * ahead;
        if (!is_barred(pelvis, over, room_.seat.y) && !is_barred(pelvis, over, room_.seat.y + 0.35)) return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool from_behind() const {
    const double falls_m = body::fall_back_m(person_, seat());
    const Vec2 pelvis = floor_point(room_.seat);
    for (const double turn : {0.0, 0.5 * pi, -0.5 * pi}) {
      const Vec2 ahead = direction_of(room_.heading + turn);
      for (double back_m = -falls_m; back_m <= 1.0; back_m += 0.01) {
        for (const double depth_m : {person_.clearance_radius_m(), person_.half_depth_m()}) {
          const Vec2 spot = pelvis - back_m * ahead;
          const bool draws_in_arms = depth_m > keep_m_ && may_stand(spot) && room_at(spot) >= keep_m_;
          if (!draws_in_arms && !can_stand(spot, ahead, depth_m)) continue;
          const double drawn_m = back_m + falls_m, keep_m = std::min(0.15, depth_m) + more_m_;
          if (drawn_m > mm && is_barred(pelvis, pelvis - (drawn_m + keep_m) * ahead, room_.seat.y)) continue;
          if (can_get_to(spot)) return true;
        }
      }
    }
    return false;
  }

  const Furnished& room_;
  const body::Humanoid& person_;
  double more_m_, keep_m_ = 0.0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> reached_;
};

/// How deep the ankles and the shins of somebody are inside of a block, metres.
double deepest_shin_m(const body::Humanoid& person, const body::Posture& posture, const std::vector<Block>& blocks) {
  double deepest = -1.0;
  for (const body::Part part : {body::Part::left_shank, body::Part::right_shank}) {
    const double length_m = person.measures().shank_m, radius_m = person.radius_m(part);
    for (double share = -0.5; share <= 0.5; share += 0.1) {
      const Vec3 p = posture[body::at(part)] * Vec3(0, share * length_m, 0);
      for (const Block& block : blocks) {
        if (p.y - radius_m > block.to_y || p.y + radius_m < block.from_y) continue;
        deepest = std::max(deepest, radius_m - std::max(block.distance(floor_point(p)), p.y - block.to_y));
      }
    }
  }
  return deepest;
}

}  // namespace

TEST_CASE("on a sofa that is deeper than thighs are long people sit nearer to its edge, and not in it") {
  for (const double behind_edge_m : {0.30, 0.45, 0.55, 0.75}) {
    for (const double stature_m : {1.55, 1.75, 1.86, 1.95}) {
      INFO(behind_edge_m << " m behind the edge, " << stature_m << " m");
      Furnished room;
      room.width_m = 4.0, room.depth_m = 4.0;
      room.seat = {2.0, 0.53, 3.5};
      add(room, "sofa", {-1.0, 1.0}, {-behind_edge_m, 0.45}, 0.0, 0.42);
      add(room, "sofa's back", {-1.0, 1.0}, {0.2, 0.45}, 0.42, 0.85);
      const ScriptSpec script = script_of(stature_m);
      const body::Humanoid person(script.trials[0].people[0]);
      if (behind_edge_m > 0.6) {
        CHECK_THROWS_AS(compile(scene_of(room), script), Error);
        continue;
      }
      const Model model = compile(scene_of(room), script);
      State state(model, 0);
      double deepest_m = -1.0, before_edge_m = -1.0;
      while (!state.finished()) {
        step_tick(model, state);
        const sim::Actor& who = state.run_state().crowd.actors().front();
        if (!who.present() || who.motion().stage() != body::Stage::seated) continue;
        deepest_m = std::max(deepest_m, deepest_shin_m(person, who.motion().posture(), room.blocks));
        before_edge_m = who.motion().position().y - (room.seat.z - behind_edge_m);
      }
      const double reach_m = person.measures().thigh_m - person.radius_m(body::Part::left_shank);
      CHECK(before_edge_m == Approx(std::min(behind_edge_m, reach_m)).margin(0.045));  // two searches by 2 cm
      CHECK(deepest_m < 0.03);
    }
  }
}

TEST_CASE("200 pieces of furniture to sit on are reached, or refused for a true reason", "[seconds]") {
  int n_reached = 0, n_refused = 0, n_unsure = 0, n_from_front = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    testing::Draw draw(i);
    const Furnished room = furnished(draw);
    const double stature_m = i % 3 == 0 ? draw.between(1.5, 1.95) : 1.75;
    const ScriptSpec script = script_of(stature_m);
    const body::Humanoid person(script.trials[0].people[0]);
    INFO("placement " << i << ": " << room.kind);
    std::string told;
    std::optional<Model> model;
    try {
      model.emplace(compile(scene_of(room), script));
    } catch (const Error& error) {
      told = error.issues().front().message;
    }
    INFO(told);
    constexpr double margin_m = 0.025;  // way-finding works on squares of 0.1 m, and keeps off corners
    const bool surely = BruteForce(room, person, margin_m).reaches_seat();
    const bool perhaps = BruteForce(room, person, -margin_m).reaches_seat();
    if (surely != perhaps) ++n_unsure;
    if (model) CHECK(perhaps);
    if (!model) CHECK_FALSE(surely);
    (model ? n_reached : n_refused) += 1;
    if (!model) continue;
    const sim::SeatPlan& plan = model->compiled().trials()[0].people[0].seat_plan("S");
    if (plan.place.feet_ahead_m == 0.0) continue;
    ++n_from_front;
    State state(*model, 0);
    double deepest_m = -1.0;
    while (!state.finished()) {
      step_tick(*model, state);
      const sim::Actor& who = state.run_state().crowd.actors().front();
      if (!who.present() || who.motion().stage() != body::Stage::seated) continue;
      deepest_m = std::max(deepest_m, deepest_shin_m(person, who.motion().posture(), room.blocks));
    }
    CHECK(deepest_m > -1.0);
    CHECK(deepest_m < 0.03);
  }
  WARN(n_reached << " reached, " << n_from_front << " with the calves at an edge; " << n_refused << " refused; "
                 << n_unsure << " by a hair");
  CHECK(n_reached > 60);
  CHECK(n_from_front > 30);
  CHECK(n_refused > 20);
  CHECK(n_unsure < 50);
}
