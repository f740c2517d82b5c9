#include "engine/sim/plan_people.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "engine/body/seating.hpp"
#include "engine/sim/occupancy.hpp"
#include "engine/sim/pet.hpp"
#include "model/core/text.hpp"
#include "model/schema/actions.hpp"
#include "model/schema/fields.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/error.hpp"

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
/// How far before a seat's point somebody sits whose thighs don't reach from there to the edge.
constexpr double farthest_forward_m = 0.3;  // assumed (0.2-0.4): a lumbar cushion is 0.15

/// How far before the seat's point one may stand whose calves touch what one sits on, so that the knees still come
/// before its edge.
double deepest_m(const body::Humanoid& person) {
  return person.measures().thigh_m - person.radius_m(body::Part::left_shank) + person.half_depth_m();
}

Vec3f level(const Vec2& direction) { return {static_cast<float>(direction.x), 0.0F, static_cast<float>(direction.y)}; }

/// Walks through one person's actions in thought: where are they, where must they get to? Where that can't be done
/// nobody knows where they go on, and what they do until they come in anew isn't judged.
class Rehearsal {
 public:
  Rehearsal(const SceneSpec& scene, const rt::Room& room, PersonModel& person, Grounds& grounds,
            Diagnostics& diagnostics)
      : scene_(scene), room_(room), person_(person), grounds_(grounds), diagnostics_(diagnostics) {}

  /// entrances: that people with a part in a schedule use; none: all of the scene.
  void run(const std::vector<std::string>& entrances) {
    if (person_.spec.part) rehearse_schedule(entrances);
    const std::vector<ScriptedAction>& actions = person_.spec.actions;
    for (std::size_t i = 0; i < actions.size(); ++i) {
      const auto& [what, at_s, phase, where] = actions[i];
      const ActionFacts facts = facts_of(what);
      const bool comes_in = facts.course == ActionFacts::Course::comes && facts.entrance != nullptr;
      if (facts.appears_at != nullptr) come_into_being(*facts.appears_at, where);
      if (facts.course == ActionFacts::Course::comes && facts.place != nullptr) be_at(*facts.place, where);
      if (comes_in) come_in_by(*facts.entrance);
      if (comes_in && !(i + 1 < actions.size() && leads_on(actions[i + 1]))) {
        go_to(inside_of(door_of(*facts.entrance), person_.humanoid),
              "the floor behind entrance '" + *facts.entrance + "'", where);
      }
      if (!at_) continue;
      for (const Vec2& point : facts.walks_to) go_to(point, "point " + text(point), where);
      if (facts.seat != nullptr) sit_down(*facts.seat, where);
      if (facts.place != nullptr && facts.course != ActionFacts::Course::comes) take_place(*facts.place, where);
      if (at_ && facts.if_taken == action::IfTaken::other_seat) note_other_seats();
      if (facts.course == ActionFacts::Course::goes) go_out_by(*facts.entrance, where);
    }
  }

 private:
  /// Who follows a schedule may get to any seat that can be reached, and has to reach their own.
  void rehearse_schedule(const std::vector<std::string>& used) {
    const ScheduledPerson& part = *person_.spec.part;
    for (const EntranceSpec& door : scene_.entrances) {
      if (!used.empty() && std::ranges::find(used, door.id) == used.end()) continue;
      if (is_shut(door.id)) return;
      if (!at_) start_at(outside_of(door), door.id);
    }
    note_other_seats();
    if (part.part == SchedulePart::resident || part.part == SchedulePart::visitor) {
      for (const PlaceSpec& place : scene_.places)
        if (at_) take_place(place.id, {scene_.name});
      return;
    }
    const bool lacks_seat =
        part.part == SchedulePart::guest ? person_.seats.empty() : !part.seat.empty() && !person_.can_use(part.seat);
    if (!lacks_seat || is_shut(behind_)) return;
    if (!part.seat.empty()) return tell_of_seat(seat_of(part.seat), {scene_.name});
    diagnostics_.error({scene_.name}, "no way leads '" + person_.spec.id + "' of the schedule to any seat");
  }

