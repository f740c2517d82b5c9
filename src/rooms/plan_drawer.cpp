// Attempts at a flat that somebody has, and what helps where none is one.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "model/core/text.hpp"
#include "pirsim/flat.hpp"
#include "rooms/flat.hpp"
#include "rooms/flat_layout.hpp"
#include "rooms/floor_plan.hpp"
#include "rooms/recipe_fields.hpp"

namespace pirsim::dataset {
namespace {

/// What the author of a plan could do otherwise.
struct PlanChange {
  std::string text;  ///< "`hinge: left` at door 'bath' (line 14)"
  HomePlanSpec plan;
};

std::string line_of(const Where& where) { return " (line " + std::to_string(where.line) + ")"; }

/// Doors hung and placed otherwise, pieces without their place or left out, rooms that reach to each other, doors that
/// are missing. Those that change least come first, and of equal ones those at the place of the fault.
class PlanChanges {
 public:
  PlanChanges(const HomePlanSpec& plan, const Where& fault) : plan_(plan), fault_(fault) {}

  std::vector<PlanChange> all() {
    for (std::size_t i = 0; i < plan_.doors.size(); ++i) of_door(i);
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
      of_edges(i);
      const auto& pieces = plan_.rooms[i].furniture;
      for (std::size_t k = 0; pieces && k < pieces->size(); ++k) of_piece(i, k);
    }
    for (const PlanRoomSpec& room : plan_.rooms) doors_into(room);
    std::ranges::stable_sort(changes_, {}, [](const Ranked& one) { return std::pair(one.rank, !one.is_there); });
    std::vector<PlanChange> result;
    for (Ranked& one : changes_)
      if (result.size() < most) result.push_back(std::move(one.change));
    return result;
  }

 private:
  static constexpr std::size_t most = 100;  // assumed: some seconds of attempts
  enum Rank { turned, moved, resized, added, left_out };
  struct Ranked {
    PlanChange change;
    Rank rank;
    bool is_there;  ///< where the fault is
  };

  void add(Rank rank, const Where& where, const std::string& text, const auto& change) {
    PlanChange& made = changes_.emplace_back(PlanChange{text, plan_}, rank, where == fault_).change;
    change(made.plan);
  }

  void of_door(std::size_t i) {
    const PlanDoorSpec& door = plan_.doors[i];
    const std::string usual = door.from.empty() ? front_door_name : door.into;
    const std::string name = "door '" + (door.id.empty() ? usual : door.id) + "'" + line_of(door.where);
    for (const DoorHinge hinge : {DoorHinge::left, DoorHinge::right})
      add(turned, door.where, "`hinge: " + std::string(word_of(hinge)) + "` at " + name,
          [&](HomePlanSpec& plan) { plan.doors[i].hinge = hinge; });
    if (!door.from.empty())
      add(moved, door.where,
          "opening " + name + " to the other side (`from: " + door.into + ", into: " + door.from + "`)",
          [&](HomePlanSpec& plan) { std::swap(plan.doors[i].from, plan.doors[i].into); });
    for (auto place : {&PlanDoorSpec::x_m, &PlanDoorSpec::y_m}) {
      if (door.*place)
        add(moved, door.where,
            "leaving out `" + std::string(place == &PlanDoorSpec::x_m ? "x_m" : "y_m") + "` of " + name,
            [&](HomePlanSpec& plan) { plan.doors[i].*place = {}; });
    }
    for (const PlanSide side : all_sides)
      if (door.from.empty())
        add(moved, door.where, "`wall: " + std::string(word_of(side)) + "`, without a place, of " + name,
            [&](HomePlanSpec& plan) { plan.doors[i].wall = side, plan.doors[i].x_m = plan.doors[i].y_m = {}; });
    for (const double width_m : {0.8, 0.7})
      if (width_m < door.width_m)
        add(resized, door.where, "`width_m: " + fixed(width_m, 1) + "` of " + name,
            [&](HomePlanSpec& plan) { plan.doors[i].width_m = width_m; });
  }

