#include "sim/place_access.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "body/lying.hpp"
#include "body/seat_height.hpp"
#include "core/text.hpp"

namespace pirsim::sim {

std::optional<double> table_height(const SeatSpec& seat, double floor_y, const rt::Room& room) {
  constexpr double ahead_m = 0.45;  // assumed: between the elbows and the hands (tried 0.3-0.6)
  constexpr double from_m = 1.3, lowest_m = 0.5, highest_m = 1.1;  // what counts as a table, above the floor
  const Vec3 above = seat.world_from_seat * Vec3(0, 0, -ahead_m);
  const Ray down{Vec3f(static_cast<float>(above.x), static_cast<float>(floor_y + from_m), static_cast<float>(above.z)),
                 Vec3f(0, -1, 0)};
  const auto hit = room.first_hit(down, static_cast<float>(from_m));
  if (!hit) return std::nullopt;
  const double height = from_m - static_cast<double>(hit->distance);
  if (height < lowest_m || height > highest_m) return std::nullopt;
  return floor_y + height;
}

namespace {

constexpr double step_m = 0.02;  ///< between the places that are tried

/// How far before the seat's point one may stand whose calves touch what one sits on, so that the knees still come
/// before its edge.
double deepest_m(const body::Humanoid& person) {
  return person.measures().thigh_m - person.radius_m(body::Part::left_shank) + person.half_depth_m();
}

Vec3f level(const Vec2& direction) { return {static_cast<float>(direction.x), 0.0F, static_cast<float>(direction.y)}; }

}  // namespace

std::optional<SeatPlan> PlaceAccess::plan_of(const SeatSpec& seat) const {
  const double floor_y = scene_.floor.height_m();
  const Frame& frame = seat.world_from_seat;
  if (body::unfit_height(person_.humanoid, {frame, floor_y, {}})) return std::nullopt;
  SeatPlan plan{{frame, floor_y, table_height(seat, floor_y, room_)}};
  const double radius_m = person_.humanoid.clearance_radius_m(), half_depth_m = person_.humanoid.half_depth_m();
  plan.half_depth_m = radius_m;
  if (find_place_behind(frame, plan, -body::fall_back_m(person_.humanoid, plan.place))) return plan;
  plan.half_depth_m = half_depth_m;
  if (find_place_before(frame, plan)) return plan;
  // Where a table is near a wall nobody has the room of a walker: they squeeze in.
  // Where a wall is right behind the chair they turn it and sit down from the side.
  for (const double turn : {0.0, 0.5 * pi, -0.5 * pi}) {
    plan.place.approach_turn = turn;
    for (const double keep_m : {radius_m, half_depth_m}) {
      plan.half_depth_m = keep_m;
      if (find_place_behind(frame, plan, 1.0)) return plan;
    }
  }
  return std::nullopt;
}

/// Calves at the edge; to the side a little, if something stands there.
bool PlaceAccess::find_place_before(const Frame& seat, SeatPlan& plan) const {
  const Vec2 facing = direction_of(heading_of(seat));
  const double fall_back_m = body::fall_back_m(person_.humanoid, plan.place);
  for (const double aside_m : {0.0, 0.1, -0.1, 0.2, -0.2}) {  // assumed: farther is before another seat
    plan.stand_aside_m = aside_m;
    for (double ahead_m = fall_back_m; ahead_m <= deepest_m(person_.humanoid); ahead_m += step_m) {
      plan.stand_back_m = -ahead_m;
      const Vec2 stand = plan.stand(seat);
      if (!person_.can_stand(stand, facing, plan.half_depth_m) || !is_open_before(seat, ahead_m)) continue;
      if (!can_go_to_(stand)) continue;
      plan.place.feet_ahead_m = ahead_m;
      return true;
    }
  }
  plan.stand_aside_m = 0.0;
  return false;
}

/// Up to so far behind the seat, on its axis; that is before it where farthest_m is negative.
bool PlaceAccess::find_place_behind(const Frame& seat, SeatPlan& plan, double farthest_m) const {
  const double fall_back_m = body::fall_back_m(person_.humanoid, plan.place);
  const Vec2 facing = direction_of(heading_of(seat) + plan.place.approach_turn);
  for (double back_m = -fall_back_m; back_m <= farthest_m; back_m += step_m) {
    plan.stand_back_m = back_m;
    const Vec2 stand = plan.stand(seat);
    if (!person_.can_stand(stand, facing, plan.half_depth_m)) continue;
    if (!has_room_behind(seat, facing, back_m + fall_back_m, plan.half_depth_m)) continue;
    if (can_go_to_(stand)) return true;
  }
  return false;
}

/// Nothing stands between the seat and who comes to sit down, at the height of the pelvis and of the chest.
bool PlaceAccess::is_open_before(const Frame& seat, double ahead_m) const {
  constexpr double chest_m = 0.35;  // assumed (0.3-0.4): above the pelvis
  const Vec3f facing = level(direction_of(heading_of(seat)));
  return std::ranges::all_of(std::array{0.0, chest_m}, [&](double up_m) {
    const Ray ahead{Vec3f(seat.origin + Vec3(0, up_m, 0)), facing};
    return !room_.first_hit(ahead, static_cast<float>(ahead_m)).has_value();
  });
}

/// Can the pelvis go so far back from the seat, on a chair that is drawn back from the table, before a wall?
bool PlaceAccess::has_room_behind(const Frame& seat, const Vec2& facing, double back_m, double half_depth_m) const {
  constexpr double body_and_chair_m = 0.15;  // assumed, half a body and a chair's back (tried 0.1-0.25)
  const double keep_m = std::min(body_and_chair_m, half_depth_m);
  const Ray behind{Vec3f(seat.origin), -level(facing)};
  return back_m <= 0.0 || !room_.first_hit(behind, static_cast<float>(back_m + keep_m));
}

std::string PlaceAccess::why_no_place(const SeatSpec& seat) const {
  constexpr double fine_m = 0.01, farthest_m = 1.5;
  const body::Humanoid& who = person_.humanoid;
  const Vec2 pelvis = floor_point(seat.world_from_seat.origin);
  const Vec2 facing = direction_of(heading_of(seat.world_from_seat));
  const double before_m = body::fall_back_m(who, {seat.world_from_seat, scene_.floor.height_m(), {}});
  for (double ahead_m = before_m; ahead_m < farthest_m; ahead_m += fine_m) {
    const Vec2 stand = pelvis + ahead_m * facing;
    if (!person_.can_stand(stand, facing, who.half_depth_m()) || !can_go_to_(stand)) continue;
    const double too_far_m = ahead_m + fine_m - deepest_m(who);  // to be sure of it, whatever the steps of the search
    if (too_far_m <= 0.0 || !is_open_before(seat.world_from_seat, ahead_m)) break;
    return "its point lies " + fixed(ahead_m - who.half_depth_m(), 2) + " m behind the edge of '" +
           scene_.meshes[grounds_.nearest_solid(pelvis + before_m * facing).mesh].name +
           "', farther than thighs reach, and there is no place behind or beside it either; move the point " +
           fixed(std::ceil(too_far_m / fine_m) * fine_m, 2) + " m forward, where one sits nearer to the edge";
  }
  return no_place;
}

/// out_m: from the place's point, the way one faces who sits there.
body::SeatPlace PlaceAccess::edge_of(const PlaceSpec& place, double heading, double out_m) const {
  const Vec2 out = out_m * direction_of(heading);
  const Vec3 up(out.x, body::edge_height_m(person_.humanoid), out.y);
  return {{rotation_from_heading(heading), place.world_from_place.origin + up}, scene_.floor.height_m(), {}};
}

std::optional<LyingPlan> PlaceAccess::plan_to_lie(const PlaceSpec& place) const {
  constexpr double farthest_m = 1.6;  // assumed: the far half of a wide bed, and room to stand
  const double facing_feet = heading_of(place.world_from_place);
  const body::SeatPlace middle = edge_of(place, facing_feet, 0.0);
  if (body::unfit_height(person_.humanoid, middle)) return std::nullopt;
  const double fall_back_m = body::fall_back_m(person_.humanoid, middle), keep_m = person_.humanoid.half_depth_m();
  for (const std::array sides{std::array{0.5 * pi, -0.5 * pi}, std::array{0.0, 0.0}}; const auto& turns : sides) {
    for (double ahead_m = fall_back_m; ahead_m <= farthest_m; ahead_m += step_m) {
      for (const double turn : turns) {
        LyingPlan plan;
        plan.edge.place = edge_of(place, facing_feet + turn, ahead_m - fall_back_m);
        plan.edge.stand_back_m = -fall_back_m;
        plan.edge.half_depth_m = keep_m;
        const Frame& edge = plan.edge.place.world_from_seat;
        const Vec2 stand = plan.edge.stand(edge);
        if (!person_.can_stand(stand, direction_of(heading_of(edge)), keep_m)) continue;
        if (!is_open_before(edge, fall_back_m) || !can_go_to_(stand)) continue;
        plan.bed = {place.world_from_place, plan.edge.place};
        return plan;
      }
    }
  }
  return std::nullopt;
}

std::string PlaceAccess::why_no_edge(const PlaceSpec& place) const {
  if (const auto unfit = body::unfit_height(person_.humanoid, edge_of(place, 0.0, 0.0))) return *unfit;
  return "no path leads to a free place to stand at either side of it or at its foot";
}

}  // namespace pirsim::sim
