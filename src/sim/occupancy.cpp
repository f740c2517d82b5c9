#include "sim/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "pirsim/geometry.hpp"
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

/// Places as a CountedVisit numbers them: seats, then where one stands.
struct Places {
  std::vector<std::string> seats;
  std::vector<Vec2> standing;
  [[nodiscard]] bool is_seat(std::size_t place) const { return place < seats.size(); }
};

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
        places_{shared_seats(trial_), occupancy_.standing},
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
    CountSource source{.times_s = occupancy_.counts.times_s, .people = occupancy_.counts.people};
    source.begin_s = study_.data_second_of(run_);
    source.end_s = source.begin_s + trial_.duration_s.value_or(0.0);
    if (occupancy_.changes_within_s) source.changes_within_s = *occupancy_.changes_within_s;
    source.n_people = occupants_.size();
    source.n_seats = places_.seats.size();
    source.n_standing = places_.standing.size();
    source.seed = study_.seed();
    source.run = run_;
    return source;
  }

  void add(const CountedVisit& visit, std::size_t person, Stream& stream, std::vector<ScriptedAction>& actions) {
    const auto& doors = occupancy_.entrances;
    const auto any_door = [&] { return stream.index(static_cast<std::uint32_t>(doors.size())); };
    const std::uint32_t in_by = any_door(), out_by = any_door();
    const double free_s = free_s_[person];
    if (visit.comes_s == CountedVisit::from_the_beginning) {
      actions.push_back(untimed(action::Appear{stand_of(visit.place, person), 0.0}));
    } else {
      const double at_s = visit.comes_s - crossings(person, in_by, visit.place).in_s;
      actions.push_back(timed(action::Enter{doors[in_by]}, std::max(at_s, free_s)));
    }
    stay(visit, person, stream, actions);
    if (visit.goes_s == CountedVisit::to_the_end) return;
    constexpr double turns_round_s = 1.0;  // assumed: of who is sent out again at once
    const double at_s = visit.goes_s - crossings(person, out_by, visit.place).out_s;
    free_s_[person] = std::max({at_s, visit.comes_s + turns_round_s, free_s});
    actions.push_back(timed(action::Leave{doors[out_by]}, free_s_[person]));
  }

  /// What they do until something else is called for.
  void stay(const CountedVisit& visit, std::size_t person, Stream& stream, std::vector<ScriptedAction>& actions) const {
    for (Action& action : taking(visit.place, person)) actions.push_back(untimed(std::move(action)));
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

  /// How long somebody alone takes from setting out to crossing the floor's edge.
  struct Crossings {
    double in_s = 3.0, out_s = 10.0;
  };
  const Crossings& crossings(std::size_t person, std::uint32_t door, std::size_t place) {
    const auto [known, is_new] = crossings_.try_emplace({person, door, place});
    if (is_new) known->second = rehearse(person, door, place);
    return known->second;
  }

  /// The person comes, takes the place and goes again, as in the run but alone.
  [[nodiscard]] Crossings rehearse(std::size_t person, std::uint32_t door, std::size_t place) const {
    constexpr double to_settle_s = 15.0, slow_m_s = 0.5, longest_s = 600.0;
    const std::string& id = occupancy_.entrances[door];
    const EntranceSpec& entrance = *std::ranges::find(study_.scene().entrances, id, &EntranceSpec::id);
    const double way_m = glm::distance(outside_of(entrance), stand_of(place, person));
    const double leaves_s = to_settle_s + way_m / slow_m_s;
    auto plan = std::make_shared<DayPlan>(trial_.people.size());
    std::vector<ScriptedAction>& actions = (*plan)[person];
    actions.push_back(untimed(action::Enter{id}));
    for (Action& action : taking(place, person)) actions.push_back(untimed(std::move(action)));
    if (places_.is_seat(place)) actions.push_back(untimed(action::Work{until_next_s}));
    if (!places_.is_seat(place)) actions.push_back(untimed(action::Wait{until_next_s}));
    actions.push_back(timed(action::Leave{id}, leaves_s));
    Actor actor(study_, run_, static_cast<std::uint32_t>(person), plan);
    Crossings found;
    bool was_inside = false;
    for (std::int64_t tick = 1; !actor.done() && static_cast<double>(tick) * study_.tick_s() < longest_s; ++tick) {
      actor.advance(study_, tick, {}, {});
      const bool is_inside = actor.counts_on(study_.scene().floor);
      const double now_s = static_cast<double>(tick) * study_.tick_s();
      if (is_inside && !was_inside && now_s < leaves_s) found.in_s = now_s;
      if (!is_inside && was_inside && now_s > leaves_s) found.out_s = now_s - leaves_s;
      was_inside = is_inside;
    }
    return found;
  }

  const CompiledStudy& study_;
  std::uint32_t run_;
  const TrialModel& trial_;
  const OccupancyInForce& occupancy_;
  Places places_;
  std::vector<std::size_t> occupants_;  ///< indices into the trial's people
  std::vector<double> free_s_;          ///< (n_people) when the last visit so far was called off
  std::map<std::tuple<std::size_t, std::uint32_t, std::size_t>, Crossings> crossings_;
};

}  // namespace

void plan_occupancy(TrialModel& trial, const SceneSpec& scene, Diagnostics& faults) {
  OccupancyInForce& occupancy = *trial.occupancy;
  const std::vector<int>& people = occupancy.counts.people;
  const auto most = static_cast<std::size_t>(people.empty() ? 0 : *std::ranges::max_element(people));
  const std::size_t seats = shared_seats(trial).size();
  if (most <= seats) return;
  // Where the widest of them can stand, everybody can.
  const PersonModel* widest = nullptr;
  for (const PersonModel& person : trial.people) {
    if (!is_occupant(person)) continue;
    if (widest == nullptr || person.floor->clearance_m() > widest->floor->clearance_m()) widest = &person;
  }
  occupancy.standing = StandingPlaces(scene, *widest, occupancy.entrances.front()).all();
  const std::size_t places = seats + occupancy.standing.size();
  if (most <= places) return;
  faults.error(occupancy.counts.most.file.empty() ? occupancy.where : occupancy.counts.most,
               std::to_string(most) + " people, but " + scene.name + " holds " + std::to_string(places) + ": " +
                   std::to_string(seats) + (seats == 1 ? " seat" : " seats") + " that can be used and " +
                   std::to_string(occupancy.standing.size()) + " places to stand");
}

DayPlan draw_occupancy(const CompiledStudy& study, std::uint32_t run) { return Visits(study, run).plan(); }

}  // namespace pirsim::sim
