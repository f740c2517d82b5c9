#include "engine/sim/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "engine/sim/actor.hpp"
#include "engine/sim/day_draw.hpp"
#include "engine/sim/pedestrian.hpp"
#include "engine/sim/plan_people.hpp"
#include "model/core/text.hpp"
#include "model/schema/check_scene.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"

namespace pirsim::sim {
namespace {

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
      actions.push_back({action::Appear{stand_of(visit.place, person), 0.0}});
    } else if (visit.comes_from == CountedVisit::Beyond::other_part) {
      moves_s = std::max(visit.comes_s - move_s(person, last_place_[person], visit.place), free_s);
    } else {
      const double at_s = visit.comes_s - crossings(person, in_by, visit.place).in_s;
      actions.push_back({action::Enter{doors[in_by]}, std::max(at_s, free_s)});
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
    actions.push_back({action::Leave{doors[out_by]}, free_s_[person]});
  }

  /// What they do until something else is called for. begins_s: when they set out for the place, if not at once.
  void stay(const CountedVisit& visit, std::size_t person, Stream& stream, std::optional<double> begins_s,
            std::vector<ScriptedAction>& actions) const {
    for (Action& action : taking(visit.place, person)) {
      actions.push_back({std::move(action), std::exchange(begins_s, std::nullopt)});
    }
    if (!places_.is_seat(visit.place)) return actions.push_back({action::Wait{until_next_s}});
    const double end_s = std::min(visit.goes_s, trial_.duration_s.value_or(0.0));
    for (const action::Work& work : draw_desk_work(stream, end_s - std::max(visit.comes_s, 0.0)))
      actions.push_back({work});
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
    std::vector<ScriptedAction> actions{{action::Appear{stand_of(from, person), 0.0}}};
    settle(from, person, actions);
    const std::size_t first = actions.size();
    for (Action& action : taking(to, person)) actions.push_back({std::move(action)});
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
    std::vector<ScriptedAction> actions{{action::Enter{id}}};
    settle(place, person, actions);
    actions.push_back({action::Leave{id}, leaves_s});
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
    for (Action& action : taking(place, person)) actions.push_back({std::move(action)});
    actions.push_back({places_.is_seat(place) ? Action(action::Work{until_next_s}) : action::Wait{until_next_s}});
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

namespace {

// assumed: how long after the reading before and how long before its own a change happens, if the interval is long
// enough (0-5 s tried); two people who wait for each other in a doorway are late by less.
constexpr double after_s = 1.0, before_s = 5.0;
constexpr double after_share = 0.1, before_share = 0.4;  // of a shorter interval
constexpr double apart_s = 1.5;                          // assumed: between two people in a doorway (1-3)
constexpr double settled_s = 60.0;  // assumed: who has come or gone for less stays so, if another can do it

class Draw {
 public:
  explicit Draw(const CountSource& source) : source_(source), free_(source.part_of_place.size(), 1) {
    for (std::size_t person = 0; person < source.n_people; ++person) absent_.push_back({person, never});
  }

  std::vector<CountedVisit> visits() {
    const auto& times_s = source_.times_s;
    if (times_s.empty()) return {};
    const auto later = std::ranges::upper_bound(times_s, source_.begin_s);
    auto k = static_cast<std::size_t>(later - times_s.begin());
    std::size_t now = k == 0 ? 0 : k - 1;
    Stream first({source_.seed, source_.run, 0, Purpose::occupancy});
    for (std::size_t part = 0; part < n_parts(); ++part) {
      for (int i = 0; i < source_.people[part][now]; ++i) come(part, CountedVisit::from_the_beginning, first);
    }
    double since_s = source_.begin_s;
    for (; k < times_s.size() && since_s < source_.end_s; ++k) {
      change(now, k, since_s);
      now = k;
      since_s = times_s[k];
    }
    return std::move(visits_);
  }

 private:
  static constexpr double never = -std::numeric_limits<double>::infinity();
  struct Waiting {
    std::size_t person;
    double since_s;  ///< of the run
  };
  struct Present {
    std::size_t visit;  ///< index
    double since_s;
  };
  /// Somebody comes to a part of the floor, goes from one, or both.
  struct Step {
    std::optional<std::size_t> from, to;
  };

  [[nodiscard]] std::size_t n_parts() const { return source_.people.size(); }
  [[nodiscard]] std::size_t part_of(const Present& one) const {
    return source_.part_of_place[visits_[one.visit].place];
  }

  /// From one reading (index) to another.
  void change(std::size_t before, std::size_t reading, double since_s) {
    std::vector<std::size_t> left, reached;
    for (std::size_t part = 0; part < n_parts(); ++part) {
      const int by = source_.people[part][reading] - source_.people[part][before];
      for (int i = 0; i < std::abs(by); ++i) (by < 0 ? left : reached).push_back(part);
    }
    if (left.empty() && reached.empty()) return;
    Stream stream({source_.seed, source_.run, static_cast<std::uint32_t>(reading + 1), Purpose::occupancy});
    const std::vector<Step> steps = steps_between(std::move(left), std::move(reached), stream);
    const std::vector<double> moments_s = moments(steps.size(), since_s, source_.times_s[reading], stream);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (steps[i].from && steps[i].to) {
        move(*steps[i].from, *steps[i].to, moments_s[i], stream);
      } else {
        steps[i].to ? come(*steps[i].to, moments_s[i], stream) : go(*steps[i].from, moments_s[i], stream);
      }
    }
  }

  /// Whoever is missing in a part and may have gone to another has; who went where, and in which order, is drawn.
  [[nodiscard]] std::vector<Step> steps_between(std::vector<std::size_t> left, std::vector<std::size_t> reached,
                                                Stream& stream) const {
    if (n_parts() > 1) shuffle(left, stream), shuffle(reached, stream);
    std::vector<Step> steps(std::max(left.size(), reached.size()));
    for (std::size_t i = 0; i < left.size(); ++i) steps[i].from = left[i];
    for (std::size_t i = 0; i < reached.size(); ++i) steps[i].to = reached[i];
    if (n_parts() > 1) shuffle(steps, stream);
    return steps;
  }
  template <typename T>
  static void shuffle(std::vector<T>& items, Stream& stream) {
    for (std::size_t n = items.size(); n > 1; --n)
      std::swap(items[n - 1], items[stream.index(static_cast<std::uint32_t>(n))]);
  }

  /// n of them, ascending, in seconds of the run.
  [[nodiscard]] std::vector<double> moments(std::size_t n, double since_s, double at_s, Stream& stream) const {
    const double from_s = std::max(since_s, at_s - source_.changes_within_s), length_s = at_s - from_s;
    const double low_s = from_s + std::min(after_s, after_share * length_s);
    const double high_s = at_s - std::min(before_s, before_share * length_s);
    std::vector<double> result;
    for (std::size_t i = 0; i < n; ++i) result.push_back(low_s + (high_s - low_s) * stream.uniform());
    std::ranges::sort(result);
    const double apart = std::min(apart_s, (high_s - low_s) / static_cast<double>(n));
    for (std::size_t i = n - 1; i > 0; --i) result[i - 1] = std::min(result[i - 1], result[i] - apart);
    for (double& moment_s : result) moment_s -= source_.begin_s;
    for (std::size_t i = 0; i < n; ++i)
      result[i] = std::max(result[i], low_s - source_.begin_s + static_cast<double>(i) * apart);
    return result;
  }

  void come(std::size_t to, double at_s, Stream& stream) {
    const std::size_t who = pick(absent_, at_s, stream, [](const Waiting&) { return true; });
    visits_.push_back({absent_[who].person, take_place(to, stream), at_s});
    absent_.erase(absent_.begin() + static_cast<std::ptrdiff_t>(who));
    present_.push_back({visits_.size() - 1, at_s});
  }
  /// Ends the visit of somebody there.
  CountedVisit& go_from(std::size_t from, double at_s, Stream& stream) {
    const std::size_t who = pick(present_, at_s, stream, [&](const Present& one) { return part_of(one) == from; });
    CountedVisit& visit = visits_[present_[who].visit];
    visit.goes_s = at_s;
    free_[visit.place] = 1;
    present_.erase(present_.begin() + static_cast<std::ptrdiff_t>(who));
    return visit;
  }
  void go(std::size_t from, double at_s, Stream& stream) {
    absent_.push_back({go_from(from, at_s, stream).person, at_s});
  }
  void move(std::size_t from, std::size_t to, double at_s, Stream& stream) {
    CountedVisit& before = go_from(from, at_s, stream);
    before.goes_to = CountedVisit::Beyond::other_part;
    CountedVisit next{.person = before.person, .place = take_place(to, stream), .comes_s = at_s};
    next.comes_from = CountedVisit::Beyond::other_part;
    visits_.push_back(next);
    present_.push_back({visits_.size() - 1, at_s});
  }

  /// Of those that fit one who has been so for long, or else the one who has been so for longest: the list is in that
  /// order.
  template <typename List, typename Fits>
  [[nodiscard]] static std::size_t pick(const List& list, double at_s, Stream& stream, const Fits& fits) {
    const auto recent = std::ranges::find_if(list, [&](const auto& one) { return one.since_s > at_s - settled_s; });
    const auto n = static_cast<std::uint32_t>(std::count_if(list.begin(), recent, fits));
    std::uint32_t before = stream.index(std::max(1U, n));
    const auto drawn = std::ranges::find_if(list, [&](const auto& one) { return fits(one) && before-- == 0; });
    return static_cast<std::size_t>(drawn - list.begin());
  }

  [[nodiscard]] std::size_t take_place(std::size_t part, Stream& stream) {
    const auto is_free = [&](std::size_t place) { return free_[place] != 0 && source_.part_of_place[place] == part; };
    const auto seats = std::views::iota(std::size_t{0}, source_.n_seats);
    const bool sits = std::ranges::any_of(seats, is_free);
    const auto places = sits ? seats : std::views::iota(source_.n_seats, free_.size());
    const auto n_free = static_cast<std::uint32_t>(std::count_if(places.begin(), places.end(), is_free));
    auto before = stream.index(std::max(1U, n_free));
    for (const std::size_t place : places) {
      if (!is_free(place) || before-- > 0) continue;
      free_[place] = 0;
      return place;
    }
    return 0;  // never: there is a place for everybody
  }

  const CountSource& source_;
  std::vector<std::uint8_t> free_;  ///< (n_places) 1: nobody has it
  std::vector<Waiting> absent_;     ///< in the order of having gone
  std::vector<Present> present_;    ///< in the order of having come
  std::vector<CountedVisit> visits_;
};

}  // namespace

std::vector<CountedVisit> draw_visits(const CountSource& source) { return Draw(source).visits(); }

StandingPlaces::StandingPlaces(const SceneSpec& scene, const PersonModel& person, const std::string& door)
    : scene_(scene), person_(person), leaves_(leaves_of(scene, 1.0)) {
  const EntranceSpec& entrance = *std::ranges::find(scene.entrances, door, &EntranceSpec::id);
  outside_ = floor_point(entrance.world_from_entrance * Vec3(0, 0, entrance.outside_m));
}

bool StandingPlaces::can_be_reached(const Vec2& place) const {
  return scene_.floor.contains(place) && person_.floor->walkable(place) && person_.floor->has_way(outside_, place);
}

/// Not where others sit down, nor in a doorway.
bool StandingPlaces::is_out_of_the_way(const Vec2& place) const {
  constexpr double from_seat_m = 0.8, from_standing_place_m = 0.75, from_door_m = 1.2;  // assumed: a body and some room
  const bool in_doorway = std::ranges::any_of(scene_.entrances, [&](const EntranceSpec& door) {
    return glm::distance(place, floor_point(door.world_from_entrance.origin)) < from_door_m;
  });
  const bool at_door = std::ranges::any_of(
      leaves_, [&](const DoorLeaf& leaf) { return leaf.distance_to_sweep_m(place) < Doors::hold_m; });
  return !in_doorway && !at_door && std::ranges::none_of(person_.seats, [&](const auto& entry) {
    const SeatPlan& plan = entry.second;
    const Frame& seat = plan.place.world_from_seat;
    return glm::distance(place, floor_point(seat.origin)) < from_seat_m ||
           glm::distance(place, plan.stand(seat)) < from_standing_place_m;
  });
}

std::optional<Vec2> StandingPlaces::beside(const std::string& seat, Stream& stream) const {
  constexpr int directions = 12;
  const auto desk = std::ranges::find(scene_.seats, seat, &SeatSpec::id);
  const double first = 2.0 * pi * stream.uniform();
  if (desk == scene_.seats.end()) return std::nullopt;
  for (const double away_m : {1.0, 1.2, 0.85, 1.5}) {
    for (int k = 0; k < directions; ++k) {
      const Vec2 place = floor_point(desk->world_from_seat.origin) +
                         away_m * direction_of(first + 2.0 * pi * k / static_cast<double>(directions));
      if (is_out_of_the_way(place) && can_be_reached(place)) return place;
    }
  }
  return std::nullopt;
}

std::vector<Vec2> StandingPlaces::around(const Vec2& point, double radius_m, std::size_t most, Stream& stream) const {
  std::vector<Vec2> places;
  for (int tries = 0; tries < 40 && places.size() < most; ++tries) {
    const double away_m = radius_m * std::sqrt(stream.uniform());
    const Vec2 place = point + away_m * direction_of(2.0 * pi * stream.uniform());
    if (is_out_of_the_way(place) && can_be_reached(place)) places.push_back(place);
  }
  return places;
}

std::vector<Vec2> StandingPlaces::all() const {
  constexpr double apart_m = 0.9;  // assumed: two bodies with arms, and some room (0.8-1.2)
  const Vec2 lower = scene_.floor.lower(), upper = scene_.floor.upper();
  std::vector<Vec2> places;
  for (double x = lower.x + 0.5 * apart_m; x < upper.x; x += apart_m) {
    for (double z = lower.y + 0.5 * apart_m; z < upper.y; z += apart_m) {
      if (is_out_of_the_way({x, z}) && can_be_reached({x, z})) places.emplace_back(x, z);
    }
  }
  return places;
}

std::vector<Vec2> StandingPlaces::round(std::size_t most, Stream& stream) const {
  const Vec2 lower = scene_.floor.lower(), size = scene_.floor.upper() - lower;
  std::vector<Vec2> left, ordered;
  for (std::size_t tries = 0; tries < 10 * most && left.size() < most; ++tries) {
    const Vec2 place = lower + size * Vec2(stream.uniform(), stream.uniform());
    if (can_be_reached(place)) left.push_back(place);
  }
  for (Vec2 here = outside_; !left.empty(); here = ordered.back()) {
    const auto nearest = std::ranges::min_element(left, {}, [&](const Vec2& p) { return glm::distance(p, here); });
    ordered.push_back(*nearest);
    left.erase(nearest);
  }
  return ordered;
}

/// Cosine of the angle by which whoever looks there most askance turns from straight ahead.
double StandingPlaces::seen_by(const std::vector<const SeatSpec*>& seats, const Vec2& place) const {
  double least = 1.0, nearest_m = std::numeric_limits<double>::max();
  for (const SeatSpec* seat : seats) {
    const Vec2 way = place - floor_point(seat->world_from_seat.origin);
    const double away_m = std::max(0.01, glm::length(way));
    nearest_m = std::min(nearest_m, away_m);
    least = std::min(least, glm::dot(way / away_m, direction_of(heading_of(seat->world_from_seat))));
  }
  constexpr double farthest_m = 3.0;
  return nearest_m > farthest_m ? -1.0 : least;
}

std::optional<Vec2> StandingPlaces::before(const std::vector<std::string>& ids) const {
  constexpr double step_m = 0.25;
  std::vector<const SeatSpec*> seats;
  for (const SeatSpec& seat : scene_.seats) {
    if (std::ranges::find(ids, seat.id) != ids.end()) seats.push_back(&seat);
  }
  struct Candidate {
    double seen;
    Vec2 place;
  };
  std::vector<Candidate> candidates;
  const Vec2 lower = scene_.floor.lower(), upper = scene_.floor.upper();
  for (double x = lower.x + 0.5 * step_m; x < upper.x; x += step_m) {
    for (double z = lower.y + 0.5 * step_m; z < upper.y; z += step_m) {
      if (const double seen = seen_by(seats, {x, z}); seen > -0.99) candidates.push_back({seen, {x, z}});
    }
  }
  std::ranges::stable_sort(candidates, std::greater(), &Candidate::seen);
  for (const Candidate& candidate : candidates) {
    if (is_out_of_the_way(candidate.place) && can_be_reached(candidate.place)) return candidate.place;
  }
  return std::nullopt;
}

}  // namespace pirsim::sim
