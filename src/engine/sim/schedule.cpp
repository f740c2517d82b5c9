#include "engine/sim/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/sim/day_draw.hpp"
#include "engine/sim/occupancy.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"
#include "pirsim/script.hpp"

// What one person does in the course of a run, as it is put together.

namespace pirsim::sim {

/// Actions of one person, timed in seconds of the run, and never two that begin at once.
class ActionLine {
 public:
  explicit ActionLine(const ScheduleSpec& schedule) : schedule_(schedule) {}

  /// At a moment of the day, whatever goes on then.
  void at(double day_s, Action what, const char* phase = "") {
    // In whole ticks of any rate, and later than what was timed before.
    last_s_ = std::max(std::ceil(day_s - schedule_.from_h * 3600.0), last_s_ + 1.0);
    actions_.push_back({std::move(what), last_s_, phase, schedule_.where});
  }
  /// After what was added before.
  void then(Action what, const char* phase = "") { actions_.push_back({std::move(what), {}, phase, schedule_.where}); }
  [[nodiscard]] std::vector<ScriptedAction> take() { return std::move(actions_); }

 private:
  const ScheduleSpec& schedule_;
  double last_s_ = -1.0;
  std::vector<ScriptedAction> actions_;
};

namespace {

constexpr double home_day_ends_s = home_to_h * hour_s;

// Assumed, with the range tried; the sums of a day are compared with the survey's in home_draw_test.
constexpr double toilet_s = 4.0 * minute_s;                                              // 2 to 6 min
constexpr double morning_wash_s = 20.0 * minute_s, evening_wash_s = 10.0 * minute_s;     // 10 to 30, 5 to 15
constexpr double breakfast_s = 25.0 * minute_s, breakfast_cooking_s = 10.0 * minute_s;   // 10 to 30, 5 to 15
constexpr double lunch_s = 55.0 * minute_s, dinner_s = 60.0 * minute_s;                  // 30 to 75
constexpr double lunch_cooking_s = 45.0 * minute_s, dinner_cooking_s = 50.0 * minute_s;  // 20 to 60
constexpr double shortest_pastime_s = 5.0 * minute_s;
constexpr double work_between_breaks_s = 90.0 * minute_s, break_s = 10.0 * minute_s;  // 60 to 120, 5 to 15

// On foot. Derivation and ranges: docs/physics/homes.md.
constexpr double sits_s = 12.0 * minute_s, sits_at_work_s = 18.0 * minute_s,
                 sits_at_meals_s = 90.0 * minute_s;  // means
constexpr double sits_log_sd = 1.0, between_people_log_sd = 0.3;
constexpr double shortest_s = 5.0;  // of a stop

/// How somebody goes about who is on foot: how long a stop lasts in the mean, and the share of stops in each reach; the
/// rest is at their own place.
struct Footwork {
  double stop_s;
  double here, kitchen, elsewhere;
};
constexpr Footwork cooking{30.0, 0.35, 0.0, 0.02};
constexpr Footwork errand{30.0, 0.8, 0.1, 0.1};
constexpr double further_stop = 0.5;  // of an errand
struct Chore {
  double share;
  Footwork footwork;
};
constexpr std::array<Chore, 3> kinds_of_chores{{{0.4, {60.0, 0.3, 0.0, 0.05}},    // dishes, ironing
                                                {0.4, {20.0, 0.93, 0.0, 0.05}},   // tidying, laundry
                                                {0.2, {8.0, 0.97, 0.0, 0.03}}}};  // vacuuming

constexpr double durations_log_sd = 0.45;  // assumed (0.3-0.6): a third or three times the mean in one of 100 cases

double about(Stream& stream, double mean, double log_sd = durations_log_sd) {
  return mean * std::exp(log_sd * cut_normal(stream) - 0.5 * log_sd * log_sd);
}

/// What somebody does at each moment of a day. What is put in later takes the place of what was there.
class StayLine {
 public:
  explicit StayLine(HomeActivity all_day) : stays_{{all_day, home_day_begins_s, home_day_ends_s}} {}

  void put(HomeActivity activity, double from_s, double to_s) {
    from_s = std::max(from_s, home_day_begins_s);
    to_s = std::min(to_s, home_day_ends_s);
    if (!(to_s > from_s)) return;
    std::vector<HomeStay> stays;
    for (const HomeStay& stay : stays_) {
      if (stay.from_s < from_s) stays.push_back({stay.activity, stay.from_s, std::min(stay.to_s, from_s)});
      if (stay.to_s > to_s) stays.push_back({stay.activity, std::max(stay.from_s, to_s), stay.to_s});
    }
    stays.push_back({activity, from_s, to_s});
    std::ranges::sort(stays, {}, &HomeStay::from_s);
    stays_ = std::move(stays);
  }

  [[nodiscard]] HomeActivity at(double time_s) const {
    const auto stay = std::ranges::find_if(stays_, [&](const HomeStay& s) { return time_s < s.to_s; });
    return stay == stays_.end() ? stays_.back().activity : stay->activity;
  }
  [[nodiscard]] bool is_up_at_home(double time_s) const {
    return at(time_s) != HomeActivity::away && at(time_s) != HomeActivity::sleep;
  }
  [[nodiscard]] const std::vector<HomeStay>& stays() const noexcept { return stays_; }
  /// Neighbours that are alike as one.
  [[nodiscard]] std::vector<HomeStay> joined() const {
    std::vector<HomeStay> stays;
    for (const HomeStay& stay : stays_) {
      if (!stays.empty() && stays.back().activity == stay.activity) {
        stays.back().to_s = stay.to_s;
      } else {
        stays.push_back(stay);
      }
    }
    return stays;
  }

