#include "sim/plan_people.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "sim/alike.hpp"
#include "sim/check_actions.hpp"

namespace pirsim::sim {
namespace {

/// Height of the table top in front of a seat, or none: what lies under a point half an arm's length ahead.
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

/// Which entrances lead to the floor, of those that were asked for, by who asks: people need more or less room.
using OpenDoors = std::map<std::pair<double, std::string>, bool>;

/// Walks through one person's actions in thought: where are they, where must they get to?
class Rehearsal {
 public:
  Rehearsal(const SceneSpec& scene, const rt::Room& room, PersonModel& person, OpenDoors& doors,
            Diagnostics& diagnostics)
      : scene_(scene), room_(room), person_(person), doors_(doors), diagnostics_(diagnostics) {}

  void run() {
    if (person_.spec.part) rehearse_schedule();
    for (const ScriptedAction& action : person_.spec.actions) {
      if (const auto* appear = std::get_if<action::Appear>(&action.what)) start_at(appear->point, {});
      if (const auto* enter = std::get_if<action::Enter>(&action.what)) {
        start_at(outside(enter->entrance), enter->entrance);
      }
      if (const auto* sit = std::get_if<action::Sit>(&action.what)) {
        sit_down(sit->seat, action.where);
        if (sit->if_taken == action::IfTaken::other_seat) note_other_seats();
      }
      if (const auto* leave = std::get_if<action::Leave>(&action.what)) {
        if (!can_go_to(outside(leave->entrance)) && is_shut(leave->entrance)) continue;
        go_to(outside(leave->entrance), "entrance '" + leave->entrance + "'", action.where);
      }
      if (const auto* walk = std::get_if<action::Walk>(&action.what)) {
        for (const Vec2& point : walk->points) {
          go_to(point, "point " + text(point), action.where, !scene_.floor.contains(point));
        }
      }
    }
  }

 private:
  /// Who follows a schedule may get to any seat that can be reached, and has to reach their own.
  void rehearse_schedule() {
    const ScheduledPerson& part = *person_.spec.part;
    start_at(outside(scene_.entrances.front().id), scene_.entrances.front().id);
    note_other_seats();
    const bool lacks_seat =
        part.part == SchedulePart::guest ? person_.seats.empty() : !part.seat.empty() && !person_.can_use(part.seat);
    if (lacks_seat && !is_shut(behind_)) {
      diagnostics_.error({scene_.name}, "no way leads '" + person_.spec.id + "' of the schedule to " +
                                            (part.seat.empty() ? "any seat" : "seat '" + part.seat + "'"));
    }
  }

  static std::string text(const Vec2& p) {
    const auto round = [](double v) { return std::to_string(v).substr(0, std::to_string(v).find('.') + 3); };
    return "(" + round(p.x) + ", " + round(p.y) + ")";
  }

  Vec2 outside(const std::string& id) const {
    const EntranceSpec& entrance = *std::ranges::find(scene_.entrances, id, &EntranceSpec::id);
    return floor_point(entrance.world_from_entrance * Vec3(0, 0, entrance.outside_m));
  }

  /// entrance: behind which they are, or "".
  void start_at(const Vec2& place, const std::string& entrance) {
    at_ = place;
    behind_ = entrance;
  }

  bool can_go_to(const Vec2& target) const { return person_.floor->find_way(at_, target).has_value(); }

  void go_to(const Vec2& target, const std::string& what, const Where& where, bool is_off_floor = false) {
    if (!can_go_to(target) && !is_shut(behind_)) {
      diagnostics_.error(where, what + " can't be reached by '" + person_.spec.id + "' from " + text(at_) + ": " +
                                    (is_off_floor ? "it lies off the floor" : no_clear_path()));
    }
    start_at(target, {});
  }
  std::string no_clear_path() const {
    return "no path keeps " + std::to_string(person_.humanoid.clearance_radius_m()).substr(0, 4) +
           " m clear of solid objects";
  }

