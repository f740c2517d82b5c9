#include "sim/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/text.hpp"
#include "pirsim/geometry.hpp"
#include "schema/areas.hpp"
#include "sim/actor.hpp"
#include "sim/count_draw.hpp"
#include "sim/day_draw.hpp"
#include "sim/plan_people.hpp"
#include "sim/standing_places.hpp"

namespace pirsim::sim {
namespace {

constexpr double until_next_s = 1e6;  ///< of an action that only the next one ends

bool is_occupant(const PersonModel& person) {
  return person.spec.part && person.spec.part->part == SchedulePart::occupant;
}

/// That all of these people can use.
std::vector<std::string> shared_seats(const TrialModel& trial) {
  std::vector<std::string> seats = trial.occupancy->seats;
  std::erase_if(seats, [&](const std::string& seat) {
    return std::ranges::any_of(trial.people,
                               [&](const PersonModel& person) { return is_occupant(person) && !person.can_use(seat); });
  });
  return seats;
}

/// Parts of the floor whose people are counted by themselves: the counts' areas, then what is in none of these.
class CountedParts {
 public:
  CountedParts(const CountsSpec& counts, const Areas& areas) : counts_(counts), areas_(areas) {}

  [[nodiscard]] std::size_t size() const { return counts_.areas.size() + 1; }
  [[nodiscard]] std::size_t at(const Vec2& place) const {
    const std::string_view area = areas_.name_at(place);
    const auto part = std::ranges::find(counts_.areas, area, &AreaCountsSpec::area);
    return static_cast<std::size_t>(part - counts_.areas.begin());
  }
  /// (n_times)
  [[nodiscard]] std::vector<int> people(std::size_t part) const {
    if (part < counts_.areas.size()) return counts_.areas[part].people;
    std::vector<int> rest = counts_.people;
    for (const AreaCountsSpec& area : counts_.areas)
      std::ranges::transform(rest, area.people, rest.begin(), std::minus<>());
    return rest;
  }
  /// For messages.
  [[nodiscard]] std::string name(std::size_t part, const SceneSpec& scene) const {
    if (counts_.areas.empty()) return scene.name;
    return part < counts_.areas.size() ? "area '" + counts_.areas[part].area + "'" : "the rest of " + scene.name;
  }

 private:
  const CountsSpec& counts_;
  const Areas& areas_;
};

/// Places as a CountedVisit numbers them: seats, then where one stands.
struct Places {
  std::vector<std::string> seats;
  std::vector<Vec2> standing;
  std::vector<std::size_t> parts{};  ///< (n_places) of the floor, that each is in
  [[nodiscard]] bool is_seat(std::size_t place) const { return place < seats.size(); }
};

Places places_of(const TrialModel& trial, const SceneSpec& scene, const CountedParts& parts) {
  Places places{shared_seats(trial), trial.occupancy->standing};
  for (const std::string& id : places.seats) {
    const SeatSpec& seat = *std::ranges::find(scene.seats, id, &SeatSpec::id);
    places.parts.push_back(parts.at(floor_point(seat.world_from_seat.origin)));
  }
  for (const Vec2& point : places.standing) places.parts.push_back(parts.at(point));
  return places;
}

ScriptedAction timed(Action what, double at_s) {
  ScriptedAction action;
  action.what = std::move(what);
  action.at_s = at_s;
  return action;
}
ScriptedAction untimed(Action what) {
  ScriptedAction action;
  action.what = std::move(what);
  return action;
}

/// Puts the visits of a run into a room.
class Visits {
 public:
  Visits(const CompiledStudy& study, std::uint32_t run)
      : study_(study),
        run_(run),
        trial_(study.trial_of(run)),
        occupancy_(*trial_.occupancy),
        parts_(occupancy_.counts, study.areas()),
        places_(places_of(trial_, study.scene(), parts_)),
        free_s_(trial_.people.size(), 0.0) {
    for (std::size_t i = 0; i < trial_.people.size(); ++i) {
      if (is_occupant(trial_.people[i])) occupants_.push_back(i);
    }
  }