 private:
  std::vector<HomeStay> stays_;
};

struct Nights {
  double wakes_s, goes_to_bed_s;
};

void sleep_and_wash(StayLine& day, const Nights& nights, Stream& stream) {
  day.put(HomeActivity::sleep, home_day_begins_s, nights.wakes_s);
  double now = nights.wakes_s;
  const auto next = [&](HomeActivity activity, double mean_s) {
    const double until = now + about(stream, mean_s);
    day.put(activity, now, until);
    now = until;
  };
  next(HomeActivity::toilet, toilet_s);
  next(HomeActivity::wash, morning_wash_s);
  next(HomeActivity::cook, breakfast_cooking_s);
  next(HomeActivity::eat, breakfast_s);
  day.put(HomeActivity::wash, nights.goes_to_bed_s - about(stream, evening_wash_s), nights.goes_to_bed_s);
  day.put(HomeActivity::sleep, nights.goes_to_bed_s, home_day_ends_s);
}

/// Work, or what takes somebody out who has none today: errands, sport, friends.
void spend_the_day(StayLine& day, const HouseholdSpec& household, Occupation today, Stream& stream) {
  if (today != Occupation::at_home) {
    const double leaves_s = around(stream, household.leaves);
    const double until_s = std::max(leaves_s, around(stream, household.comes_home));
    return day.put(today == Occupation::works ? HomeActivity::away : HomeActivity::work, leaves_s, until_s);
  }
  constexpr double goes_out = 0.85;               // assumed (0.7-0.95): share of days
  constexpr double first_h = 9.5, last_h = 17.5;  // assumed: when
  constexpr double mean_s = 2.5 * hour_s;         // shopping, exercise, company and ways. Ref: [Idescat2011]
  const double share = stream.uniform(), when = stream.uniform(), length_s = about(stream, mean_s);
  const double from_s = (first_h + (last_h - first_h) * when) * hour_s;
  if (share < goes_out) day.put(HomeActivity::away, from_s, from_s + length_s);
}

/// Rest between stretches of work, unless hardly any work is left after it.
void take_breaks(StayLine& day, Stream& stream) {
  for (const HomeStay& stretch : day.joined()) {
    if (stretch.activity != HomeActivity::work) continue;
    for (double now = stretch.from_s;;) {
      const double from_s = now + about(stream, work_between_breaks_s);
      now = from_s + about(stream, break_s);
      if (now + break_s > stretch.to_s) break;
      day.put(HomeActivity::rest, from_s, now);
    }
  }
}

/// One of those at home cooks, and all at home eat.
void have_meal(std::vector<StayLine>& days, double at_s, double cooking_s, double length_s, Stream& stream) {
  const double cooking = about(stream, cooking_s), eating = about(stream, length_s), u = stream.uniform();
  std::vector<StayLine*> cooks, eaters;
  for (StayLine& day : days) {
    if (!day.is_up_at_home(at_s)) continue;
    eaters.push_back(&day);
    if (day.is_up_at_home(at_s - cooking)) cooks.push_back(&day);
  }
  if (cooks.empty()) return;
  const auto cook = static_cast<std::size_t>(u * static_cast<double>(cooks.size()));
  cooks[cook]->put(HomeActivity::cook, at_s - cooking, at_s);
  for (StayLine* day : eaters) day->put(HomeActivity::eat, at_s, at_s + eating);
}

/// How readily somebody does it at this hour, beside the other pastimes. Assumed: television in the evening, no
/// housework at night.
double appeal(HomeActivity activity, double time_s) {
  const double hour = time_s / hour_s;
  if (activity == HomeActivity::tv) return hour >= 18.0 ? 3.0 : 1.0;
  if (activity == HomeActivity::chores) return hour >= 20.0 ? 0.1 : 1.0;
  return 1.0;
}

/// Fills what is left of the day: each pastime in sessions, those with much left to do first; then rest.
void pass_the_time(StayLine& day, Stream& stream) {
  std::array<double, pastimes.size()> left_s{};
  for (std::size_t i = 0; i < pastimes.size(); ++i) {
    const double share = stream.uniform(), length_s = about(stream, pastimes[i].mean_min * minute_s);
    if (share < pastimes[i].participation) left_s[i] = length_s;
  }
  const std::vector<HomeStay> stays = day.joined();
  for (const HomeStay& gap : stays) {
    if (gap.activity != HomeActivity::rest) continue;
    for (double now = gap.from_s; gap.to_s - now >= shortest_pastime_s;) {
      std::array<double, pastimes.size()> weights{};
      for (std::size_t i = 0; i < pastimes.size(); ++i) weights[i] = left_s[i] * appeal(pastimes[i].activity, now);
      if (std::ranges::all_of(weights, [](double weight) { return weight <= 0.0; })) break;
      const std::size_t chosen = pick(stream, weights);
      const double session_s = std::max(shortest_pastime_s, about(stream, pastimes[chosen].session_min * minute_s));
      const double until = std::min(now + std::min(session_s, std::max(left_s[chosen], shortest_pastime_s)), gap.to_s);
      day.put(pastimes[chosen].activity, now, until);
      left_s[chosen] = std::max(0.0, left_s[chosen] - (until - now));
      now = until;
    }
  }
}

/// Every three to four hours by day [Lukacz2009], and at night as somebody's age has it.
void go_to_the_toilet(StayLine& day, const Nights& nights, double age_years, Stream& stream) {
  constexpr double shortest_s = hour_s, further_s = 2.5 * hour_s;
  const auto next_s = [&] { return shortest_s + exponential(stream, further_s); };
  for (double now = nights.wakes_s + next_s(); now < nights.goes_to_bed_s; now += next_s()) {
    if (day.is_up_at_home(now)) day.put(HomeActivity::toilet, now, now + about(stream, toilet_s));
  }
  const double asleep_s = nights.wakes_s - home_day_begins_s + home_day_ends_s - nights.goes_to_bed_s;
  const double mean_s = asleep_s / night_visits(age_years);
  const auto visit_between = [&](double from_s, double to_s) {
    for (double now = from_s + exponential(stream, mean_s); now < to_s; now += exponential(stream, mean_s))
      day.put(HomeActivity::toilet, now, std::min(now + about(stream, toilet_s), to_s));
  };
  visit_between(home_day_begins_s, nights.wakes_s);
  visit_between(nights.goes_to_bed_s, home_day_ends_s);
}

/// Puts a day's draw into a room.
class Day {
 public:
  Day(const CompiledStudy& study, std::uint32_t run)
      : study_(study), trial_(study.trial_of(run)), schedule_(*trial_.schedule), run_(run) {
    n_scheduled_ = static_cast<std::size_t>(
        std::ranges::count_if(trial_.people, [](const PersonModel& person) { return person.spec.part.has_value(); }));
    for (const EntranceSpec& door : study.scene().entrances) {
      const auto& wanted = schedule_.entrances;
      if (wanted.empty() || std::ranges::find(wanted, door.id) != wanted.end()) doors_.push_back(door.id);
    }
  }

