#include "sim/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "pirsim/geometry.hpp"
#include "sim/action_line.hpp"
#include "sim/day_draw.hpp"
#include "sim/home_plan.hpp"
#include "sim/standing_places.hpp"

namespace pirsim::sim {
namespace {

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
    for (double left_s = for_s; left_s > 0.0;) {
      action::Work work = draw_desk_work(stream);
      left_s -= work.duration_s;
      if (left_s <= 0.0) work.duration_s = until_next_s;
      line.then(work);
    }
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

}  // namespace

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

}  // namespace pirsim::sim
