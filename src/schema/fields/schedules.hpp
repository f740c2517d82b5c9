// Fields of days at work and at home (schema/fields.hpp).
#pragma once

#include <algorithm>
#include <tuple>

#include "pirsim/schedule.hpp"
#include "schema/field.hpp"
#include "schema/fields/accepted.hpp"
#include "schema/words.hpp"

namespace pirsim {

template <>
struct Fields<ClockSpec> {
  using S = ClockSpec;
  static constexpr const char* name = "Clock";
  static constexpr const char* about = "A time of day: normal, cut at three standard deviations.";
  static constexpr std::tuple all{FIELD(mean_h, accepted::hour_of_day),
                                  FIELD(sd_min, NumberRange{.min = 0.0, .max = 240.0})};
};
template <>
struct Fields<StaffSpec> {
  using S = StaffSpec;
  static constexpr auto enough_for_seats = [](const StaffSpec& staff) {
    return IntegerRange{.min = std::max(1LL, static_cast<long long>(staff.seats.size())), .max = 200};
  };
  static constexpr const char* name = "Staff";
  static constexpr const char* about = "People of one role.";
  static constexpr std::tuple all{FIELD(role), FIELD(count, enough_for_seats),
                                  FIELD(seats, "their own desks; none: the scene's seats that nobody has, in order"),
                                  LABEL(where)};
};
template <>
struct Fields<HeldMeetingSpec> {
  using S = HeldMeetingSpec;
  static constexpr const char* name = "HeldMeeting";
  static constexpr const char* about = "A meeting whose time is known.";
  static constexpr std::tuple all{FIELD(at_h, accepted::hour_of_day), FIELD(duration_min, accepted::meeting_min),
                                  FIELD(people, accepted::people_at_once), LABEL(where)};
};
template <>
struct Fields<MeetingsSpec> {
  using S = MeetingsSpec;
  static constexpr auto no_fewer_meetings = [](const MeetingsSpec& meetings) {
    return IntegerRange{.min = meetings.fewest_a_day, .max = accepted::meetings_a_day.max};
  };
  static constexpr auto no_fewer_people = [](const MeetingsSpec& meetings) {
    return IntegerRange{.min = meetings.fewest_people, .max = accepted::people_at_once.max};
  };
  static constexpr const char* name = "Meetings";
  static constexpr const char* about = "Meetings that are held in a room.";
  static constexpr std::tuple all{FIELD(attendees, "who sits in them: people who come for them, or the staff"),
                                  FIELD(area, "where the room is one of several"),
                                  FIELD(fewest_a_day, accepted::meetings_a_day),
                                  FIELD(most_a_day, no_fewer_meetings),
                                  FIELD(fewest_people, accepted::people_at_once),
                                  FIELD(most_people, no_fewer_people, "none: 8, or as many as there are seats"),
                                  FIELD(durations_min, accepted::meeting_min),
                                  FIELD(probabilities, accepted::probability, "of each duration"),
                                  FIELD(from_h, accepted::hour_of_day, "when the first may begin"),
                                  FIELD(to_h, accepted::hour_of_day, "when the last has ended"),
                                  FIELD(lateness_min, NumberRange{.min = 0.0, .max = 60.0},
                                        "mean of how much later than its beginning people come"),
                                  FIELD(held, "these, every working day, instead of drawn ones"),
                                  FIELD(seats, "none: those of the area that are nobody's own desk"),
                                  LABEL(where)};
};
template <>
struct Fields<ResidentSpec> {
  using S = ResidentSpec;
  static constexpr const char* name = "Resident";
  static constexpr const char* about = "Somebody who lives in a home.";
  static constexpr std::tuple all{
      FIELD(id, "as `--occupants` names them"), FIELD(occupation),
      FIELD(age_years, NumberRange{.min = 16.0, .max = 110.0}, "how often they get up at night goes by it"),
      FIELD(bed, "a place to lie; empty: one of the scene's for sleep that nobody has, in order"), LABEL(where)};
};
template <>
struct Fields<HouseholdSpec> {
  using S = HouseholdSpec;
  static constexpr const char* name = "Household";
  static constexpr const char* about = "Who lives in a home; their days go from 04:00 to 04:00.";
  static constexpr std::tuple all{
      FIELD(residents, "one to five"),
      FIELD(visits_a_week, NumberRange{.min = 0.0, .max = 7.0}, "evenings on which somebody comes"),
      FIELD(wakes, "on working days"),
      FIELD(wakes_on_free_days),
      FIELD(goes_to_bed),
      FIELD(leaves, "who works, on working days; who works at home begins then"),
      FIELD(comes_home),
      FIELD(lunch),
      FIELD(dinner)};
};
template <>
struct Fields<ScheduleSpec> {
  using S = ScheduleSpec;
  static constexpr const char* name = "Schedule";
  static constexpr const char* about =
      "Adds people whose actions are drawn anew for every run; replicates are days that follow each other.";
  static constexpr std::tuple all{
      FIELD(first_day, "ISO 8601"),
      FIELD(from_h, accepted::hour_of_day, "the part of the day that a run simulates begins"),
      FIELD(to_h, accepted::hour_or_next_days, "and ends; with a household 28, four o'clock of the next day"),
      FIELD(staff),
      FIELD(meetings, "of each room in which some are held"),
      FIELD(household, "instead of staff, meetings and cleaning"),
      FIELD(arrival),
      FIELD(departure),
      FIELD(lunch),
      FIELD(lunch_min, NumberRange{.min = 0.0, .max = 240.0}, "mean of its length"),
      FIELD(lunch_sd_min, NumberRange{.min = 0.0, .max = 120.0}),
      FIELD(cleaning_h, accepted::hour_of_day, "somebody cleans then, on working days"),
      FIELD(entrances, "that people use, each their own; none: all of the scene"),
      FIELD(style),
      LABEL(where)};
};

}  // namespace pirsim