  DayPlan plan() {
    const DayDraw draw = draw_times(study_, run_);
    take_seats(draw.meetings);
    DayPlan plan;
    for (std::size_t i = 0; i < trial_.people.size(); ++i) {
      const auto& part = trial_.people[i].spec.part;
      plan.push_back(part ? std::vector<ScriptedAction>{} : trial_.people[i].spec.actions);
      if (part && part->part == SchedulePart::staff) plan[i] = attend_work(i, draw);
      if (part && part->part == SchedulePart::cleaner && draw.cleaning_s) plan[i] = clean(i, *draw.cleaning_s);
    }
    bring_guests(draw.meetings, plan);
    return plan;
  }

 private:
  [[nodiscard]] Stream stream_of(std::size_t person) const {
    // Apart from the draw of times by its entity, whoever an effect adds.
    return Stream({study_.seed(), run_, static_cast<std::uint32_t>(person + n_scheduled_), Purpose::schedule_conduct});
  }
  [[nodiscard]] const std::string& door_of(std::size_t person) const { return doors_[person % doors_.size()]; }
  [[nodiscard]] StandingPlaces places_of(std::size_t person) const {
    return {study_.scene(), trial_.people[person], door_of(person)};
  }

  /// Nothing if they are there already.
  void come(ActionLine& line, double at_s, std::size_t person) const { line.at(at_s, action::Enter{door_of(person)}); }
  void go(ActionLine& line, double at_s, std::size_t person) const { line.at(at_s, action::Leave{door_of(person)}); }

  /// The first moment that counts of somebody who is there before the run begins: they come in one after the other.
  [[nodiscard]] double first_s(Stream& stream) const {
    return schedule_.from_h > 0.0 ? schedule_.from_h * hour_s + minute_s * stream.uniform() : 0.0;
  }

  std::vector<ScriptedAction> attend_work(std::size_t person, const DayDraw& draw) const {
    const std::vector<Stay>& stays = draw.stays[person];
    Stream stream = stream_of(person);
    const double begin_s = first_s(stream);
    ActionLine line(schedule_);
    for (const Stay& stay : stays) {
      const double from_s = std::max(stay.from_s, begin_s);
      if (stay.to_s <= from_s) continue;
      if (stay.place == Place::desk) {
        be_at_desk(line, from_s, stay.to_s, person, stream);
      } else if (stay.place == Place::others_desk && stay.host) {
        visit(line, from_s, person, *stay.host, stream);
      } else if (stay.meeting) {
        take_part(line, draw.meetings[*stay.meeting], seats_of_[*stay.meeting], person, begin_s);
      } else {
        go(line, from_s, person);
      }
    }
    if (!stays.empty() && stays.back().to_s > begin_s) go(line, stays.back().to_s, person);
    return line.take();
  }

  void sit_and_work(ActionLine& line, double for_s, std::size_t person, Stream& stream) const {
    action::Sit sit{trial_.people[person].spec.part->seat};
    sit.if_taken = action::IfTaken::other_seat;
    line.then(sit);
    for (const action::Work& work : draw_desk_work(stream, for_s)) line.then(work);
  }

  /// Now and then they get up for a call.
  void be_at_desk(ActionLine& line, double from_s, double to_s, std::size_t person, Stream& stream) const {
    constexpr double between_calls_s = 2.0 * hour_s;  // assumed (1-4 h) at the desk between calls on foot
    constexpr double shortest_s = minute_s, further_s = 3.0 * minute_s;  // assumed: of a call
    come(line, from_s, person);
    for (double now = from_s;;) {
      const double call_s = now + exponential(stream, between_calls_s);
      const double back_s = call_s + shortest_s + exponential(stream, further_s);
      const bool calls = back_s + shortest_s < to_s;
      sit_and_work(line, (calls ? call_s : to_s) - now, person, stream);
      if (!calls) return;
      walk_about(line, call_s, person, stream);
      come(line, back_s, person);
      now = back_s;
    }
  }