  static std::string text(const Vec2& p) {
    const auto round = [](double v) { return std::to_string(v).substr(0, std::to_string(v).find('.') + 3); };
    return "(" + round(p.x) + ", " + round(p.y) + ")";
  }

  const EntranceSpec& door_of(const std::string& id) const {
    return *std::ranges::find(scene_.entrances, id, &EntranceSpec::id);
  }
  const SeatSpec& seat_of(const std::string& id) const { return *std::ranges::find(scene_.seats, id, &SeatSpec::id); }

  /// entrance: behind which they are, or "".
  void start_at(const Vec2& place, const std::string& entrance) {
    at_ = place;
    behind_ = entrance;
  }
  void fail(const Where& where, const std::string& message) {
    diagnostics_.error(where, message);
    at_.reset();
  }

  /// Somebody stands there who didn't walk there, but has to be able to have done so. Things are where they are.
  void come_into_being(const Vec2& place, const Where& where) {
    start_at(place, {});
    if (person_.spec.changes.role == PersonRole::object) return;
    const double keep_m = person_.humanoid.half_depth_m();
    const Grounds::Near solid = grounds_.nearest_solid(place);
    const std::string who = "'" + person_.spec.id + "' can't appear at " + text(place) + ": ";
    if (solid.away_m <= 0.0) return fail(where, who + within(solid));
    if (solid.away_m < keep_m) return fail(where, who + too_near(solid, keep_m));
    const auto [known, is_new] = grounds_.open_places.try_emplace({person_.floor->clearance_m(), place.x, place.y});
    if (is_new) known->second = is_open(place);
    if (!known->second) fail(where, who + "nobody can get there, for " + no_clear_path());
  }
  /// Does a way lead there from an entrance? Where there are none: is there room to walk around?
  bool is_open(const Vec2& place) const {
    constexpr double least_room_m2 = 4.0;  // assumed: less is a cupboard or a pillar (tried 2-6)
    bool has_door = false;
    for (const EntranceSpec& door : scene_.entrances) {
      if (person_.floor->has_way(outside_of(door), place)) return true;
      has_door = has_door || leads_in(door.id);
    }
    if (has_door) return false;
    const std::vector<Vec2> places = places_to_walk();
    const double area_m2 = spacing_m() * spacing_m() * static_cast<double>(places.size());
    const double wanted_m2 = std::min(least_room_m2, 0.5 * area_m2);
    double reached_m2 = 0.0;
    for (const Vec2& other : places) {
      if (person_.floor->has_way(place, other)) reached_m2 += spacing_m() * spacing_m();
      if (reached_m2 >= wanted_m2) return true;
    }
    return places.empty();
  }

