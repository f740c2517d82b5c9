#include "engine/study/people.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "model/core/text.hpp"
#include "model/schema/check_scene.hpp"
#include "model/schema/check_script.hpp"
#include "model/schema/words.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"

namespace pirsim {
namespace {

// Adults; statures of [DrillisContini1966]'s time were smaller. assumed: mean of men and women in Europe, with their
// common spread (tried 1.65-1.78, 0.07-0.11).
constexpr double mean_stature_m = 1.72, stature_sd_m = 0.09, least_stature_m = 1.52, most_stature_m = 1.92;
constexpr double mean_bmi = 24.5, bmi_sd = 3.0, least_bmi = 18.0, most_bmi = 32.0;  // kg/m2, assumed (mean 22-27)
// Offices of all seasons: median of [Schiavon2013], log-normal spread of [Foldvary2018].
constexpr double median_clo = 0.59, clo_log_sd = 0.37, least_clo = 0.3, most_clo = 1.5;
constexpr double long_sleeves_clo = 0.59;  // trousers and shirt: 0.57 with short sleeves, 0.61 with long [ASHRAE55]
constexpr double skin_sd_k = 0.72;         // 83 % of means lie within 1 K [Mehnert2000], foreheads 0.8 [Micheletti2022]
constexpr double hair_sd = 0.1;            // assumed (0-0.2): of the head's share under hair
constexpr double pace_m_s = 1.2;           // indoors; Ref: [Weidmann1993] has 1.34 in the open

bool is_for(const SeatSpec& seat, std::string_view use) {
  return seat.uses.empty() || std::ranges::find(seat.uses, use) != seat.uses.end();
}

bool is_in(const SeatSpec& seat, const std::string& area, const SceneSpec& scene) {
  const auto found = std::ranges::find(scene.areas, area, &AreaSpec::id);
  return found != scene.areas.end() && found->outline.contains(floor_point(seat.world_from_seat.origin));
}

/// Seats that a script sets aside for meetings in a room, by name or by area.
std::set<std::string> set_aside(const MeetingsSpec& meetings, const SceneSpec& scene) {
  std::set<std::string> seats(meetings.seats.begin(), meetings.seats.end());
  if (!seats.empty() || meetings.area.empty()) return seats;
  for (const SeatSpec& seat : scene.seats) {
    if (is_in(seat, meetings.area, scene)) seats.insert(seat.id);
  }
  return seats;
}

/// what: asks for them, and of which kind they are: "schedule: entrance".
void require_names(const std::vector<std::string>& wanted, const std::vector<std::string>& known,
                   const std::string& what, const std::string& scene, const Where& where, Diagnostics& faults) {
  for (const std::string& name : wanted) {
    if (std::ranges::find(known, name) != known.end()) continue;
    faults.error(where, what + " '" + name + "' is not in " + scene + near_or_all(name, known));
  }
}

/// Who owns which desk: seats that are asked for, then those that nobody has.
class Desks {
 public:
  Desks(const ScheduleSpec& schedule, const SceneSpec& scene, Diagnostics& diagnostics) {
    const std::vector<std::string> names = ids_of(scene.seats);
    std::set<std::string> kept;
    for (const MeetingsSpec& meetings : schedule.meetings) kept.merge(set_aside(meetings, scene));
    for (const SeatSpec& seat : scene.seats) {
      if (is_for(seat, "work") && !kept.contains(seat.id)) desks_.push_back(seat.id);
    }
    for (const StaffSpec& staff : schedule.staff) {
      for (const std::string& seat : staff.seats) {
        require_names({seat}, names, "schedule: seat", scene.name, staff.where, diagnostics);
        const bool is_known = std::ranges::find(names, seat) != names.end();
        if (is_known && !taken_.insert(seat).second)
          diagnostics.error(staff.where, "schedule: seat '" + seat + "' is the own desk of two people");
      }
    }
  }