  void walk_about(ActionLine& line, double at_s, std::size_t person, Stream& stream) const {
    constexpr double within_m = 3.0, pause_s = 6.0;  // assumed: how far one wanders, and how long one stops (means)
    const SeatPlan& desk = trial_.people[person].seat_plan(trial_.people[person].spec.part->seat);
    const auto places = places_of(person).around(floor_point(desk.place.world_from_seat.origin), within_m, 8, stream);
    if (places.empty()) return;
    bool first = true;
    for (const Vec2& place : places) {
      const action::Walk walk{{place}};
      first ? line.at(at_s, walk, "phone_call") : line.then(walk, "phone_call");
      line.then(action::Wait{exponential(stream, pause_s)}, "phone_call");
      first = false;
    }
    line.then(action::Wait{until_next_s}, "phone_call");
  }

  /// Where nobody can stand beside the host they stay where they are, or away.
  void visit(ActionLine& line, double at_s, std::size_t person, std::size_t host, Stream& stream) const {
    const std::string& seat = trial_.people[host].spec.part->seat;
    const auto place = places_of(person).beside(seat, stream);
    if (!place) return;
    const Frame& desk = trial_.people[host].seat_plan(seat).place.world_from_seat;
    come(line, at_s, person);
    line.then(action::Walk{{*place}}, "visiting");
    line.then(action::Turn{degrees(heading_of(floor_point(desk.origin) - *place))}, "visiting");
    line.then(action::Wait{until_next_s}, "visiting");
  }

  std::vector<ScriptedAction> clean(std::size_t person, double at_s) const {
    constexpr double area_m2 = 4.0, pause_s = 8.0;  // assumed: a stop for so much floor, and how long it takes
    if (at_s < schedule_.from_h * hour_s) return {};
    Stream stream = stream_of(person);
    ActionLine line(schedule_);
    come(line, at_s, person);
    const auto stops = static_cast<std::size_t>(std::clamp(study_.scene().floor.area_m2() / area_m2, 4.0, 200.0));
    for (const Vec2& place : places_of(person).round(stops, stream)) {
      line.then(action::Walk{{place}}, "cleaning");
      line.then(action::Wait{exponential(stream, pause_s)}, "cleaning");
    }
    line.then(action::Leave{door_of(person)});
    return line.take();
  }

  /// Of each meeting: the seats of who comes, and all of its room.
  struct MeetingSeats {
    std::vector<std::string> of_people, of_room;
  };

  void take_seats(const std::vector<Meeting>& meetings) {
    for (std::size_t room = 0; room < schedule_.meetings.size(); ++room) {
      const std::vector<std::string> seats = meeting_seats(*trial_.schedule, room, study_.scene());
      Stream stream = stream_of(n_scheduled_ + room);
      begins_s_.push_back(first_s(stream));
      seats_of_.resize(meetings.size());
      for (std::size_t i = 0; i < meetings.size(); ++i) {
        if (meetings[i].room != room) continue;
        seats_of_[i].of_room = seats;
        std::vector<std::string> free = seats;
        for (std::size_t n = meetings[i].people.size(); n > 0; --n) {
          const std::size_t k = stream.index(static_cast<std::uint32_t>(free.size()));
          seats_of_[i].of_people.push_back(free[k]);
          free.erase(free.begin() + static_cast<std::ptrdiff_t>(k));
        }
      }
    }
  }

  void bring_guests(const std::vector<Meeting>& meetings, DayPlan& plan) const {
    std::vector<ActionLine> lines(plan.size(), ActionLine(schedule_));
    for (std::size_t i = 0; i < meetings.size(); ++i) {
      const double begin_s = begins_s_[meetings[i].room];
      for (const Attendance& who : meetings[i].people) {
        if (!is_guest(who.person) || who.goes_s <= begin_s) continue;
        take_part(lines[who.person], meetings[i], seats_of_[i], who.person, begin_s);
        go(lines[who.person], who.goes_s, who.person);
      }
    }
    for (std::size_t i = 0; i < plan.size(); ++i) {
      if (is_guest(i)) plan[i] = lines[i].take();
    }
  }
  [[nodiscard]] bool is_guest(std::size_t person) const {
    const auto& part = trial_.people[person].spec.part;
    return part && part->part == SchedulePart::guest;
  }

  void take_part(ActionLine& line, const Meeting& meeting, const MeetingSeats& seats, std::size_t who,
                 double begin_s) const {
    const auto at =
        static_cast<std::size_t>(std::ranges::find(meeting.people, who, &Attendance::person) - meeting.people.begin());
    const Attendance& attendance = meeting.people[at];
    const PersonModel& person = trial_.people[who];
    action::Work listen;
    listen.duration_s = until_next_s;
    listen.activity = Activity::meeting;
    action::Sit sit{person.can_use(seats.of_people[at]) ? seats.of_people[at] : person.seats.begin()->first};
    sit.if_taken = action::IfTaken::other_seat;
    come(line, std::max(attendance.comes_s, begin_s), who);
    line.then(sit);
    line.then(listen);
    if (attendance.presents_until_s && *attendance.presents_until_s > begin_s) {
      present(line, std::max({meeting.begin_s, attendance.comes_s + minute_s, begin_s}), who, seats.of_room);
      line.at(*attendance.presents_until_s, sit);
      line.then(listen);
    }
  }

  void present(ActionLine& line, double at_s, std::size_t person, const std::vector<std::string>& seats) const {
    const auto place = places_of(person).before(seats);
    if (!place) return;
    Vec2 middle(0.0);
    for (const SeatSpec& seat : study_.scene().seats) {
      if (std::ranges::find(seats, seat.id) == seats.end()) continue;
      middle += floor_point(seat.world_from_seat.origin) / static_cast<double>(seats.size());
    }
    line.at(at_s, action::Walk{{*place}}, "presenting");
    line.then(action::Turn{degrees(heading_of(middle - *place))}, "presenting");
    line.then(action::Wait{until_next_s}, "presenting");
  }