  /// Somebody is at a place who didn't go there, but has to be able to have done so.
  void be_at(const std::string& id, const Where& where) {
    const auto place = std::ranges::find(scene_.places, id, &PlaceSpec::id);
    if (place != scene_.places.end() && place->posture == PlacePosture::stand)
      return come_into_being(floor_point(place->world_from_place.origin), where);
    std::vector<Vec2> from;  // an entrance that leads there, or anywhere that one can walk
    for (const EntranceSpec& door : scene_.entrances) from.push_back(outside_of(door));
    if (std::ranges::none_of(scene_.entrances, [&](const EntranceSpec& door) { return leads_in(door.id); }))
      from = places_to_walk();
    Diagnostics first;
    for (const Vec2& here : from) {
      Diagnostics found;
      Rehearsal from_here(scene_, room_, person_, grounds_, found);
      from_here.start_at(here, {});
      from_here.take_place(id, where);
      if (!found.has_errors()) return start_at(*from_here.at_, {});
      if (!first.has_errors()) first = found;
    }
    for (const Issue& issue : first.issues()) diagnostics_.error(issue.where, issue.message);
    at_.reset();
  }
  void take_place(const std::string& id, const Where& where) {
    const auto place = std::ranges::find(scene_.places, id, &PlaceSpec::id);
    if (place == scene_.places.end()) return sit_down(id, where);
    place->posture == PlacePosture::lie ? lie_down(*place, where) : stand_at(*place, where);
  }
  void lie_down(const PlaceSpec& place, const Where& where) {
    if (const auto plan = access().plan_to_lie(place)) {
      person_.beds.emplace(place.id, *plan);
      return start_at(plan->edge.stand(plan->edge.place.world_from_seat), {});
    }
    if (!is_shut(behind_)) fail(where, name_of(place) + " can't be reached" + by_whom() + access().why_no_edge(place));
    at_.reset();
  }
  void stand_at(const PlaceSpec& place, const Where& where) {
    const Vec2 target = floor_point(place.world_from_place.origin);
    const double keep_m = person_.humanoid.half_depth_m();
    const Grounds::Near solid = grounds_.nearest_solid(target);
    if (solid.away_m >= keep_m || solid.away_m <= 0.0) return go_to(target, name_of(place), where);
    fail(where, name_of(place) + " can't be stood at" + by_whom() + too_near(solid, keep_m));
  }
  std::string name_of(const PlaceSpec& place) const { return "place '" + place.id + "' of " + scene_.name; }
  std::string by_whom() const { return " by '" + person_.spec.id + "' from " + text(*at_) + ": "; }
  [[nodiscard]] std::string name_of(const Grounds::Near& solid) const {
    const std::string& name = scene_.meshes[solid.mesh].name;
    if (name.empty()) return "something solid";
    return name.find('\'') == std::string::npos ? "'" + shortened(name) + "'" : "the " + name;
  }
  [[nodiscard]] std::string too_near(const Grounds::Near& solid, double keep_m) const {
    return name_of(solid) + " is " + fixed(solid.away_m, 2) + " m away, and nobody stands nearer than " +
           fixed(keep_m, 2) + " m";
  }
  [[nodiscard]] std::string within(const Grounds::Near& solid) const { return "it is inside of " + name_of(solid); }

  void come_in_by(const std::string& entrance) {
    start_at(outside_of(door_of(entrance)), entrance);
    if (is_shut(entrance)) at_.reset();
  }
  void go_out_by(const std::string& entrance, const Where& where) {
    const Vec2 target = outside_of(door_of(entrance));
    if (!can_go_to(target) && is_shut(entrance)) return at_.reset();
    go_to(target, "entrance '" + entrance + "'", where);
  }

  bool can_go_to(const Vec2& target) const { return at_ && person_.floor->has_way(*at_, target); }

  void go_to(const Vec2& target, const std::string& what, const Where& where) {
    if (!at_) return;
    const Grounds::Near solid = grounds_.nearest_solid(target);
    const bool is_solid = solid.away_m <= 0.0;
    if (!is_solid && can_go_to(target)) return start_at(target, {});
    if (is_shut(behind_)) return at_.reset();
    const bool is_point = what.starts_with("point");
    fail(where, what + " can't be reached by '" + person_.spec.id + "' from " + text(*at_) + ": " +
                    (is_point && !scene_.floor.contains(target) ? "it lies off the floor"
                     : is_solid                                 ? within(solid)
                                                                : no_clear_path()));
  }
  std::string no_clear_path() const {
    return "no path keeps " + fixed(person_.floor->clearance_m(), 2) + " m clear of solid objects";
  }

  /// Whether nobody gets from the entrance to the floor, which is then told, once for all.
  bool is_shut(const std::string& id) {
    if (id.empty() || leads_in(id)) return false;
    diagnostics_.error({scene_.name}, "nobody gets from entrance '" + id +
                                          "' to the floor: no path leads in (is it in a wall, behind furniture, or off "
                                          "the floor?)");
    return true;
  }
  bool leads_in(const std::string& id) const {
    const auto [known, is_new] = grounds_.open_doors.try_emplace({person_.floor->clearance_m(), id});
    if (is_new) {
      known->second = std::ranges::any_of(
          places_to_walk(), [&](const Vec2& place) { return person_.floor->has_way(outside_of(door_of(id)), place); });
    }
    return known->second;
  }
  double spacing_m() const {
    constexpr double least_m = 0.25, most_places = 1000.0;
    return std::max(least_m, std::sqrt(scene_.floor.area_m2() / most_places));
  }
  /// All over the floor.
  std::vector<Vec2> places_to_walk() const {
    std::vector<Vec2> places;
    const Vec2 lower = scene_.floor.lower(), upper = scene_.floor.upper();
    for (double z = lower.y + 0.5 * spacing_m(); z < upper.y; z += spacing_m()) {
      for (double x = lower.x + 0.5 * spacing_m(); x < upper.x; x += spacing_m()) {
        if (scene_.floor.contains({x, z}) && person_.floor->walkable({x, z})) places.emplace_back(x, z);
      }
    }
    return places;
  }