  /// Whether nobody gets from the entrance to the floor, which is then told, once for all.
  bool is_shut(const std::string& id) {
    if (id.empty()) return false;
    const auto [known, is_new] = doors_.try_emplace({person_.floor->clearance_m(), id});
    if (is_new) known->second = leads_in(id);
    if (known->second) return false;
    diagnostics_.error({scene_.name}, "nobody gets from entrance '" + id +
                                          "' to the floor: no path leads in (is it in a wall, behind furniture, or off "
                                          "the floor?)");
    return true;
  }
  bool leads_in(const std::string& id) const {
    constexpr double least_spacing_m = 0.25, most_places = 1000.0;
    const double spacing_m = std::max(least_spacing_m, std::sqrt(scene_.floor.area_m2() / most_places));
    const Vec2 lower = scene_.floor.lower(), upper = scene_.floor.upper(), from = outside(id);
    for (double z = lower.y + 0.5 * spacing_m; z < upper.y; z += spacing_m) {
      for (double x = lower.x + 0.5 * spacing_m; x < upper.x; x += spacing_m) {
        const Vec2 place(x, z);
        if (!scene_.floor.contains(place) || !person_.floor->walkable(place)) continue;
        if (person_.floor->find_way(from, place)) return true;
      }
    }
    return false;
  }

  void sit_down(const std::string& id, const Where& where) {
    const SeatSpec& seat = *std::ranges::find(scene_.seats, id, &SeatSpec::id);
    if (const auto plan = plan_of(seat)) {
      person_.seats.emplace(id, *plan);
      start_at(place_to_stand(seat, *plan), {});
      return;
    }
    person_.seats.emplace(id, SeatPlan{});
    if (is_shut(behind_)) return;
    const bool is_off = !scene_.floor.contains(floor_point(seat.world_from_seat.origin));
    diagnostics_.error(where, "seat '" + id + "' of " + scene_.name + " can't be reached by '" + person_.spec.id +
                                  "' from " + text(at_) + ": " + (is_off ? "it lies off the floor, and " : "") +
                                  "no free place to stand within a metre of it has a path");
  }

  /// Any that can be reached may do if the seat asked for is taken.
  void note_other_seats() {
    for (const SeatSpec& seat : scene_.seats) {
      if (person_.can_use(seat.id)) continue;
      if (const auto plan = plan_of(seat)) person_.seats.emplace(seat.id, *plan);
    }
  }

  static Vec2 place_to_stand(const SeatSpec& seat, const SeatPlan& plan) {
    return floor_point(seat.world_from_seat.origin) -
           plan.stand_back_m * direction_of(heading_of(seat.world_from_seat) + plan.place.approach_turn);
  }

  /// Stands as near to the free fall into the seat as the furniture allows, at most a metre farther back.
  std::optional<SeatPlan> plan_of(const SeatSpec& seat) const {
    const double floor_y = scene_.floor.height_m();
    SeatPlan plan{{seat.world_from_seat, floor_y, table_height(seat, floor_y, room_), 0.0}, 0.0, 0.0};
    // Where a table is near a wall nobody has the room of a walker: they squeeze in.
    // Where a wall is right behind the chair they turn it and sit down from the side.
    for (const double turn : {0.0, 0.5 * pi, -0.5 * pi}) {
      plan.place.approach_turn = turn;
      for (const double half_depth_m : {person_.humanoid.clearance_radius_m(), person_.humanoid.half_depth_m()}) {
        plan.half_depth_m = half_depth_m;
        if (find_place_to_stand(seat, plan)) return plan;
      }
    }
    return std::nullopt;
  }

  bool find_place_to_stand(const SeatSpec& seat, SeatPlan& plan) const {
    const double fall_back = body::fall_back_m(person_.humanoid, plan.place);
    const Vec2 pelvis = floor_point(seat.world_from_seat.origin);
    const Vec2 facing = direction_of(heading_of(seat.world_from_seat) + plan.place.approach_turn);
    constexpr double step_m = 0.02, farthest_m = 1.0;
    for (double back = -fall_back; back <= farthest_m; back += step_m) {
      const Vec2 stand = pelvis - back * facing;
      if (!person_.can_stand(stand, facing, plan.half_depth_m)) continue;
      if (!room_behind(seat, facing, back + fall_back, plan.half_depth_m)) continue;
      if (!person_.floor->find_way(at_, stand)) continue;
      plan.stand_back_m = back;
      return true;
    }
    return false;
  }