  const CompiledStudy& study_;
  const TrialModel& trial_;
  const ScheduleSpec& schedule_;
  std::uint32_t run_;
  std::size_t n_scheduled_ = 0;  ///< people; those that effects add come after them
  std::vector<std::string> doors_;
  std::vector<double> begins_s_;        ///< (n_rooms) before which nobody meets there
  std::vector<MeetingSeats> seats_of_;  ///< (n_meetings)
};

enum class Posture { sit, lie, stand };

/// The area that a point is in, as an index; of points in none: the number of areas.
std::size_t room_of(const SceneSpec& scene, const Vec2& point) {
  const auto area = std::ranges::find_if(scene.areas, [&](const AreaSpec& a) { return a.outline.contains(point); });
  return static_cast<std::size_t>(area - scene.areas.begin());
}

/// A seat or a place that people may take.
struct Spot {
  std::string id;
  Posture posture = Posture::sit;
  std::vector<std::string> uses;
  Vec2 point{0.0};
  std::size_t room = 0;
  double taken_until_s = 0.0;  ///< by whoever came last
};

std::vector<Spot> spots_of(const SceneSpec& scene) {
  std::vector<Spot> spots;
  const auto add = [&](const auto& of, const Frame& frame, Posture posture) {
    const Vec2 point = floor_point(frame.origin);
    spots.push_back({of.id, posture, of.uses, point, room_of(scene, point)});
  };
  for (const SeatSpec& seat : scene.seats) add(seat, seat.world_from_seat, Posture::sit);
  for (const PlaceSpec& place : scene.places)
    add(place, place.world_from_place, place.posture == PlacePosture::lie ? Posture::lie : Posture::stand);
  return spots;
}

bool is_for(const Spot& spot, std::string_view use) { return std::ranges::find(spot.uses, use) != spot.uses.end(); }

/// A resident's or a visitor's stay, among those of all.
struct PlannedStay {
  std::size_t person = 0;
  HomeStay stay;
  Spot* spot = nullptr;  ///< none: wherever they are
};

class HomeDayPlan {
 public:
  HomeDayPlan(const CompiledStudy& study, std::uint32_t run)
      : study_(study),
        trial_(study.trial_of(run)),
        schedule_(*trial_.schedule),
        spots_(spots_of(study.scene())),
        door_(schedule_.entrances.empty() ? study.scene().entrances.front().id : schedule_.entrances.front()),
        lines_(trial_.people.size(), ActionLine(schedule_)),
        state_(trial_.people.size()) {
    for (std::uint32_t i = 0; i < trial_.people.size(); ++i) {
      conduct_.emplace_back(StreamKey{study.seed(), run, i, Purpose::schedule_conduct});
      errands_.emplace_back(StreamKey{study.seed(), run, i, Purpose::home_errands});
      Stream habit({study.seed(), 0, i, Purpose::home_restlessness});
      calm_.push_back(about(habit, 1.0, between_people_log_sd));
      places_.emplace_back(study.scene(), trial_.people[i], door_);
    }
    drawn_ = draw_home_day(*schedule_.household, study.seed(), run, day_of(study, run));
  }

  DayPlan take() {
    planned_ = in_order();
    for (PlannedStay& planned : planned_) take_spot(planned);
    for (const PlannedStay& planned : planned_) spend(planned.person, planned.stay, planned.spot);
    DayPlan plan;
    for (std::size_t i = 0; i < trial_.people.size(); ++i)
      plan.push_back(trial_.people[i].spec.part ? lines_[i].take() : trial_.people[i].spec.actions);
    return plan;
  }

 private:
  enum class State { unborn, present, away };

  /// Everybody's stays by their beginning; of two that begin at once, that of the resident who is named first.
  std::vector<PlannedStay> in_order() const {
    std::vector<PlannedStay> all;
    std::size_t resident = 0, visitor = 0;
    for (std::size_t i = 0; i < trial_.people.size(); ++i) {
      const auto& part = trial_.people[i].spec.part;
      if (part && part->part == SchedulePart::resident) {
        for (const HomeStay& stay : drawn_.residents[resident]) all.push_back({i, stay});
        ++resident;
      } else if (part && part->part == SchedulePart::visitor && visitor < drawn_.visits.size()) {
        const Visit& visit = drawn_.visits[visitor++];
        all.push_back({i, {HomeActivity::rest, visit.comes_s, visit.goes_s}});
        all.push_back({i, {HomeActivity::away, visit.goes_s, visit.goes_s}});
      }
    }
    std::ranges::stable_sort(all, {}, [](const PlannedStay& planned) { return planned.stay.from_s; });
    return all;
  }

