// Who was in the room, and when, as data tell it: counts, seats taken, or positions. Plain data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/schedule.hpp"

namespace pirsim {

/// How many people were in one area, at the moments of the counts that it is a part of.
struct AreaCountsSpec {
  std::string area;
  std::string column;       ///< of the counts' file
  std::vector<int> people;  ///< (n_times)
};
/// How many people were there, at moments.
struct CountsSpec {
  std::string file;                     ///< CSV, or empty; relative to the script
  std::string time, column;             ///< columns of the file; empty: found by their usual names
  std::string begin;                    ///< local date and time of times_s 0; empty: seconds of the run
  std::vector<double> times_s;          ///< ascending
  std::vector<int> people;              ///< (n_times) in all
  std::vector<AreaCountsSpec> areas{};  ///< counted by themselves; the rest of the people are elsewhere
  Where most;                           ///< where the greatest number stands
};

enum class AfterStay {
  goes_on,  ///< to the person's next stay
  leaves    ///< and is outside until that begins
};

/// Somebody at one place for a while.
struct StaySpec {
  std::string person;
  std::string seat;  ///< or empty: on foot
  double from_s = 0.0, to_s = 0.0;
  std::vector<Vec2> points;  ///< where they were at from_s and at to_s, if that is known
  AfterStay then = AfterStay::goes_on;
  Where where;
};
/// Who took which seat, and when.
struct PlacesSpec {
  std::string file;             ///< CSV, or empty; relative to the script
  std::string begin;            ///< as CountsSpec's
  std::vector<StaySpec> stays;  ///< of each person in order of time
};

/// Where one person was, from moment to moment.
struct TrackSpec {
  std::string person;
  std::vector<double> times_s;       ///< ascending
  std::vector<Vec2> points;          ///< (n_times)
  std::vector<double> headings_deg;  ///< (n_times) or empty: facing where they go
  Where where;
};
struct PositionsSpec {
  std::string file;   ///< CSV, or empty; relative to the script
  std::string begin;  ///< as CountsSpec's
  std::vector<TrackSpec> tracks;
};

/// Adds people to a trial who are there as data say. One of counts, places and positions.
struct OccupancySpec {
  std::optional<CountsSpec> counts;
  std::optional<PlacesSpec> places;
  std::optional<PositionsSpec> positions;
  /// With either, replicates are the days of the data one after the other, each from here to there; the data have a
  /// clock then.
  std::optional<double> from_h, to_h;
  std::optional<double> changes_within_s;  ///< of counts: a change happened at most so long before its reading
  std::optional<int> persons;              ///< of counts: how many different ones come; none: as many as are ever there
  std::vector<std::string> seats;          ///< of counts: that may be taken; none: all of the scene
  std::vector<std::string> entrances;      ///< that people use; none: all of the scene
  MotionStyle style = MotionStyle::natural;
  Where where;
};

}  // namespace pirsim
