// A day of a schedule as times and places, before anybody has walked anywhere.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/study/people.hpp"
#include "pirsim/random.hpp"

namespace pirsim::sim {

inline constexpr double minute_s = 60.0, hour_s = 3600.0;

/// Index drawn with these weights.
[[nodiscard]] std::size_t pick(Stream& stream, std::span<const double> weights);
[[nodiscard]] double cut_normal(Stream& stream);                      ///< standard, cut at three
[[nodiscard]] double around(Stream& stream, const ClockSpec& clock);  ///< seconds of the day
[[nodiscard]] double exponential(Stream& stream, double mean);

/// The first four are those of the chain; lunch comes beside it.
enum class Place { desk, others_desk, meeting, outside, lunch };
inline constexpr std::size_t n_places = 4;

/// Of staff, in order of time and without gaps between arrival and departure. Times are seconds of the day.
struct Stay {
  Place place = Place::desk;
  double from_s = 0.0, to_s = 0.0;
  /// Whose desk, as an index into the day's people; none: somewhere else in the building.
  std::optional<std::size_t> host{};
  std::optional<std::size_t> meeting{};  ///< an index into the day's; none: they meet somewhere else
};

struct Attendance {
  std::size_t person = 0;
  double comes_s = 0.0, goes_s = 0.0;
  std::optional<double> presents_until_s{};  ///< stands at the screen from the meeting's beginning
};

struct Meeting {
  std::size_t room = 0;  ///< index into the schedule's meetings
  double begin_s = 0.0, end_s = 0.0;
  std::vector<Attendance> people;
};

/// All of it empty on days off.
struct DayDraw {
  std::vector<std::vector<Stay>> stays;  ///< (n_people) empty for who isn't staff
  std::vector<Meeting> meetings;         ///< of guests, room by room, then of the staff; each in order of time
  std::optional<double> cleaning_s;
};

struct DayPerson {
  SchedulePart part = SchedulePart::staff;
  Role role = Role::staff;  ///< of staff
  std::size_t room = 0;     ///< of guests
};

/// What a day is drawn from.
struct DaySource {
  const ScheduleSpec& schedule;
  std::span<const std::optional<DayPerson>> people;  ///< of the trial; none for who is no part of the schedule
  std::span<const int> most_at_meeting;              ///< (n_rooms) of each of the schedule's meetings
  std::uint64_t seed = 1;
  std::uint32_t run = 0;
  std::int64_t day = 0;
};

[[nodiscard]] DayDraw draw_times(const DaySource& source);

/// What somebody does at a desk in so long, one thing after the other; the last goes on until the next action.
[[nodiscard]] std::vector<action::Work> draw_desk_work(Stream& stream, double for_s);

/// Share of time in each Place and mean stay. Ref: [ChenHongLuo2018].
struct Habits {
  std::array<double, n_places> shares;
  std::array<double, n_places> stays_min;
};
[[nodiscard]] Habits habits_of(Role role);

/// Stays are exponential beyond this, so that their mean is the published one; assumed: nobody gets up for less.
inline constexpr double shortest_stay_s = 120.0;

/// Rates of a Markov chain over places from the share of time spent in each and the mean stay, in any one unit of time:
/// (i x n + j) is the rate from i to j. Solves x_i (sum x - x_i) = share_i / stay_i. Ref: [ChenHongLuo2018].
[[nodiscard]] std::vector<double> markov_rates(std::span<const double> shares, std::span<const double> stays);

}  // namespace pirsim::sim