  void sit_down(const std::string& id, const Where& where) {
    const SeatSpec& seat = seat_of(id);
    if (const auto plan = access().plan_of(seat)) {
      person_.seats.emplace(id, *plan);
      return start_at(plan->stand(plan->place.world_from_seat), {});
    }
    if (!is_shut(behind_)) tell_of_seat(seat, where);
    at_.reset();
  }

  /// Why nobody sits down there.
  void tell_of_seat(const SeatSpec& seat, const Where& where) const {
    const std::string name = "seat '" + seat.id + "' of " + scene_.name;
    const std::string who = by_whom();
    if (const auto unfit = body::unfit_height(person_.humanoid, {seat.world_from_seat, scene_.floor.height_m(), {}})) {
      return diagnostics_.error(where, name + ": " + *unfit);
    }
    if (!scene_.floor.contains(floor_point(seat.world_from_seat.origin))) {
      return diagnostics_.error(
          where, name + " can't be reached" + who + "it lies off the floor, and " + PlaceAccess::no_place);
    }
    diagnostics_.error(where, name + " can't be reached" + who + access().why_no_place(seat));
  }
  /// Any that can be reached may do if the seat asked for is taken.
  void note_other_seats() {
    for (const SeatSpec& seat : scene_.seats) {
      if (person_.can_use(seat.id)) continue;
      if (const auto plan = access().plan_of(seat)) person_.seats.emplace(seat.id, *plan);
    }
  }

  /// From where they are.
  PlaceAccess access() const {
    return {scene_, room_, person_, grounds_, [this](const Vec2& place) { return can_go_to(place); }};
  }