  DayPlan plan() {
    DayPlan plan;
    for (const PersonModel& person : trial_.people)
      plan.push_back(is_occupant(person) ? std::vector<ScriptedAction>{} : person.spec.actions);
    std::map<std::size_t, Stream> streams;
    for (const CountedVisit& visit : draw_visits(source())) {
      const std::size_t person = occupants_[visit.person];
      const StreamKey key{study_.seed(), run_, static_cast<std::uint32_t>(person), Purpose::occupancy_conduct};
      add(visit, person, streams.try_emplace(person, key).first->second, plan[person]);
    }
    return plan;
  }

 private:
  [[nodiscard]] CountSource source() const {
    CountSource source{.times_s = occupancy_.counts.times_s};
    for (std::size_t part = 0; part < parts_.size(); ++part) source.people.push_back(parts_.people(part));
    source.begin_s = study_.data_second_of(run_);
    source.end_s = source.begin_s + trial_.duration_s.value_or(0.0);
    if (occupancy_.changes_within_s) source.changes_within_s = *occupancy_.changes_within_s;
    source.n_people = occupants_.size();
    source.n_seats = places_.seats.size();
    source.part_of_place = places_.parts;
    source.seed = study_.seed();
    source.run = run_;
    return source;
  }

  void add(const CountedVisit& visit, std::size_t person, Stream& stream, std::vector<ScriptedAction>& actions) {
    const auto& doors = occupancy_.entrances;
    const auto any_door = [&] { return stream.index(static_cast<std::uint32_t>(doors.size())); };
    const std::uint32_t in_by = any_door(), out_by = any_door();
    const double free_s = free_s_[person];
    std::optional<double> moves_s;
    if (visit.comes_s == CountedVisit::from_the_beginning) {
      actions.push_back(untimed(action::Appear{stand_of(visit.place, person), 0.0}));
    } else if (visit.comes_from == CountedVisit::Beyond::other_part) {
      moves_s = std::max(visit.comes_s - move_s(person, last_place_[person], visit.place), free_s);
    } else {
      const double at_s = visit.comes_s - crossings(person, in_by, visit.place).in_s;
      actions.push_back(timed(action::Enter{doors[in_by]}, std::max(at_s, free_s)));
    }
    stay(visit, person, stream, moves_s, actions);
    last_place_[person] = visit.place;
    if (visit.goes_s == CountedVisit::to_the_end) return;
    if (visit.goes_to == CountedVisit::Beyond::other_part) {
      free_s_[person] = std::max({visit.comes_s, moves_s.value_or(0.0), free_s});
      return;
    }
    constexpr double turns_round_s = 1.0;  // assumed: of who is sent out again at once
    const double at_s = visit.goes_s - crossings(person, out_by, visit.place).out_s;
    free_s_[person] = std::max({at_s, visit.comes_s + turns_round_s, free_s});
    actions.push_back(timed(action::Leave{doors[out_by]}, free_s_[person]));
  }

  /// What they do until something else is called for.
  /// begins_s: when they set out for the place, if not at once.
  void stay(const CountedVisit& visit, std::size_t person, Stream& stream, std::optional<double> begins_s,
            std::vector<ScriptedAction>& actions) const {
    for (Action& action : taking(visit.place, person)) {
      actions.push_back(untimed(std::move(action)));
      actions.back().at_s = std::exchange(begins_s, std::nullopt);
    }
    if (!places_.is_seat(visit.place)) return actions.push_back(untimed(action::Wait{until_next_s}));
    const double end_s = std::min(visit.goes_s, trial_.duration_s.value_or(0.0));
    for (double left_s = end_s - std::max(visit.comes_s, 0.0); left_s > 0.0;) {
      action::Work work = draw_desk_work(stream);
      left_s -= work.duration_s;
      if (left_s <= 0.0) work.duration_s = until_next_s;
      actions.push_back(untimed(work));
    }
  }

