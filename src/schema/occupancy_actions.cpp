#include "schema/occupancy_actions.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "schema/occupancy_runs.hpp"
#include "schema/schedule_people.hpp"

namespace pirsim {
namespace {

constexpr double until_next_s = 1e6;   ///< of an action that only the next one ends
constexpr double standstill_m = 0.05;  ///< assumed: who moves less hasn't walked (0.02-0.1)

/// What one person does, as their stays tell it.
class Replay {
 public:
  Replay(const OccupancySpec& occupancy, const SceneSpec& scene, double begin_s) : begin_s_(begin_s) {
    for (const std::string& id : entrances_of(occupancy, scene))
      doors_.push_back(&*std::ranges::find(scene.entrances, id, &EntranceSpec::id));
  }

  /// stays: of one visit, from coming in to leaving, in order of time.
  void add(const std::vector<const StaySpec*>& stays) {
    if (stays.back()->to_s <= begin_s_) return;
    where_ = stays.front()->where;
    at(stays.front()->from_s, action::Enter{door_near(*stays.front(), Which::first)});
    bool has_come = false;
    for (std::size_t i = 0; i < stays.size(); ++i) {
      const StaySpec& stay = *stays[i];
      where_ = stay.where;
      const bool is_last = i + 1 == stays.size();
      if (!stay.seat.empty()) {
        take(stay.from_s, has_come, action::Sit{stay.seat});
        then(action::Work{.duration_s = until_next_s});
      } else if (stands(stay)) {
        const bool walked_before = i > 0 && stays[i - 1]->seat.empty();
        take(walked_before ? stays[i - 1]->from_s : stay.from_s, has_come, action::Walk{{stay.points.front()}});
        then(action::Wait{until_next_s});
      } else if (is_last && i > 0) {
        return at(stays[i - 1]->to_s, action::Leave{door_near(stay, Which::last)});
      } else {
        continue;  // on the way to what comes next
      }
      has_come = true;
    }
    at(stays.back()->to_s, action::Leave{door_near(*stays.back(), Which::last)});
  }
  [[nodiscard]] std::vector<ScriptedAction> take_actions() { return std::move(actions_); }

 private:
  enum class Which { first, last };

  static bool stands(const StaySpec& stay) {
    return stay.points.size() == 2 && glm::distance(stay.points[0], stay.points[1]) < standstill_m;
  }
  [[nodiscard]] std::string door_near(const StaySpec& stay, Which which) const {
    if (stay.points.empty()) return doors_.front()->id;
    const Vec2 place = which == Which::first ? stay.points.front() : stay.points.back();
    const auto away_m = [&](const EntranceSpec* door) {
      return glm::distance(floor_point(door->world_from_entrance.origin), place);
    };
    return (*std::ranges::min_element(doors_, {}, away_m))->id;
  }

  /// The first thing that somebody comes for follows from coming in.
  void take(double at_s, bool has_come, Action what) { has_come ? at(at_s, std::move(what)) : then(std::move(what)); }
  void at(double data_s, Action what) {
    const double last_s = last_s_;
    last_s_ = std::max(data_s - begin_s_, last_s);
    then(std::move(what));
    actions_.back().at_s = last_s_;
  }
  void then(Action what) {
    ScriptedAction& action = actions_.emplace_back();
    action.what = std::move(what);
    action.where = where_;
  }

  std::vector<const EntranceSpec*> doors_;
  double begin_s_;
  double last_s_ = 0.0;
  Where where_;
  std::vector<ScriptedAction> actions_;
};

std::vector<PersonSpec> replayed(const OccupancySpec& occupancy, const SceneSpec& scene, double begin_s,
                                 std::uint64_t seed) {
  std::vector<PersonSpec> people;
  std::vector<Replay> replays;
  std::vector<const StaySpec*> visit;
  const auto& stays = occupancy.places->stays;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    visit.push_back(&stays[i]);
    const bool goes_on =
        i + 1 < stays.size() && stays[i + 1].person == stays[i].person && stays[i].then == AfterStay::goes_on;
    if (goes_on) continue;
    auto known = std::ranges::find(people, stays[i].person, &PersonSpec::id);
    if (known == people.end()) {
      const auto entity = static_cast<std::uint32_t>(people.size());
      people.push_back(drawn_body(stays[i].person, occupancy.style, seed, entity));
      replays.emplace_back(occupancy, scene, begin_s);
      known = people.end() - 1;
    }
    replays[static_cast<std::size_t>(known - people.begin())].add(visit);
    visit.clear();
  }
  for (std::size_t i = 0; i < people.size(); ++i) people[i].actions = replays[i].take_actions();
  return people;
}

/// tick_s: actions begin with the tick before the first point.
std::vector<PersonSpec> followed(const OccupancySpec& occupancy, double begin_s, double tick_s, std::uint64_t seed) {
  std::vector<PersonSpec> people;
  for (const TrackSpec& track : occupancy.positions->tracks) {
    PersonSpec& person =
        people.emplace_back(drawn_body(track.person, occupancy.style, seed, static_cast<std::uint32_t>(people.size())));
    action::Follow follow;
    for (std::size_t i = 0; i < track.times_s.size(); ++i) {
      if (track.times_s[i] < begin_s) continue;
      follow.times_s.push_back(track.times_s[i] - begin_s);
      follow.points.push_back(track.points[i]);
      if (!track.headings_deg.empty()) follow.headings_deg.push_back(track.headings_deg[i]);
    }
    if (follow.times_s.empty()) continue;
    ScriptedAction& action = person.actions.emplace_back();
    action.at_s = std::max(0.0, follow.times_s.front() - tick_s);
    action.what = std::move(follow);
    action.where = track.where;
  }
  return people;
}

}  // namespace

std::vector<PersonSpec> scripted_people(const OccupancySpec& occupancy, const SceneSpec& scene, double begin_s,
                                        double tick_s, std::uint64_t seed) {
  if (occupancy.places) return replayed(occupancy, scene, begin_s, seed);
  if (occupancy.positions) return followed(occupancy, begin_s, tick_s, seed);
  return {};
}

}  // namespace pirsim