  const SceneSpec& scene_;
  const rt::Room& room_;
  PersonModel& person_;
  Grounds& grounds_;
  Diagnostics& diagnostics_;
  std::optional<Vec2> at_;  ///< nothing where nobody knows
  std::string behind_;      ///< the entrance that they haven't come in by yet, or ""
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

/// People of one size share a map of where they can go.
void require_limit(const SceneSpec& scene, const std::vector<TrialInForce>& trials) {
  std::set<std::pair<double, double>> sizes;
  for (const TrialInForce& trial : trials) {
    for (const PersonInForce& spec : trial.people) sizes.emplace(spec.stature_m, spec.mass_kg);
  }
  const Vec2 squares = (scene.floor.upper() - scene.floor.lower()) / body::WalkableFloor::cell_m;
  const auto n_sizes = static_cast<double>(sizes.size());
  if (n_sizes <= 1.0 || n_sizes * squares.x * squares.y <= static_cast<double>(limits::way_squares)) return;
  throw Error(ErrorCode::infeasible, Where{scene.name},
              "people of " + std::to_string(sizes.size()) + " sizes (stature_m, mass_kg) need maps of this floor of " +
                  "more than " + std::to_string(limits::way_squares) + " squares of 0.1 m: give fewer sizes");
}

std::vector<std::string> entrances_used(const TrialInForce& trial) {
  if (trial.occupancy) return trial.occupancy->entrances;
  return trial.schedule ? trial.schedule->entrances : std::vector<std::string>{};
}

body::Humanoid body_of(const PersonInForce& spec) {
  return spec.pet ? body::Humanoid(*spec.pet) : body::Humanoid(spec);
}

double widest_clearance_m(const std::vector<TrialInForce>& trials) {
  double widest_m = 0.0;
  for (const TrialInForce& trial : trials) {
    for (const PersonInForce& spec : trial.people) widest_m = std::max(widest_m, body_of(spec).clearance_radius_m());
  }
  return widest_m;
}

std::vector<TrialModel> plan_among_solids(const CompiledStudy& study, const std::vector<TrialInForce>& trials,
                                          const SceneSpec& scene, const rt::Room& room, Floors floors) {
  std::vector<TrialModel> planned_trials;
  std::optional<body::Ground> ground;
  const auto floor_with = [&](double keep_m) -> const std::shared_ptr<const body::WalkableFloor>& {
    auto& floor = floors[keep_m];
    if (floor) return floor;
    try {
      if (!ground) ground.emplace(scene.floor, scene.entrances, scene.meshes, widest_clearance_m(trials));
      floor = std::make_shared<const body::WalkableFloor>(*ground, keep_m);
    } catch (const Error& fault) {  // the floor knows no names
      throw Error(fault.code(), Where{scene.name}, fault.issues().front().message);
    }
    return floor;
  };
  Grounds grounds(scene);
  Diagnostics diagnostics;
  for (const TrialInForce& trial : trials) {
    const std::vector<PersonSpec>& written = study.script_given().trials[planned_trials.size()].people;
    TrialModel& planned = planned_trials.emplace_back(
        TrialModel{trial.id, {}, trial.duration_s, trial.schedule, trial.clock, trial.begins_s, trial.occupancy});
    const auto n_people = std::ranges::count_if(trial.people, [](const PersonInForce& spec) { return !spec.pet; });
    for (const PersonInForce& spec : trial.people) {
      const body::Humanoid humanoid = body_of(spec);
      if (spec.pet) {
        const auto& floor = floor_with(humanoid.clearance_radius_m());
        const std::optional<Haunts> haunts = haunts_of(*spec.pet, scene, *floor);
        if (!haunts) diagnostics.error(spec.pet->where, "pet '" + spec.id + "' finds no way about " + scene.name);
        planned.people.push_back({.spec = spec,
                                  .humanoid = humanoid,
                                  .floor = floor,
                                  .radiance = radiance_of(spec, study.sensing().ambient_c),
                                  .haunts = haunts.value_or(Haunts{})});
        continue;
      }
      double clearance_m = humanoid.clearance_radius_m();
      if (planned.people.size() < written.size()) {
        clearance_m = std::min(clearance_m, body::Humanoid(written[planned.people.size()]).clearance_radius_m());
      }
      const auto rehearse = [&](double keep_m, Diagnostics& found) {
        PersonModel person{.spec = spec,
                           .humanoid = humanoid,
                           .floor = floor_with(keep_m),
                           .radiance = radiance_of(spec, study.sensing().ambient_c)};
        Rehearsal(scene, room, person, grounds, found).run(entrances_used(trial));
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
      if (n_people > 1) {
        person.narrow_floor = floor_with(std::min(person.floor->clearance_m(), humanoid.half_width_m()));
      }
      planned.people.push_back(std::move(person));
    }
    if (planned.occupancy && !diagnostics.has_errors()) plan_occupancy(planned, scene, diagnostics);
  }
  diagnostics.throw_if_errors(ErrorCode::infeasible);
  return planned_trials;
}

/// The open leaf as walkers go round it.
TriMesh leaf_with_room(const DoorLeaf& leaf) {
  constexpr double room_m = 0.08;  // assumed: so far arms swing beyond what walkers keep clear (0.04-0.08)
  TriMesh mesh = leaf.open_mesh();
  mesh.name = "open " + mesh.name;
  const Frame frame = leaf.frame_at(leaf.open_step()), leaf_from_world = inverse(frame);
  for (Vec3& corner : mesh.positions) {
    Vec3 local = leaf_from_world * corner;
    local.x += local.x < 0.0 ? -room_m : room_m;  // at its end; at the hinge into the wall
    local.z += local.z < 0.0 ? -room_m : room_m;
    corner = frame * local;
  }
  return mesh;
}

// Structured bindings name every field, so that a new one doesn't compile until it stands here.
auto fields(const FidgetSpec& fidgeting) {
  const auto& [rate_per_s, tilt_deg, turn_deg, timing] = fidgeting;
  return std::tie(rate_per_s, tilt_deg, turn_deg, timing);
}
auto fields(const SwingSpec& swing) {
  const auto& [amplitude_deg, period_s, share] = swing;
  return std::tie(amplitude_deg, period_s, share);
}
auto fields(const UnevenArmsSpec& arms) {
  const auto& [spread, pause_share] = arms;
  return std::tie(spread, pause_share);
}

/// The body isn't compared here: it is compared as the person's own.
bool same_part(const std::optional<ScheduledPerson>& a, const std::optional<ScheduledPerson>& b) {
  const auto fields_of = [](const ScheduledPerson& scheduled) {
    const auto& [part, role, seat, person, room] = scheduled;
    return std::tie(part, role, seat, room);
  };
  return a && b ? fields_of(*a) == fields_of(*b) : a.has_value() == b.has_value();
}

/// What effects change of a person.
auto fields(const PersonChanges& changes) {
  const auto& [seat_shift_m, fidgeting, trunk_sway, chair_swing, uneven_arms, role] = changes;
  return std::tuple_cat(std::tie(seat_shift_m, role), fields(fidgeting), fields(trunk_sway), fields(chair_swing),
                        fields(uneven_arms));
}

bool same_person(const PersonInForce& a, const PersonInForce& b) {
  const bool same_pet = a.pet && b.pet ? same(*a.pet, *b.pet) : a.pet.has_value() == b.pet.has_value();
  return same<PersonSpec>(a, b) && fields(a.changes) == fields(b.changes) && same_part(a.part, b.part) && same_pet;
}

std::vector<const TriMesh*> solids(const SceneSpec& scene) {
  std::vector<const TriMesh*> meshes;
  for (const TriMesh& mesh : scene.meshes) {
    if (mesh.solidity == Solidity::solid) meshes.push_back(&mesh);
  }
  return meshes;
}

/// Clearances are kept as the script is written.
bool same_size(const PersonSpec& a, const PersonSpec& b) {
  return a.stature_m == b.stature_m && a.mass_kg == b.mass_kg;
}

/// What people move by of it: of the rest only sensors know.
auto clock(const SensingInForce& sensing) { return std::tie(sensing.tick_rate_hz, sensing.ticks_per_window); }

/// Places to stand follow from the ground, which is compared by itself.
bool same_counts(const std::optional<OccupancyInForce>& a, const std::optional<OccupancyInForce>& b) {
  const auto fields_of = [](const OccupancyInForce& occupancy) {
    const auto& [counts, changes_within_s, seats, entrances, where, standing] = occupancy;
    return std::tie(changes_within_s, seats, entrances);
  };
  return a && b ? same(a->counts, b->counts) && fields_of(*a) == fields_of(*b) : a.has_value() == b.has_value();
}

bool same_trial(const TrialModel& planned, const TrialInForce& trial, double ambient_c) {
  const auto& [id, people, duration_s, schedule, run_clock, begins_s, occupancy] = trial;
  return planned.id == id && planned.duration_s == duration_s && same(planned.schedule, schedule) &&
         planned.clock == run_clock && planned.begins_s == begins_s && same_counts(planned.occupancy, occupancy) &&
         std::ranges::equal(planned.people, people, [&](const PersonModel& a, const PersonInForce& b) {
           return same_person(a.spec, b) && a.radiance == radiance_of(b, ambient_c);
         });
}

using Course = ActionFacts::Course;
using Needs = ActionFacts::Needs;
using Pose = ActionFacts::Pose;

template <typename Spec>
void check_name(const std::vector<Spec>& known, const std::string& id, const std::string& kind, const SceneSpec& scene,
                const Where& where, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const Spec& spec : known) names.push_back(spec.id);
  if (std::ranges::find(names, id) != names.end()) return;
  diagnostics.error(where, kind + " '" + id + "' is not in " + scene.name + near_or_all(id, names));
}

/// Follows one person from action to action.
class Check {
 public:
  Check(const SceneSpec& scene, const PersonSpec& person, const std::optional<RunClock>& clock,
        Diagnostics& diagnostics)
      : scene_(scene), person_(person), clock_(clock), diagnostics_(diagnostics) {}