  /// Of the i-th of these; none if there are no more.
  std::optional<std::string> own(const StaffSpec& staff, std::size_t i) {
    if (i < staff.seats.size()) return staff.seats[i];
    const auto free = std::ranges::find_if(desks_, [&](const std::string& name) { return !taken_.contains(name); });
    if (free == desks_.end()) return std::nullopt;
    taken_.insert(*free);
    return *free;
  }

  [[nodiscard]] std::size_t size() const { return desks_.size(); }
  [[nodiscard]] bool is_taken(const std::string& seat) const { return taken_.contains(seat); }

 private:
  std::vector<std::string> desks_;
  std::set<std::string> taken_;
};

int number_of(const std::vector<StaffSpec>& staff) {
  int n = 0;
  for (const StaffSpec& some : staff) n += some.count;
  return n;
}

/// Are there seats and people for the meetings of a room?
void check_meetings(const ScheduleSpec& schedule, std::size_t room, const SceneSpec& scene, Diagnostics& diagnostics) {
  const MeetingsSpec& meetings = schedule.meetings[room];
  const std::vector<std::string> areas = ids_of(scene.areas);
  if (!meetings.area.empty() && std::ranges::find(areas, meetings.area) == areas.end()) {
    return diagnostics.error(meetings.where, "schedule: meetings: area '" + meetings.area + "' is not in " +
                                                 scene.name + near_or_all(meetings.area, areas));
  }
  const std::vector<std::string> seats = meeting_seats(schedule, room, scene);
  for (std::size_t other = 0; other < room; ++other) {
    for (const std::string& seat : meeting_seats(schedule, other, scene)) {
      if (std::ranges::find(seats, seat) == seats.end()) continue;
      return diagnostics.error(meetings.where, "schedule: meetings: seat '" + seat +
                                                   "' is another room's too: say the `area` or the `seats` of each");
    }
  }
  const bool are_staff = meetings.attendees == Attendees::staff;
  const auto require = [&](int people, const Where& where) {
    if (people > static_cast<int>(seats.size())) {
      diagnostics.error(where, "schedule: meetings: " + counted(static_cast<std::size_t>(people), "person", "people") +
                                   " for the " + counted(seats.size(), "seat") + " of " + scene.name + " that " +
                                   (seats.size() == 1 ? "is" : "are") + " left for meetings");
    } else if (are_staff && people > number_of(schedule.staff)) {
      diagnostics.error(where, "schedule: meetings: " + std::to_string(people) + " people, and " +
                                   std::to_string(number_of(schedule.staff)) + " of the staff");
    }
  };
  for (const HeldMeetingSpec& held : meetings.held) require(held.people, held.where);
  if (meetings.held.empty())
    require(std::max(meetings.fewest_people, meetings.most_people.value_or(0)), meetings.where);
}

/// Who sleeps where: beds that are asked for, then those that nobody has.
std::vector<std::string> beds_of(const HouseholdSpec& household, const SceneSpec& scene, Diagnostics& diagnostics) {
  std::vector<std::string> names, beds;
  std::set<std::string> taken;
  for (const PlaceSpec& place : scene.places) {
    const bool is_for_sleep = std::ranges::find(place.uses, "sleep") != place.uses.end();
    if (place.posture == PlacePosture::lie && (is_for_sleep || place.uses.empty())) names.push_back(place.id);
  }
  for (const ResidentSpec& resident : household.residents) {
    if (resident.bed.empty()) continue;
    if (std::ranges::find(names, resident.bed) == names.end()) {
      diagnostics.error(resident.where, "household: bed '" + resident.bed + "' is no place for sleep in " + scene.name +
                                            near_or_all(resident.bed, names));
    } else if (!taken.insert(resident.bed).second) {
      diagnostics.error(resident.where, "household: bed '" + resident.bed + "' is the own bed of two people");
    }
  }
  for (const ResidentSpec& resident : household.residents) {
    std::string bed = resident.bed;
    if (bed.empty()) {
      const auto free = std::ranges::find_if(names, [&](const std::string& name) { return !taken.contains(name); });
      if (free == names.end()) {
        diagnostics.error(resident.where, "household: '" + resident.id + "' has no bed: " + scene.name + " has " +
                                              counted(names.size(), "place") + " to lie and sleep");
      } else {
        bed = *free;
        taken.insert(bed);
      }
    }
    beds.push_back(bed);
  }
  return beds;
}

WarmthSpec drawn_warmth(std::uint64_t seed, std::uint32_t entity) {
  Stream stream({seed, 0, entity, Purpose::schedule_warmth});
  WarmthSpec warmth;
  warmth.clothing_clo = std::clamp(median_clo * std::exp(clo_log_sd * stream.normal()), least_clo, most_clo);
  if (warmth.clothing_clo < long_sleeves_clo) warmth.bare = {"head", "left_forearm", "right_forearm"};
  warmth.skin_above_k = skin_sd_k * stream.normal();
  warmth.hair_share = std::clamp(warmth.hair_share + hair_sd * stream.normal(), 0.0, 1.0);
  return warmth;
}

}  // namespace

PersonSpec drawn_body(const std::string& id, MotionStyle style, std::uint64_t seed, std::uint32_t entity) {
  Stream stream({seed, 0, entity, Purpose::schedule_body});
  PersonSpec person;
  person.id = id;
  person.style = style;
  person.stature_m = std::clamp(mean_stature_m + stature_sd_m * stream.normal(), least_stature_m, most_stature_m);
  person.mass_kg =
      std::clamp(mean_bmi + bmi_sd * stream.normal(), least_bmi, most_bmi) * person.stature_m * person.stature_m;
  person.walking_speed_m_s = pace_m_s;
  person.seat_scatter = {0.03, 4.0};
  person.warmth = drawn_warmth(seed, entity);
  return person;
}

PersonSpec largest_body(const std::string& id) {
  PersonSpec person;
  person.id = id;
  person.stature_m = most_stature_m;
  person.mass_kg = most_bmi * most_stature_m * most_stature_m;
  return person;
}

std::vector<std::string> meeting_seats(const ScheduleSpec& schedule, std::size_t room, const SceneSpec& scene) {
  const MeetingsSpec& meetings = schedule.meetings[room];
  if (!meetings.seats.empty()) return meetings.seats;
  Diagnostics told_elsewhere;
  Desks desks(schedule, scene, told_elsewhere);
  for (const StaffSpec& staff : schedule.staff) {
    for (std::size_t i = staff.seats.size(); i < static_cast<std::size_t>(staff.count); ++i) desks.own(staff, i);
  }
  std::set<std::string> others;
  for (std::size_t other = 0; other < schedule.meetings.size(); ++other) {
    if (other != room) others.merge(set_aside(schedule.meetings[other], scene));
  }
  std::vector<std::string> free;
  for (const SeatSpec& seat : scene.seats) {
    const bool is_here = meetings.area.empty() ? !others.contains(seat.id) : is_in(seat, meetings.area, scene);
    if (is_here && is_for(seat, "meet") && !desks.is_taken(seat.id)) free.push_back(seat.id);
  }
  return free;
}

int most_at_meeting(const ScheduleSpec& schedule, std::size_t room, const SceneSpec& scene) {
  constexpr int usual = 8;  // Ref: [ChenHongLuo2018]
  const MeetingsSpec& meetings = schedule.meetings[room];
  if (!meetings.held.empty()) return std::ranges::max(meetings.held, {}, &HeldMeetingSpec::people).people;
  if (meetings.most_people) return *meetings.most_people;
  const int seats = static_cast<int>(meeting_seats(schedule, room, scene).size());
  const int people = meetings.attendees == Attendees::staff ? number_of(schedule.staff) : usual;
  return std::min({usual, seats, people});
}

std::vector<ScheduledPerson> people_of(const ScheduleSpec& schedule, const SceneSpec& scene, std::uint64_t seed) {
  Diagnostics diagnostics;
  Desks desks(schedule, scene, diagnostics);
  require_names(schedule.entrances, ids_of(scene.entrances), "schedule: entrance", scene.name, schedule.where,
                diagnostics);
  if (scene.entrances.empty())
    diagnostics.error(schedule.where, "schedule: " + scene.name + " has no entrance to come in by");
  std::vector<ScheduledPerson> people;
  const auto add = [&](SchedulePart part, Role role, const std::string& name, const std::string& seat) {
    people.push_back(
        {part, role, seat, drawn_body(name, schedule.style, seed, static_cast<std::uint32_t>(people.size()))});
  };
  if (schedule.household) {
    const std::vector<std::string> beds = beds_of(*schedule.household, scene, diagnostics);
    diagnostics.throw_if_errors();
    for (std::size_t i = 0; i < beds.size(); ++i)
      add(SchedulePart::resident, Role::staff, schedule.household->residents[i].id, beds[i]);
    if (schedule.household->visits_a_week > 0.0) add(SchedulePart::visitor, Role::staff, "visitor", "");
    return people;
  }
  std::map<Role, int> numbers;
  for (const StaffSpec& staff : schedule.staff) {
    for (int i = 0; i < staff.count; ++i) {
      const auto seat = desks.own(staff, static_cast<std::size_t>(i));
      if (!seat) {
        diagnostics.error(staff.where,
                          "schedule: more staff than the " + counted(desks.size(), "seat") + " of " + scene.name);
        break;
      }
      add(SchedulePart::staff, staff.role,
          std::string(word_of(staff.role)) + '_' + std::to_string(++numbers[staff.role]), *seat);
    }
  }
  for (const MeetingsSpec& meetings : schedule.meetings)
    require_names(meetings.seats, ids_of(scene.seats), "schedule: seat", scene.name, meetings.where, diagnostics);
  for (std::size_t room = 0; room < schedule.meetings.size(); ++room)
    check_meetings(schedule, room, scene, diagnostics);
  diagnostics.throw_if_errors();
  int guests = 0;
  for (std::size_t room = 0; room < schedule.meetings.size(); ++room) {
    if (schedule.meetings[room].attendees == Attendees::staff) continue;
    for (int i = most_at_meeting(schedule, room, scene); i > 0; --i) {
      add(SchedulePart::guest, Role::staff, "guest_" + std::to_string(++guests), "");
      people.back().room = room;
    }
  }
  if (schedule.cleaning_h) add(SchedulePart::cleaner, Role::staff, "cleaner", "");
  return people;
}

std::vector<ScheduledPerson> people_of(const OccupancySpec& occupancy, const SceneSpec& scene, std::uint64_t seed) {
  Diagnostics faults;
  require_names(occupancy.seats, ids_of(scene.seats), "occupancy: seat", scene.name, occupancy.where, faults);
  require_names(occupancy.entrances, ids_of(scene.entrances), "occupancy: entrance", scene.name, occupancy.where,
                faults);
  if (occupancy.counts) {
    std::vector<std::string> areas;
    for (const AreaCountsSpec& area : occupancy.counts->areas) areas.push_back(area.area);
    require_names(areas, ids_of(scene.areas), "occupancy: area", scene.name, occupancy.where, faults);
  }
  if (scene.entrances.empty() && !occupancy.positions)
    faults.error(occupancy.where, "occupancy: " + scene.name + " has no entrance to come in by");
  faults.throw_if_errors();
  std::vector<ScheduledPerson> people;
  if (!occupancy.counts) return people;
  const std::vector<int>& counts = occupancy.counts->people;
  const int most = counts.empty() ? 0 : *std::ranges::max_element(counts);
  for (int i = 0; i < occupancy.persons.value_or(most); ++i) {
    people.push_back(
        {SchedulePart::occupant, Role::staff, "",
         drawn_body("occupant_" + std::to_string(i + 1), occupancy.style, seed, static_cast<std::uint32_t>(i))});
  }
  return people;
}

namespace {

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
    last_s_ = std::max(data_s - begin_s_, last_s_);
    actions_.push_back({std::move(what), last_s_, {}, where_});
  }
  void then(Action what) { actions_.push_back({std::move(what), {}, {}, where_}); }

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
    const double at_s = std::max(0.0, follow.times_s.front() - tick_s);
    person.actions.push_back({std::move(follow), at_s, {}, track.where});
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
