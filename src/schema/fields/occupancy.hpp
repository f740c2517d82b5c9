// Fields of people as counts tell them (schema/fields.hpp).
#pragma once

#include <tuple>

#include "pirsim/occupancy.hpp"
#include "schema/field.hpp"
#include "schema/fields/accepted.hpp"
#include "schema/words.hpp"

namespace pirsim {

template <>
struct Fields<AreaCountsSpec> {
  using S = AreaCountsSpec;
  static constexpr const char* name = "AreaCounts";
  static constexpr const char* about = "How many people were in one area, at the moments of `Counts.times_s`.";
  static constexpr std::tuple all{FIELD(area, "its id"), FIELD(people, "at each moment"),
                                  FIELD(column, "of `Counts.file`")};
};
template <>
struct Fields<CountsSpec> {
  using S = CountsSpec;
  static constexpr const char* name = "Counts";
  static constexpr const char* about = "How many people were there, at moments.";
  static constexpr std::tuple all{
      FIELD(times_s, "ascending"),
      FIELD(people, "at each of them, in all"),
      FIELD(areas, "counted by themselves; the rest of the people are elsewhere"),
      FIELD(begin, "local date and time of `times_s` 0; empty: they are seconds of the run"),
      FIELD(file, "CSV, or empty; relative to `Script.directory`; `read_script()` reads it"),
      FIELD(time, "its column of times; empty: found by its usual names"),
      FIELD(column, "its column of people; empty: found by its usual names"),
      LABEL(most)};
};
template <>
struct Fields<StaySpec> {
  using S = StaySpec;
  static constexpr const char* name = "Stay";
  static constexpr const char* about = "Somebody at one place for a while.";
  static constexpr std::tuple all{FIELD(person),
                                  FIELD(seat, "or empty: on foot"),
                                  FIELD(from_s, accepted::at_s),
                                  FIELD(to_s, accepted::at_s),
                                  FIELD(points, "where they were at `from_s` and at `to_s`, if that is known"),
                                  FIELD(then, "to the person's next stay, or outside until that begins"),
                                  LABEL(where)};
};
template <>
struct Fields<PlacesSpec> {
  using S = PlacesSpec;
  static constexpr const char* name = "Places";
  static constexpr const char* about = "Who took which seat, and when.";
  static constexpr std::tuple all{FIELD(stays, "of each person in order of time"),
                                  FIELD(begin, "local date and time of second 0; empty: seconds of the run"),
                                  FIELD(file, "CSV, or empty; relative to `Script.directory`")};
};
template <>
struct Fields<TrackSpec> {
  using S = TrackSpec;
  static constexpr const char* name = "Track";
  static constexpr const char* about = "Where one person was, from moment to moment.";
  static constexpr std::tuple all{FIELD(person), FIELD(times_s, "ascending"), FIELD(points, "at each of them"),
                                  FIELD(headings_deg, "at each of them; empty: facing where they go"), LABEL(where)};
};
template <>
struct Fields<PositionsSpec> {
  using S = PositionsSpec;
  static constexpr const char* name = "Positions";
  static constexpr const char* about = "Tracked people, who go where they went.";
  static constexpr std::tuple all{FIELD(tracks),
                                  FIELD(begin, "local date and time of second 0; empty: seconds of the run"),
                                  FIELD(file, "CSV, or empty; relative to `Script.directory`")};
};
template <>
struct Fields<OccupancySpec> {
  using S = OccupancySpec;
  static constexpr const char* name = "Occupancy";
  static constexpr const char* about =
      "Adds people who are there as data say: one of `counts`, `places` and `positions`.";
  static constexpr std::tuple all{
      FIELD(counts, "who comes, when within an interval, and where they sit is drawn anew for every run"),
      FIELD(places),
      FIELD(positions),
      FIELD(from_h, accepted::hour_of_day, "with either, replicates are the days of the data, each from here"),
      FIELD(to_h, accepted::hour_of_day, "to there"),
      FIELD(changes_within_s, NumberRange{.min = 0.0, .max = 1e7},
            "of counts: a change happened at most so long before its reading; none: since the reading before"),
      FIELD(persons, accepted::people_of_counts,
            "of counts: how many different ones come; none: as many as are ever there"),
      FIELD(seats, "of counts: that may be taken; none: all of the scene"),
      FIELD(entrances, "that people use; none: all of the scene"),
      FIELD(style),
      LABEL(where)};
};

}  // namespace pirsim