  void operator()(const ScriptedAction& action) {
    if (action.at_s) {
      if (*action.at_s < last_at_s_) {
        fault(action, "starts at " + moment_text(clock_, *action.at_s) +
                          ", before an action that is written above it and starts at " +
                          moment_text(clock_, last_at_s_) + ": time runs backwards");
      }
      last_at_s_ = *action.at_s;
    }
    const ActionFacts facts = facts_of(action.what);
    if (facts.course == Course::comes || facts.course == Course::passes) arrive(action);
    if (facts.needs != Needs::nothing) need_presence(action);
    if (facts.appears_at != nullptr && !scene_.floor.contains(*facts.appears_at)) {
      fault(action, "appears outside the floor area");
    }
    if (facts.entrance != nullptr) {
      check_name(scene_.entrances, *facts.entrance, "entrance", scene_, action.where, diagnostics_);
    }
    if (const std::string* place = facts.takes()) check_place(action, facts, *place);
    if (facts.needs == Needs::seat && pose_ != Pose::seated)
      fault(action, std::string(facts.name) + "s without having sat down");
    if (facts.needs == Needs::rest && pose_ == Pose::upright)
      fault(action, std::string(facts.name) + "s without having sat down");
    if (facts.course == Course::goes || facts.course == Course::passes) present_ = false;
    const bool comes_in_on_foot = facts.course == Course::comes && facts.place == nullptr;
    if (!comes_in_on_foot && facts.pose != Pose::kept) pose_ = pose_after(facts);
  }