  void spend(std::size_t person, const HomeStay& stay, const Spot* spot) {
    ActionLine& line = lines_[person];
    const ScheduledPerson& part = *trial_.people[person].spec.part;
    if (stay.activity == HomeActivity::away) {
      if (state_[person] == State::present) line.at(stay.from_s, action::Leave{door_});
      state_[person] = State::away;
      return;
    }
    // Whoever finds the toilet taken goes on with what they did.
    if (spot == nullptr && state_[person] == State::present && is_alone_at(stay.activity)) return;
    if (state_[person] == State::unborn && part.part == SchedulePart::resident) {
      line.at(stay.from_s, action::Appear{{}, 0.0, part.seat});
    } else if (state_[person] != State::present) {
      line.at(stay.from_s, action::Enter{door_});
    }
    const bool was_there = state_[person] != State::unborn;
    state_[person] = State::present;
    const HomeManner manner = manner_of(stay.activity);
    if (spot == nullptr) return line.at(stay.from_s, action::Wait{until_next_s}, manner.phase);
    if (was_there || spot->id != part.seat) line.at(stay.from_s, going_to(*spot), manner.phase);
    const bool is_resident = part.part == SchedulePart::resident;
    if (stay.activity == HomeActivity::cook) return go_about(person, stay, *spot, cooking);
    if (stay.activity == HomeActivity::chores) {
      std::array<double, kinds_of_chores.size()> shares{};
      std::ranges::transform(kinds_of_chores, shares.begin(), &Chore::share);
      return go_about(person, stay, *spot, kinds_of_chores[pick(errands_[person], shares)].footwork);
    }
    if (spot->posture == Posture::sit && stay.activity != HomeActivity::toilet && is_resident)
      return sit_and_get_up(person, stay, *spot);
    be_at(person, stay.activity, *spot, stay.to_s - stay.from_s);
  }

  /// Having got there.
  void be_at(std::size_t person, HomeActivity activity, const Spot& spot, double for_s) {
    const HomeManner manner = manner_of(activity);
    if (activity != HomeActivity::work || spot.posture != Posture::sit)
      return lines_[person].then(action::Wait{until_next_s, fitting(manner.activity, spot.posture)}, manner.phase);
    for (const action::Work& work : draw_desk_work(conduct_[person], for_s)) lines_[person].then(work, manner.phase);
  }

  /// From stop to stop until something else is due.
  void go_about(std::size_t person, const HomeStay& stay, const Spot& own, const Footwork& footwork) {
    const HomeManner manner = manner_of(stay.activity);
    ActionLine& line = lines_[person];
    const Spot* by = &own;
    for (double now = stay.from_s; now < stay.to_s;) {
      const auto place = next_place(person, by, own, footwork, now);
      line.then(place ? Action(action::Walk{{*place}}) : going_to(own), manner.phase);
      const double stop_s = shortest_s + exponential(errands_[person], footwork.stop_s - shortest_s);
      line.then(action::Wait{stop_s, fitting(manner.activity, place ? Posture::stand : own.posture)}, manner.phase);
      now += stop_s;
    }
  }

  /// Now and then they get up for something: a drink, the phone, the window. Then they come back.
  void sit_and_get_up(std::size_t person, const HomeStay& stay, const Spot& seat) {
    constexpr double way_s = 10.0;  // about, to a stop
    const char* phase = manner_of(stay.activity).phase;
    const double mean_s = calm_[person] * (stay.activity == HomeActivity::work  ? sits_at_work_s
                                           : stay.activity == HomeActivity::eat ? sits_at_meals_s
                                                                                : sits_s);
    Stream& stream = errands_[person];
    for (double now = stay.from_s;;) {
      const double up_s = now + about(stream, mean_s, sits_log_sd);
      double back_s = up_s + way_s;
      std::vector<std::pair<Vec2, double>> stops;
      const Spot* by = &seat;
      do {
        const double stop_s = shortest_s + exponential(stream, errand.stop_s - shortest_s);
        if (const auto place = next_place(person, by, seat, errand, up_s)) stops.emplace_back(*place, stop_s);
        back_s += way_s + stop_s;
      } while (stream.uniform() < further_stop);
      const bool gets_up = !stops.empty() && back_s < stay.to_s;
      be_at(person, stay.activity, seat, (gets_up ? up_s : stay.to_s) - now);
      if (!gets_up) return;
      ActionLine& line = lines_[person];
      bool first = true;
      for (const auto& [place, stop_s] : stops) {
        const action::Walk walk{{place}};
        first ? line.at(up_s, walk, phase) : line.then(walk, phase);
        line.then(action::Wait{stop_s}, phase);
        first = false;
      }
      line.then(going_to(seat), phase);
      now = back_s;
    }
  }

  /// Where the next stop of somebody by a spot is; none: at their own place, or where they are. Others who want to be
  /// alone stay so.
  std::optional<Vec2> next_place(std::size_t person, const Spot*& by, const Spot& own, const Footwork& footwork,
                                 double at_s) {
    constexpr double within_m = 3.0, at_spot_m = 2.0;  // assumed (2-4, 1.5-2.5)
    const double u = errands_[person].uniform();
    if (u < footwork.here) return near(person, *by, within_m);
    const bool is_own = u >= footwork.here + footwork.kitchen + footwork.elsewhere;
    const Spot* const other =
        is_own ? &own : in_other_room(person, *by, at_s, u < footwork.here + footwork.kitchen ? "cook" : "");
    if (other == nullptr) return near(person, *by, within_m);
    by = other;
    return is_own ? std::nullopt : near(person, *by, at_spot_m);
  }

  std::optional<Vec2> near(std::size_t person, const Spot& spot, double within_m) {
    constexpr std::size_t most = 8;  // of which the first may lie behind a wall
    for (const Vec2& place : places_[person].around(spot.point, within_m, most, errands_[person]))
      if (room_of(study_.scene(), place) == spot.room) return place;
    return std::nullopt;
  }