  /// Can the pelvis go so far back from the seat, on a chair that is drawn back from the table, before a wall?
  bool room_behind(const SeatSpec& seat, const Vec2& facing, double back_m, double half_depth_m) const {
    constexpr double body_and_chair_m = 0.15;  // assumed, half a body and a chair's back (tried 0.1-0.25)
    const double keep_m = std::min(body_and_chair_m, half_depth_m);
    const Ray behind{Vec3f(seat.world_from_seat.origin),
                     -Vec3f(static_cast<float>(facing.x), 0.0F, static_cast<float>(facing.y))};
    return back_m <= 0.0 || !room_.first_hit(behind, static_cast<float>(back_m + keep_m));
  }

  const SceneSpec& scene_;
  const rt::Room& room_;
  PersonModel& person_;
  OpenDoors& doors_;
  Diagnostics& diagnostics_;
  Vec2 at_{0.0};
  std::string behind_;  ///< the entrance that they haven't come in by yet, or ""
};

using Floors = std::map<double, std::shared_ptr<const body::WalkableFloor>>;  // by clearance

Floors floors_of(const CompiledStudy* like, const SceneSpec& scene) {
  Floors floors;
  if (like == nullptr || !same_ground(like->scene(), scene)) return floors;
  for (const TrialModel& trial : like->trials()) {
    for (const PersonModel& person : trial.people) floors.try_emplace(person.floor->clearance_m(), person.floor);
  }
  return floors;
}

std::vector<TrialModel> plan_among_solids(const CompiledStudy& study, const std::vector<TrialInForce>& trials,
                                          const SceneSpec& scene, const rt::Room& room, Floors floors) {
  std::vector<TrialModel> planned_trials;
  const auto floor_with = [&](double keep_m) -> const std::shared_ptr<const body::WalkableFloor>& {
    auto& floor = floors[keep_m];
    if (floor) return floor;
    try {
      floor = std::make_shared<const body::WalkableFloor>(scene.floor, scene.entrances, scene.meshes, keep_m);
    } catch (const Error& fault) {  // the floor knows no names
      throw Error(fault.code(), Where{scene.name}, fault.issues().front().message);
    }
    return floor;
  };
  OpenDoors doors;
  Diagnostics diagnostics;
  for (const TrialInForce& trial : trials) {
    const std::vector<PersonSpec>& written = study.script_given().trials[planned_trials.size()].people;
    TrialModel& planned = planned_trials.emplace_back();
    planned.id = trial.id;
    planned.duration_s = trial.duration_s;
    planned.schedule = trial.schedule;
    for (const PersonInForce& spec : trial.people) {
      body::Humanoid humanoid(spec);
      double clearance_m = humanoid.clearance_radius_m();
      if (planned.people.size() < written.size()) {
        clearance_m = std::min(clearance_m, body::Humanoid(written[planned.people.size()]).clearance_radius_m());
      }
      const auto rehearse = [&](double keep_m, Diagnostics& found) {
        PersonModel person{.spec = spec,
                           .humanoid = humanoid,
                           .floor = floor_with(keep_m),
                           .radiance = radiance_of(spec.warmth, study.sensing().ambient_c)};
        Rehearsal(scene, room, person, doors, found).run();
        return person;
      };
      Diagnostics found;
      PersonModel person = rehearse(clearance_m, found);
      // Where there is a narrow place on the way, people draw in their arms.
      if (found.has_errors() && humanoid.half_width_m() < clearance_m) {
        person = rehearse(humanoid.half_width_m(), diagnostics);
      } else {
        for (const Issue& issue : found.issues()) diagnostics.error(issue.where, issue.message);
      }
      if (trial.people.size() > 1) {
        person.narrow_floor = floor_with(std::min(person.floor->clearance_m(), humanoid.half_width_m()));
      }
      planned.people.push_back(std::move(person));
    }
  }
  diagnostics.throw_if_errors(ErrorCode::infeasible);
  return planned_trials;
}

}  // namespace

std::vector<TrialModel> plan_people(const CompiledStudy& study, const std::vector<TrialInForce>& trials,
                                    const CompiledStudy* like) {
  const SceneSpec& scene = study.scene();
  check_actions(scene, trials);
  const auto is_screen = [](const TriMesh& mesh) { return mesh.solidity == Solidity::screen; };
  if (std::ranges::none_of(scene.meshes, is_screen)) {
    return plan_among_solids(study, trials, scene, study.array().room(), floors_of(like, scene));
  }
  SceneSpec solid = scene;
  std::erase_if(solid.meshes, is_screen);
  return plan_among_solids(study, trials, solid, rt::Room(solid.meshes), floors_of(like, scene));
}

}  // namespace pirsim::sim