 private:
  [[nodiscard]] const PlaceSpec* place_of(const std::string& id) const {
    const auto place = std::ranges::find(scene_.places, id, &PlaceSpec::id);
    return place == scene_.places.end() ? nullptr : &*place;
  }
  [[nodiscard]] bool is_seat(const std::string& id) const {
    return std::ranges::find(scene_.seats, id, &SeatSpec::id) != scene_.seats.end();
  }
  [[nodiscard]] Pose pose_after(const ActionFacts& facts) const {
    if (facts.pose != Pose::of_place) return facts.pose;
    const PlaceSpec* place = place_of(*facts.place);
    if (place == nullptr) return Pose::seated;
    return place->posture == PlacePosture::lie ? Pose::lying : Pose::upright;
  }
  /// Is there such a place, and is it one for this action?
  void check_place(const ScriptedAction& action, const ActionFacts& facts, const std::string& id) {
    const PlaceSpec* place = place_of(id);
    const bool seat = is_seat(id);
    if (place == nullptr && !seat) {
      if (facts.seat != nullptr) return check_name(scene_.seats, id, "seat", scene_, action.where, diagnostics_);
      std::vector<std::string> known;
      for (const PlaceSpec& other : scene_.places) known.push_back(other.id);
      for (const SeatSpec& other : scene_.seats) known.push_back(other.id);
      return diagnostics_.error(action.where, "place '" + id + "' is not in " + scene_.name + near_or_all(id, known));
    }
    const char* verb = seat ? "sit" : place->posture == PlacePosture::lie ? "lie" : "stand";
    if (facts.pose != Pose::of_place && facts.name != verb) {
      diagnostics_.error(action.where, "'" + id + "' is a place to " + verb + ": `" + verb + ": " + id + "`");
    }
  }
  void fault(const ScriptedAction& action, const std::string& what) {
    diagnostics_.error(action.where, "'" + person_.id + "' " + what);
  }
  void arrive(const ScriptedAction& action) {
    if (present_) fault(action, "is in the room already");
    present_ = true;
  }
  void need_presence(const ScriptedAction& action) {
    if (!present_) fault(action, "is not in the room yet: let them `enter` or `appear` first");
    present_ = true;  // one message is enough
  }

