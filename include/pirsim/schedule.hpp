// When people are in the room, drawn a day at a time from published models of occupancy, as plain data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pirsim/error.hpp"

namespace pirsim {

/// How people move beside their choreography.
enum class MotionStyle {
  choreographed,  ///< as the paper's: nothing moves that the script doesn't say; forearms swing steadily
  natural         ///< stillness and small movements by turns, breathing, a pace of one's own
};

/// A time of day: normal, cut at three standard deviations.
struct ClockSpec {
  double mean_h = 0.0;
  double sd_min = 30.0;
  bool operator==(const ClockSpec&) const = default;
};

/// Shares of time and mean stays by role. Ref: [ChenHongLuo2018].
enum class Role { staff, manager, administrator };

struct StaffSpec {
  Role role = Role::staff;
  int count = 1;
  std::vector<std::string> seats;  ///< their own desks; none: the scene's seats that nobody has, in order
  Where where;
  bool operator==(const StaffSpec&) const = default;
};

/// A meeting whose time is known.
struct HeldMeetingSpec {
  double at_h = 10.0;
  double duration_min = 60.0;
  int people = 4;
  Where where;
  bool operator==(const HeldMeetingSpec&) const = default;
};

/// Who sits in meetings: people who come for them, or the staff who are at work then.
enum class Attendees { guests, staff };

/// Meetings that are held in one room of the scene. Ref: [ChenHongLuo2018].
struct MeetingsSpec {
  Attendees attendees = Attendees::guests;
  std::string area;  ///< where the room is one of several
  int fewest_a_day = 2, most_a_day = 6;
  int fewest_people = 2;
  std::optional<int> most_people;  ///< none: 8, or as many as there are seats
  std::vector<double> durations_min{30.0, 60.0, 90.0, 120.0};
  std::vector<double> probabilities{0.13, 0.70, 0.12, 0.05};
  double from_h = 9.0, to_h = 18.0;  ///< assumed: when they begin and end
  double lateness_min = 2.0;  ///< mean of how much later than its beginning people come (`assumed`; 0 to 5 tried)
  std::vector<HeldMeetingSpec> held;  ///< these, every working day, instead of drawn ones
  std::vector<std::string> seats;     ///< none: those of the area that are nobody's own desk
  Where where;
  bool operator==(const MeetingsSpec&) const = default;
};

/// Where a resident is on working days.
enum class Occupation {
  works,         ///< away from `leaves` to `comes_home`
  at_home,       ///< retired, or on leave
  works_at_home  ///< at a place for work at these times, but for meals and breaks
};

struct ResidentSpec {
  std::string id;
  Occupation occupation = Occupation::at_home;
  double age_years = 45.0;  ///< how often somebody gets up at night goes by it
  std::string bed;          ///< a place to lie; empty: one of the scene's for sleep that nobody has, in order
  Where where;
  bool operator==(const ResidentSpec&) const = default;
};

/// Who lives in a home, and when their days begin and end. A day goes from 04:00 to 04:00, when nearly everybody
/// sleeps, as a diary's in surveys of time use. `assumed`, unless said: clocks, to sleep 8:39 h and to work 7:24 h with
/// the ways there. Ref: [Idescat2011].
struct HouseholdSpec {
  std::vector<ResidentSpec> residents;  ///< one to five
  double visits_a_week = 1.0;           ///< evenings on which somebody comes (`assumed`; 0 to 3 tried)
  ClockSpec wakes{7.0, 30.0}, wakes_on_free_days{8.5, 45.0}, goes_to_bed{23.0, 30.0};
  ClockSpec leaves{8.25, 20.0}, comes_home{17.25, 40.0};
  ClockSpec lunch{13.0, 20.0}, dinner{19.5, 30.0};
  bool operator==(const HouseholdSpec&) const = default;
};

inline constexpr double home_from_h = 4.0, home_to_h = 28.0;  ///< of a household's day

/// What the replicates of a trial are: days that follow each other.
struct ScheduleSpec {
  std::string first_day = "2026-03-02";  ///< ISO 8601; a Monday
  double from_h = 0.0, to_h = 24.0;      ///< the part of the day that a run simulates
  std::vector<StaffSpec> staff;
  std::vector<MeetingsSpec> meetings;      ///< of each room in which some are held
  std::optional<HouseholdSpec> household;  ///< instead of staff, meetings and cleaning
  ClockSpec arrival{8.5, 30.0}, departure{17.5, 30.0}, lunch{12.0, 30.0};
  double lunch_min = 60.0, lunch_sd_min = 15.0;
  std::optional<double> cleaning_h;    ///< somebody cleans then, on working days
  std::vector<std::string> entrances;  ///< that people use, each their own; none: all of the scene
  MotionStyle style = MotionStyle::natural;
  Where where;
  bool operator==(const ScheduleSpec&) const = default;
};

}  // namespace pirsim