  /// A spot of that use, or of any, in one of the rooms that have some; none: nullptr.
  const Spot* in_other_room(std::size_t person, const Spot& by, double at_s, std::string_view use) {
    Stream& stream = errands_[person];
    std::map<std::size_t, std::vector<const Spot*>> rooms;
    for (const Spot& spot : spots_) {
      if (spot.room != by.room && (use.empty() || is_for(spot, use)) && !is_private(spot.room, person, at_s))
        rooms[spot.room].push_back(&spot);
    }
    if (rooms.empty()) return nullptr;
    const auto& spots = std::next(rooms.begin(), stream.index(static_cast<std::uint32_t>(rooms.size())))->second;
    return spots[stream.index(static_cast<std::uint32_t>(spots.size()))];
  }

  /// Whether somebody else sleeps or washes there.
  [[nodiscard]] bool is_private(std::size_t room, std::size_t person, double at_s) const {
    return std::ranges::any_of(planned_, [&](const PlannedStay& planned) {
      const auto [activity, from_s, to_s] = planned.stay;
      return (activity == HomeActivity::sleep || is_alone_at(activity)) && planned.person != person &&
             planned.spot != nullptr && planned.spot->room == room && from_s <= at_s && at_s < to_s;
    });
  }

  static Action going_to(const Spot& spot) {
    switch (spot.posture) {
      case Posture::sit:
        return action::Sit{spot.id};
      case Posture::lie:
        return action::Lie{spot.id};
      case Posture::stand:
        break;
    }
    return action::Stand{spot.id};
  }

  /// What a person of natural style can do in that posture.
  static std::optional<Activity> fitting(std::optional<Activity> activity, Posture posture) {
    if (!activity) return std::nullopt;
    const bool is_standing = *activity == Activity::cooking || *activity == Activity::washing;
    if (*activity == Activity::sleeping) return posture == Posture::lie ? activity : std::nullopt;
    if (*activity == Activity::eating) return posture == Posture::sit ? activity : std::nullopt;
    return is_standing == (posture == Posture::stand) ? activity : std::nullopt;
  }

  static bool is_alone_at(HomeActivity activity) {
    return activity == HomeActivity::toilet || activity == HomeActivity::wash;
  }

  /// Sleepers have their own. Of others the first that is free, beginning with another for each person. Where none is,
  /// they wait for a toilet or a place to wash, and do anything else where they could rest.
  void take_spot(PlannedStay& planned) {
    constexpr double least_s = minute_s;
    auto& [person, stay, spot] = planned;
    if (stay.activity == HomeActivity::away) return;
    const HomeManner manner = manner_of(stay.activity);
    spot = free_spot(person, stay, manner.uses);
    if (spot == nullptr && is_alone_at(stay.activity)) {
      for (Spot& one : spots_)
        if (is_for(one, manner.uses.front()) && (spot == nullptr || one.taken_until_s < spot->taken_until_s))
          spot = &one;
      if (spot != nullptr && spot->taken_until_s + least_s > stay.to_s) spot = nullptr;
      if (spot != nullptr) stay.from_s = spot->taken_until_s;
    } else if (spot == nullptr) {
      spot = free_spot(person, stay, manner_of(HomeActivity::rest).uses);
    }
    if (spot != nullptr) spot->taken_until_s = stay.to_s;
  }

  Spot* free_spot(std::size_t person, const HomeStay& stay, const std::vector<std::string_view>& uses) {
    const std::string& bed = trial_.people[person].spec.part->seat;
    if (stay.activity == HomeActivity::sleep && !bed.empty()) return &*std::ranges::find(spots_, bed, &Spot::id);
    const auto is_free = [&](const Spot& spot) {
      return spot.taken_until_s <= stay.from_s &&
             (spot.posture != Posture::sit || trial_.people[person].can_use(spot.id));
    };
    for (const std::string_view use : uses) {
      // Each person their own of those that are for it before all, then of those that will do; by others' beds, last.
      std::array<std::vector<Spot*>, 4> ranks;
      for (Spot& spot : spots_)
        if (is_for(spot, use))
          ranks[(spot.uses.front() == use ? 0 : 1) + (is_bedroom_of_others(spot.room, person) ? 2 : 0)].push_back(
              &spot);
      for (const std::vector<Spot*>& spots : ranks) {
        for (std::size_t k = 0; k < spots.size(); ++k)
          if (Spot* const spot = spots[(person + k) % spots.size()]; is_free(*spot)) return spot;
      }
    }
    for (Spot& spot : spots_)
      if (spot.uses.empty() && spot.posture == Posture::sit && is_free(spot)) return &spot;
    return nullptr;
  }

  /// Whether somebody has a bed there, but not this one.
  [[nodiscard]] bool is_bedroom_of_others(std::size_t room, std::size_t person) const {
    bool is_others = false;
    for (std::size_t i = 0; i < trial_.people.size(); ++i) {
      const auto& part = trial_.people[i].spec.part;
      if (!part || part->seat.empty()) continue;
      const auto bed = std::ranges::find(spots_, part->seat, &Spot::id);
      if (bed == spots_.end() || bed->room != room) continue;
      if (i == person) return false;
      is_others = true;
    }
    return is_others;
  }