  const SceneSpec& scene_;
  const PersonSpec& person_;
  const std::optional<RunClock>& clock_;
  Diagnostics& diagnostics_;
  double last_at_s_ = 0.0;
  bool present_ = false;
  Pose pose_ = Pose::upright;
};

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
  plan.place.approach_turn = 0.0;
  for (double forward_m = step_m; forward_m <= farthest_forward_m; forward_m += step_m) {
    plan.place.world_from_seat.origin = frame.origin + forward_m * frame.forward();
    if (find_place_before(plan.place.world_from_seat, plan)) return plan;
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
    // To be sure of it, whatever the steps of the search.
    const double too_far_m = ahead_m + fine_m - deepest_m(who) - farthest_forward_m + step_m;
    if (too_far_m <= 0.0 || !is_open_before(seat.world_from_seat, ahead_m)) break;
    return "its point lies " + fixed(ahead_m - who.half_depth_m(), 2) + " m behind the edge of '" +
           scene_.meshes[grounds_.nearest_solid(pelvis + before_m * facing).mesh].name +
           "', farther than anybody sits from an edge, and there is no place behind or beside it either; move the "
           "point " +
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

std::vector<TrialModel> plan_people(const CompiledStudy& study, const std::vector<TrialInForce>& trials,
                                    const CompiledStudy* like) {
  const SceneSpec& scene = study.scene();
  check_actions(scene, trials);
  require_limit(scene, trials);
  const auto is_screen = [](const TriMesh& mesh) { return mesh.solidity == Solidity::screen; };
  const bool has_screens = std::ranges::any_of(scene.meshes, is_screen);
  if (!has_screens && scene.doors.empty()) {
    return plan_among_solids(study, trials, scene, study.array().room(), floors_of(like, scene));
  }
  SceneSpec solid = scene;
  std::erase_if(solid.meshes, is_screen);
  const rt::Room room(solid.meshes);
  // Ways lead through shut doors and round open leaves, so that one is never where somebody goes.
  for (const DoorLeaf& leaf : study.array().leaves()) solid.meshes.push_back(leaf_with_room(leaf));
  return plan_among_solids(study, trials, solid, room, floors_of(like, scene));
}

bool same_meshes(const SceneSpec& a, const SceneSpec& b) {
  return std::ranges::equal(a.meshes, b.meshes, same<TriMesh>);
}

bool same_ground(const SceneSpec& a, const SceneSpec& b) {
  return a.floor == b.floor && std::ranges::equal(a.entrances, b.entrances, same<EntranceSpec>) &&
         std::ranges::equal(a.doors, b.doors, same<DoorSpec>) &&
         std::ranges::equal(solids(a), solids(b), [](const TriMesh* x, const TriMesh* y) { return same(*x, *y); });
}

bool same_people(const CompiledStudy& like, const CompiledStudy& study, const std::vector<TrialInForce>& trials) {
  const auto same_sizes = [](const TrialSpec& a, const TrialSpec& b) {
    return std::ranges::equal(a.people, b.people, same_size);
  };
  const SensingInForce &a = like.sensing(), &b = study.sensing();
  return like.seed() == study.seed() && clock(a) == clock(b) && same_ground(like.scene(), study.scene()) &&
         std::ranges::equal(like.scene().seats, study.scene().seats, same<SeatSpec>) &&
         std::ranges::equal(like.scene().places, study.scene().places, same<PlaceSpec>) &&
         std::ranges::equal(like.script_given().trials, study.script_given().trials, same_sizes) &&
         std::ranges::equal(like.trials(), trials, [&](const TrialModel& planned, const TrialInForce& trial) {
           return same_trial(planned, trial, b.ambient_c);
         });
}

void check_actions(const SceneSpec& scene, const std::vector<TrialInForce>& trials) {
  Diagnostics diagnostics;
  std::set<std::string> told;  // trials repeat the same actions: say each thing once
  for (const TrialInForce& trial : trials) {
    for (const PersonInForce& person : trial.people) {
      Diagnostics found;
      Check check(scene, person, trial.clock, found);
      for (const ScriptedAction& action : person.actions) check(action);
      for (const Issue& issue : found.issues()) {
        if (told.insert(to_string(issue)).second) diagnostics.error(issue.where, issue.message);
      }
    }
  }
  diagnostics.throw_if_errors();
}

}  // namespace pirsim::sim