  void of_piece(std::size_t i, std::size_t k) {
    const PlanPieceSpec& piece = (*plan_.rooms[i].furniture)[k];
    const std::string name = "the " + std::string(word_of(piece.kind)) + line_of(piece.where);
    const auto change = [&](Rank rank, const std::string& text, const auto& edit) {
      add(rank, piece.where, text, [&](HomePlanSpec& plan) { edit((*plan.rooms[i].furniture)[k]); });
    };
    const auto move_to = [&](const std::optional<PlanSide>& wall, const std::string& text) {
      change(moved, text, [&](PlanPieceSpec& one) { one.wall = wall, one.x_m = one.y_m = {}; });
    };
    if (piece.x_m || piece.y_m) move_to(piece.wall, "leaving out the place of " + name);
    for (const PlanSide side : all_sides)
      if (piece.wall && side != *piece.wall)
        move_to(side, "`wall: " + std::string(word_of(side)) + "`, without a place, of " + name);
    if (piece.wall && piece.width_m)
      change(resized, "leaving out `width_m` of " + name, [&](PlanPieceSpec& one) { one.width_m = {}; });
    add(left_out, piece.where, "leaving out " + name, [&](HomePlanSpec& plan) {
      auto& pieces = *plan.rooms[i].furniture;
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
    });
  }

  /// To where another room's begin or end.
  void of_edges(std::size_t i) {
    constexpr double farthest_m = 0.6;  // assumed: more is meant
    const PlanRoomSpec& room = plan_.rooms[i];
    for (const PlanRoomSpec& other : plan_.rooms) {
      for (auto axis : {&PlanRoomSpec::x_m, &PlanRoomSpec::y_m}) {
        for (auto end : {&Range::least, &Range::most}) {
          for (const double edge : {(other.*axis).least, (other.*axis).most}) {
            Range range = room.*axis;
            if (range.*end == edge || std::abs(range.*end - edge) > farthest_m) continue;
            range.*end = edge;
            if (range.most - range.least < least_m) continue;
            add(resized, room.where,
                "`" + std::string(axis == &PlanRoomSpec::x_m ? "x_m" : "y_m") + ": [" + shortest_number(range.least) +
                    ", " + shortest_number(range.most) + "]` of '" + room.id + "'" + line_of(room.where),
                [&](HomePlanSpec& plan) { plan.rooms[i].*axis = range; });
          }
        }
      }
    }
  }

  void doors_into(const PlanRoomSpec& room) {
    const auto offer = [&](const std::string& from, std::optional<PlanSide> wall, const std::string& text) {
      add(added, room.where, "a door `{" + text + "}`", [&](HomePlanSpec& plan) {
        PlanDoorSpec& door = plan.doors.emplace_back();
        door.from = from, door.into = room.id, door.wall = wall;
      });
    };
    for (const PlanRoomSpec& other : plan_.rooms)
      if (other.id != room.id) offer(other.id, {}, "from: " + other.id + ", into: " + room.id);
    for (const PlanSide side : all_sides) offer({}, side, "into: " + room.id + ", wall: " + std::string(word_of(side)));
  }

  static constexpr double least_m = 0.6;
  const HomePlanSpec& plan_;
  const Where& fault_;
  std::vector<Ranked> changes_;
};

/// What attempts at a plan came to.
struct PlanFault {
  ErrorCode code = ErrorCode::input;
  std::vector<Issue> issues;
};

bool same_issue(const Issue& a, const Issue& b) { return a.where == b.where && a.message == b.message; }

class PlanDrawer {
 public:
  PlanDrawer(const HomePlanSpec& plan, std::uint64_t seed, int number, const io::SceneOptions& options)
      : seed_(seed), number_(number), models_(named(plan), plan.where, options) {}