  [[nodiscard]] std::vector<Action> taking(std::size_t place, std::size_t person) const {
    if (places_.is_seat(place)) {
      constexpr double wait_s = 5.0;  // assumed: longer, and the count is off (2-20 s)
      return {action::Sit{places_.seats[place], wait_s, action::IfTaken::other_seat}};
    }
    const Vec2 point = stand_of(place, person),
               middle = 0.5 * (study_.scene().floor.lower() + study_.scene().floor.upper());
    return {action::Walk{{point}}, action::Turn{degrees(heading_of(middle - point))}};
  }

  [[nodiscard]] Vec2 stand_of(std::size_t place, std::size_t person) const {
    if (!places_.is_seat(place)) return places_.standing[place - places_.seats.size()];
    const SeatPlan& plan = trial_.people[person].seat_plan(places_.seats[place]);
    return plan.stand(plan.place.world_from_seat);
  }

  /// How long somebody alone takes from setting out to crossing the edge of the place's part of the floor.
  struct Crossings {
    double in_s = 3.0, out_s = 10.0;
  };
  const Crossings& crossings(std::size_t person, std::uint32_t door, std::size_t place) {
    const auto [known, is_new] = crossings_.try_emplace({person, door, place});
    if (is_new) known->second = rehearse(person, door, place);
    return known->second;
  }

  /// How long somebody alone takes from setting out in one part to the place's part.
  double move_s(std::size_t person, std::size_t from, std::size_t to) {
    const auto [known, is_new] = moves_.try_emplace({person, from, to});
    if (is_new) known->second = rehearse_move(person, from, to);
    return known->second;
  }
  [[nodiscard]] double rehearse_move(std::size_t person, std::size_t from, std::size_t to) const {
    double reached_s = to_settle_s + 5.0;  // assumed, of who doesn't get there alone (2-10)
    std::vector<ScriptedAction> actions{untimed(action::Appear{stand_of(from, person), 0.0})};
    settle(from, person, actions);
    const std::size_t first = actions.size();
    for (Action& action : taking(to, person)) actions.push_back(untimed(std::move(action)));
    actions[first].at_s = to_settle_s;
    bool is_there = false;
    try_out(person, std::move(actions), [&](const Actor& actor, double now_s) {
      if (is_there || now_s <= to_settle_s || !is_in(actor, places_.parts[to])) return;
      is_there = true;
      reached_s = now_s;
    });
    return reached_s - to_settle_s;
  }

  /// Is somebody over a part of the floor?
  [[nodiscard]] bool is_in(const Actor& actor, std::size_t part) const {
    return actor.counts_on(study_.scene().floor) && parts_.at(actor.motion().position()) == part;
  }

  /// The person comes, takes the place and goes again, as in the run but alone.
  [[nodiscard]] Crossings rehearse(std::size_t person, std::uint32_t door, std::size_t place) const {
    constexpr double slow_m_s = 0.5;
    const std::string& id = occupancy_.entrances[door];
    const EntranceSpec& entrance = *std::ranges::find(study_.scene().entrances, id, &EntranceSpec::id);
    const double way_m = glm::distance(outside_of(entrance), stand_of(place, person));
    const double leaves_s = to_settle_s + way_m / slow_m_s;
    std::vector<ScriptedAction> actions{untimed(action::Enter{id})};
    settle(place, person, actions);
    actions.push_back(timed(action::Leave{id}, leaves_s));
    Crossings found;
    bool was_inside = false;
    try_out(person, std::move(actions), [&](const Actor& actor, double now_s) {
      const bool is_inside = is_in(actor, places_.parts[place]);
      if (is_inside && !was_inside && now_s < leaves_s) found.in_s = now_s;
      if (!is_inside && was_inside && now_s > leaves_s) found.out_s = now_s - leaves_s;
      was_inside = is_inside;
    });
    return found;
  }

