#include "studies/schedule_outlook.hpp"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <set>

#include "core/text.hpp"
#include "schema/clock.hpp"
#include "sim/schedule.hpp"

namespace pirsim::studies {
namespace {

/// Somebody is in the room from one moment of the day to another.
struct Visit {
  std::size_t person;
  double from_s, to_s;
};

bool is_in_room(const sim::Stay& stay) {
  return stay.place == sim::Place::desk || (stay.place == sim::Place::others_desk && stay.host) || stay.meeting;
}

std::vector<Visit> visits_of(const sim::DayDraw& draw) {
  std::vector<Visit> visits;
  for (std::size_t i = 0; i < draw.stays.size(); ++i) {
    for (const sim::Stay& stay : draw.stays[i]) {
      if (is_in_room(stay)) visits.push_back({i, stay.from_s, stay.to_s});
    }
  }
  for (const sim::Meeting& meeting : draw.meetings) {
    for (const sim::Attendance& who : meeting.people) visits.push_back({who.person, who.comes_s, who.goes_s});
  }
  return visits;
}

void note_most(ScheduleOutlook& outlook, const sim::DayDraw& draw, std::int64_t day) {
  const std::vector<Visit> visits = visits_of(draw);
  for (const Visit& one : visits) {
    std::set<std::size_t> people;  // who goes from one meeting to the next is one
    for (const Visit& other : visits) {
      if (other.from_s <= one.from_s && one.from_s < other.to_s) people.insert(other.person);
    }
    if (people.size() <= outlook.most_at_once) continue;
    outlook.most_at_once = people.size();
    outlook.most_when = clock_text(day, one.from_s);
  }
}

void note_person(ExpectedPerson& person, const std::vector<sim::Stay>& stays) {
  const auto first = std::ranges::find_if(stays, is_in_room);
  if (first == stays.end()) return;
  const auto last = std::ranges::find_if(stays.rbegin(), stays.rend(), is_in_room);
  if (!person.first_arrival_s) {
    person.first_arrival_s = first->from_s;
    person.first_departure_s = last->to_s;
  }
  ++person.days;
  person.mean_arrival_s += first->from_s;
  person.mean_departure_s += last->to_s;
  for (const sim::Stay& stay : stays) person.mean_present_s += is_in_room(stay) ? stay.to_s - stay.from_s : 0.0;
}

std::string clock(double seconds) { return seconds >= 86400.0 ? "24:00" : clock_text(0, seconds).substr(11, 5); }

void print_person(std::ostream& out, const ExpectedPerson& person) {
  out << "  " << std::left << std::setw(16) << person.id << " seat " << std::setw(5) << person.seat << std::right;
  if (person.days == 0) {
    out << " never comes\n";
    return;
  }
  out << " first day " << clock(*person.first_arrival_s) << '-' << clock(*person.first_departure_s) << ", mean of "
      << counted(static_cast<std::size_t>(person.days), "day") << ' ' << clock(person.mean_arrival_s) << '-'
      << clock(person.mean_departure_s) << ", in the room for " << std::fixed << std::setprecision(1)
      << person.mean_present_s / 3600.0 << " h\n";
}

}  // namespace

ScheduleOutlook outlook(const sim::CompiledStudy& study, std::size_t trial, int most_days) {
  const sim::TrialModel& model = study.trials()[trial];
  const auto n_trials = static_cast<std::uint32_t>(study.trials().size());
  ScheduleOutlook result;
  result.first_day = sim::day_of(study, static_cast<std::uint32_t>(trial));
  result.days =
      static_cast<int>(std::min<std::uint32_t>(study.n_runs() / n_trials, static_cast<std::uint32_t>(most_days)));
  std::vector<std::size_t> staff;
  for (std::size_t i = 0; i < model.people.size(); ++i) {
    const auto& part = model.people[i].spec.part;
    if (!part || part->part != SchedulePart::staff) continue;
    staff.push_back(i);
    result.staff.push_back({model.people[i].spec.id, part->seat, 0, {}, {}, 0.0, 0.0, 0.0});
  }
  double cleaning_s = 0.0;
  int cleanings = 0;
  std::set<std::string> seats;
  for (int k = 0; k < result.days; ++k) {
    const auto run = static_cast<std::uint32_t>(k) * n_trials + static_cast<std::uint32_t>(trial);
    const std::int64_t day = sim::day_of(study, run);
    const sim::DayDraw draw = sim::draw_times(study, run);
    result.working_days += is_working_day(day) ? 1 : 0;
    for (std::size_t i = 0; i < staff.size(); ++i) {
      note_person(result.staff[i], draw.stays[staff[i]]);
      if (!draw.stays[staff[i]].empty()) seats.insert(result.staff[i].seat);
    }
    for (const sim::Meeting& meeting : draw.meetings) {
      result.meetings.push_back(
          {day, meeting.begin_s, meeting.end_s, meeting.people.size(), model.schedule->meetings[meeting.room].area});
    }
    if (draw.cleaning_s) cleaning_s += *draw.cleaning_s, ++cleanings;
    note_most(result, draw, day);
  }
  for (ExpectedPerson& person : result.staff) {
    const double n = std::max(1, person.days);
    person.mean_arrival_s /= n, person.mean_departure_s /= n, person.mean_present_s /= n;
  }
  if (cleanings > 0) result.mean_cleaning_s = cleaning_s / cleanings;
  std::ranges::stable_sort(result.meetings, {},
                           [](const ExpectedMeeting& meeting) { return std::pair(meeting.day, meeting.begin_s); });
  for (std::size_t room = 0; room < model.schedule->meetings.size() && !result.meetings.empty(); ++room) {
    for (const std::string& seat : meeting_seats(*model.schedule, room, study.scene())) seats.insert(seat);
  }
  for (const SeatSpec& seat : study.scene().seats) {
    if (seats.contains(seat.id)) result.seats.push_back(seat.id);
  }
  return result;
}

void print(std::ostream& out, const ScheduleOutlook& outlook, const sim::CompiledStudy& study) {
  constexpr std::size_t most_told = 12;
  const ScheduleSpec& schedule = *study.trials().front().schedule;
  out << "schedule: " << counted(static_cast<std::size_t>(outlook.days), "day") << " from "
      << clock_text(outlook.first_day, 0.0).substr(0, 10) << " ("
      << counted(static_cast<std::size_t>(outlook.working_days), "working day") << "), each from "
      << clock(3600.0 * schedule.from_h) << " to " << clock(3600.0 * schedule.to_h)
      << "; times as drawn for whole days, before anybody has walked\n";
  for (const ExpectedPerson& person : outlook.staff) print_person(out, person);
  if (!schedule.meetings.empty()) out << "  meetings: " << outlook.meetings.size() << '\n';
  for (std::size_t i = 0; i < std::min(most_told, outlook.meetings.size()); ++i) {
    const ExpectedMeeting& meeting = outlook.meetings[i];
    out << "    " << clock_text(meeting.day, meeting.begin_s).substr(0, 16) << '-' << clock(meeting.end_s) << ", "
        << counted(static_cast<std::size_t>(meeting.people), "person", "people")
        << (meeting.area.empty() ? "" : " in " + meeting.area) << '\n';
  }
  if (outlook.meetings.size() > most_told) out << "    and so on\n";
  if (outlook.mean_cleaning_s) out << "  cleaning about " << clock(*outlook.mean_cleaning_s) << " on working days\n";
  out << "  at most " << outlook.most_at_once << " at once";
  if (!outlook.most_when.empty()) out << ", first at " << outlook.most_when;
  out << "; seats that are used:";
  for (const std::string& seat : outlook.seats) out << ' ' << seat;
  if (outlook.seats.empty()) out << " none";
  out << "\n\n";
}

}  // namespace pirsim::studies