  const CompiledStudy& study_;
  const TrialModel& trial_;
  const ScheduleSpec& schedule_;
  std::vector<Spot> spots_;
  std::string door_;
  std::vector<ActionLine> lines_;
  std::vector<State> state_;
  std::vector<Stream> conduct_, errands_;  ///< (n_people) at the desk, on foot
  std::vector<double> calm_;               ///< (n_people) how much longer than others they stay seated
  std::vector<StandingPlaces> places_;     ///< (n_people)
  HomeDay drawn_;
  std::vector<PlannedStay> planned_;
};

}  // namespace

double night_visits(double age_years) {
  // Share of men and women who get up at all, averaged: 20-39, 40-59, 60 and older. Ref: [Soysal2023].
  const double share = age_years < 40.0   ? 0.5 * (0.568 + 0.689)
                       : age_years < 60.0 ? 0.5 * (0.702 + 0.743)
                                          : 0.5 * (0.827 + 0.847);
  return -std::log(1.0 - share);
}

HomeDay draw_home_day(const HouseholdSpec& household, std::uint64_t seed, std::uint32_t run, std::int64_t day) {
  const bool works = is_working_day(day);
  const auto today = [&](std::size_t i) { return works ? household.residents[i].occupation : Occupation::at_home; };
  std::vector<StayLine> days(household.residents.size(), StayLine(HomeActivity::rest));
  std::vector<Stream> streams;
  std::vector<Nights> nights;
  for (std::size_t i = 0; i < days.size(); ++i) {
    Stream& stream = streams.emplace_back(StreamKey{seed, run, static_cast<std::uint32_t>(i), Purpose::home_day});
    const double wakes_s = around(stream, works ? household.wakes : household.wakes_on_free_days);
    const double goes_to_bed_s = around(stream, household.goes_to_bed);
    nights.push_back({std::clamp(wakes_s, home_day_begins_s, home_day_ends_s),
                      std::clamp(goes_to_bed_s, std::max(wakes_s, home_day_begins_s), home_day_ends_s)});
    sleep_and_wash(days[i], nights[i], stream);
    spend_the_day(days[i], household, today(i), stream);
  }
  Stream together({seed, run, 0, Purpose::home_meals});
  const double lunch_at_s = around(together, household.lunch), dinner_at_s = around(together, household.dinner);
  have_meal(days, lunch_at_s, lunch_cooking_s, lunch_s, together);
  have_meal(days, dinner_at_s, dinner_cooking_s, dinner_s, together);
  HomeDay drawn;
  constexpr double visit_h = 19.5, visit_sd_h = 1.0, visit_mean_s = 2.0 * hour_s;  // assumed (18-21 h, 1-3 h)
  const double visited = together.uniform(), comes_s = (visit_h + visit_sd_h * cut_normal(together)) * hour_s;
  const double goes_s = comes_s + about(together, visit_mean_s);
  if (visited < household.visits_a_week / 7.0) drawn.visits.push_back({comes_s, goes_s});
  for (std::size_t i = 0; i < days.size(); ++i) {
    pass_the_time(days[i], streams[i]);
    if (today(i) == Occupation::works_at_home) take_breaks(days[i], streams[i]);
    go_to_the_toilet(days[i], nights[i], household.residents[i].age_years, streams[i]);
    drawn.residents.push_back(days[i].joined());
  }
  return drawn;
}

std::int64_t day_of(const CompiledStudy& study, std::uint32_t run) { return study.clock_of(run)->begin_day(); }

DayDraw draw_times(const CompiledStudy& study, std::uint32_t run) {
  const TrialModel& trial = study.trial_of(run);
  std::vector<std::optional<DayPerson>> people;
  for (const PersonModel& person : trial.people) {
    const auto& part = person.spec.part;
    people.push_back(part ? std::optional(DayPerson{part->part, part->role, part->room}) : std::nullopt);
  }
  std::vector<int> most_at_meeting;
  for (std::size_t room = 0; room < trial.schedule->meetings.size(); ++room)
    most_at_meeting.push_back(pirsim::most_at_meeting(*trial.schedule, room, study.scene()));
  return draw_times(DaySource{*trial.schedule, people, most_at_meeting, study.seed(), run, day_of(study, run)});
}

DayPlan draw_day(const CompiledStudy& study, std::uint32_t run) {
  return study.trial_of(run).schedule->household ? plan_home_day(study, run) : Day(study, run).plan();
}

HomeManner manner_of(HomeActivity activity) {
  switch (activity) {
    case HomeActivity::sleep:
      return {"sleeping", Activity::sleeping, {"sleep"}};
    case HomeActivity::toilet:
      return {"toilet", std::nullopt, {"toilet"}};
    case HomeActivity::wash:
      return {"washing", Activity::washing, {"wash", "shower", "dress"}};
    case HomeActivity::cook:
      return {"cooking", Activity::cooking, {"cook"}};
    case HomeActivity::eat:
      return {"eating", Activity::eating, {"eat"}};
    case HomeActivity::chores:
      return {"chores", Activity::cooking, {"chores", "cook", "wash"}};
    case HomeActivity::tv:
      return {"watching_tv", Activity::watching_tv, {"tv", "rest"}};
    case HomeActivity::read:
      return {"reading", Activity::reading, {"read", "rest", "tv"}};
    case HomeActivity::hobby:
      return {"hobby", Activity::reading, {"work", "play", "eat"}};
    case HomeActivity::rest:
      return {"resting", Activity::watching_tv, {"rest", "tv", "eat"}};
    case HomeActivity::work:
      return {"working", Activity::typing, {"work"}};
    case HomeActivity::away:
      break;
  }
  return {"away", std::nullopt, {}};
}

std::size_t n_places_for(const SceneSpec& scene, HomeActivity activity) {
  const std::vector<std::string_view> uses = manner_of(activity).uses;
  const std::vector<Spot> spots = spots_of(scene);
  return static_cast<std::size_t>(std::ranges::count_if(spots, [&](const Spot& spot) {
    return (spot.uses.empty() && spot.posture == Posture::sit) ||
           std::ranges::any_of(uses, [&](std::string_view use) { return is_for(spot, use); });
  }));
}

DayPlan plan_home_day(const CompiledStudy& study, std::uint32_t run) { return HomeDayPlan(study, run).take(); }

}  // namespace pirsim::sim