  static constexpr double to_settle_s = 15.0;
  /// Takes the place and stays there until something else is called for.
  void settle(std::size_t place, std::size_t person, std::vector<ScriptedAction>& actions) const {
    for (Action& action : taking(place, person)) actions.push_back(untimed(std::move(action)));
    actions.push_back(
        untimed(places_.is_seat(place) ? Action(action::Work{until_next_s}) : Action(action::Wait{until_next_s})));
  }
  /// The person does it alone; told(actor, seconds) after every tick.
  template <typename Told>
  void try_out(std::size_t person, std::vector<ScriptedAction> actions, const Told& told) const {
    constexpr double longest_s = 600.0;
    auto plan = std::make_shared<DayPlan>(trial_.people.size());
    (*plan)[person] = std::move(actions);
    Actor actor(study_, run_, static_cast<std::uint32_t>(person), plan);
    for (std::int64_t tick = 1; !actor.done() && static_cast<double>(tick) * study_.tick_s() < longest_s; ++tick) {
      actor.advance(study_, tick, {}, {});
      told(actor, static_cast<double>(tick) * study_.tick_s());
    }
  }

  const CompiledStudy& study_;
  std::uint32_t run_;
  const TrialModel& trial_;
  const OccupancyInForce& occupancy_;
  CountedParts parts_;
  Places places_;
  std::vector<std::size_t> occupants_;             ///< indices into the trial's people
  std::vector<double> free_s_;                     ///< (n_people) when the last visit so far was called off
  std::map<std::size_t, std::size_t> last_place_;  ///< of each person, so far
  std::map<std::tuple<std::size_t, std::uint32_t, std::size_t>, Crossings> crossings_;
  std::map<std::tuple<std::size_t, std::size_t, std::size_t>, double> moves_;
};

/// A part of the floor that more people are in than can sit there.
struct PartPlaces {
  std::size_t part = 0, most = 0, seats = 0;
};

}  // namespace

void plan_occupancy(TrialModel& trial, const SceneSpec& scene, Diagnostics& faults) {
  OccupancyInForce& occupancy = *trial.occupancy;
  const Areas areas(scene);
  const CountedParts parts(occupancy.counts, areas);
  std::vector<PartPlaces> tight;
  const Places seats = places_of(trial, scene, parts);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const std::vector<int> people = parts.people(part);
    const PartPlaces found{part, static_cast<std::size_t>(people.empty() ? 0 : *std::ranges::max_element(people)),
                           static_cast<std::size_t>(std::ranges::count(seats.parts, part))};
    if (found.most > found.seats) tight.push_back(found);
  }
  if (tight.empty()) return;
  // Where the widest of them can stand, everybody can.
  const PersonModel* widest = nullptr;
  for (const PersonModel& person : trial.people) {
    if (!is_occupant(person)) continue;
    if (widest == nullptr || person.floor->clearance_m() > widest->floor->clearance_m()) widest = &person;
  }
  occupancy.standing = StandingPlaces(scene, *widest, occupancy.entrances.front()).all();
  const Places all = places_of(trial, scene, parts);
  for (const PartPlaces& part : tight) {
    const auto places = static_cast<std::size_t>(std::ranges::count(all.parts, part.part));
    if (part.most <= places) continue;
    faults.error(occupancy.counts.most.file.empty() ? occupancy.where : occupancy.counts.most,
                 counted(part.most, "person", "people") + ", but " + parts.name(part.part, scene) + " holds " +
                     std::to_string(places) + ": " + counted(part.seats, "seat") + " that can be used and " +
                     counted(places - part.seats, "place") + " to stand");
  }
}

DayPlan draw_occupancy(const CompiledStudy& study, std::uint32_t run) { return Visits(study, run).plan(); }

}  // namespace pirsim::sim