  /// One that has no fault, or what most attempts lacked.
  std::variant<DrawnFlat, PlanFault> draw(const HomePlanSpec& spec, int most_tries) {
    PlanFault lacking{ErrorCode::infeasible, {}};
    std::vector<int> times;
    const auto note = [&](const Issue& issue) {
      const auto known = std::ranges::find_if(lacking.issues, [&](const Issue& one) { return same_issue(one, issue); });
      const auto i = static_cast<std::size_t>(known - lacking.issues.begin());
      if (known == lacking.issues.end()) lacking.issues.push_back(issue), times.push_back(0);
      ++times[i];
    };
    try {
      const FlatPlan plan = plan_of(spec);
      for (int tries = 1; tries <= most_tries; ++tries) {
        Diagnostics faults;
        Stream stream({seed_, static_cast<std::uint32_t>(number_), static_cast<std::uint32_t>(tries), Purpose::flat});
        auto drawn = furnish_flat(spec, plan, stream, faults);
        faults.throw_if_errors();
        if (const auto* no_place = std::get_if<NoPlace>(&drawn)) {
          note({Severity::error, no_place->where, no_place->reason});
          continue;
        }
        auto& [flat, demands, origins] = std::get<FurnishedFlat>(drawn);
        flat.number = number_;
        flat.tries = tries;
        flat.scene.name = spec.name;
        models_.add_to(flat.scene);
        const std::optional<Issue> fault = unreached(flat.scene, origins);
        if (!fault) return std::move(flat);
        note({Severity::error, fault->where.line > 0 ? fault->where : spec.where, fault->message});
      }
    } catch (const Error& error) {
      if (error.code() != ErrorCode::input) throw;
      return PlanFault{error.code(), error.issues()};
    }
    const auto most = std::ranges::max_element(times) - times.begin();
    lacking.issues = {lacking.issues[static_cast<std::size_t>(most)]};
    return lacking;
  }

 private:
  static std::vector<ModelFinder::Named> named(const HomePlanSpec& plan) {
    std::vector<ModelFinder::Named> models;
    for (const PlanRoomSpec& room : plan.rooms)
      for (const PlanSensorSpec& sensor : room.sensors.value_or(std::vector<PlanSensorSpec>{}))
        models.push_back({{sensor.model}, sensor.where});
    return models;
  }

  std::uint64_t seed_;
  int number_;
  ModelFinder models_;
};

/// The first change of the plan with which this fault is gone, and no other one comes; else the first with which rooms,
/// doors and pieces fit together, and only a way is missing; or nothing.
std::string what_helps(const Issue& issue, const PlanFault& fault, const HomePlanSpec& plan, PlanDrawer& drawer) {
  constexpr int tries_of_changes = 2;
  std::string helps_here;
  for (const PlanChange& change : PlanChanges(plan, issue.where).all()) {
    const auto drawn = drawer.draw(change.plan, tries_of_changes);
    const auto* left = std::get_if<PlanFault>(&drawn);
    const auto is_known = [&](const Issue& other) {
      return !same_issue(other, issue) &&
             std::ranges::any_of(fault.issues, [&](const Issue& one) { return same_issue(one, other); });
    };
    if (left == nullptr || (left->code == fault.code && std::ranges::all_of(left->issues, is_known)))
      return "; " + change.text + " helps";
    if (helps_here.empty() && fault.code == ErrorCode::input && left->code == ErrorCode::infeasible)
      helps_here = "; " + change.text + " helps";
  }
  return helps_here;
}

}  // namespace

DrawnFlat draw_flat(const HomePlanSpec& spec, std::uint64_t seed, int number, const io::SceneOptions& options) {
  constexpr int most_tries_of_plans = 30;  // what has its place stays there
  PlanDrawer drawer(spec, seed, number, options);
  auto drawn = drawer.draw(spec, most_tries_of_plans);
  if (auto* flat = std::get_if<DrawnFlat>(&drawn)) return std::move(*flat);
  const PlanFault& fault = std::get<PlanFault>(drawn);
  std::vector<Issue> issues = fault.issues;
  for (std::size_t i = 0; i < issues.size(); ++i) issues[i].message += what_helps(fault.issues[i], fault, spec, drawer);
  throw Error(fault.code, std::move(issues));
}

}  // namespace pirsim::dataset
