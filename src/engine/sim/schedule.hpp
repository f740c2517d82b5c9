// A day at home as activities and times, before anybody has walked anywhere.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/sim/compiled_study.hpp"
#include "pirsim/schedule.hpp"

namespace pirsim::sim {

enum class HomeActivity { sleep, toilet, wash, cook, eat, chores, tv, read, hobby, rest, work, away };
inline constexpr std::size_t n_home_activities = 12;

/// A day of a household begins here, as seconds of its date, and lasts 24 hours.
inline constexpr double home_day_begins_s = 3600.0 * home_from_h;

/// Times are seconds of the day's date; those after midnight are beyond 24 hours.
struct HomeStay {
  HomeActivity activity = HomeActivity::sleep;
  double from_s = 0.0, to_s = 0.0;
};

struct Visit {
  double comes_s = 0.0, goes_s = 0.0;
};

struct HomeDay {
  std::vector<std::vector<HomeStay>> residents;  ///< (n_residents) in order of time, without gaps, no two alike
  std::vector<Visit> visits;                     ///< at most one
};

/// A day, in days since 1970, that run `run` simulates. The same seed gives the same days, and one resident more
/// changes nobody else's but for meals.
[[nodiscard]] HomeDay draw_home_day(const HouseholdSpec& household, std::uint64_t seed, std::uint32_t run,
                                    std::int64_t day);

/// What a day has of something that people do where they have the time: on how many days, and how long then.
/// Ref: [Idescat2011], Catalonia, people of ten years and older.
struct Pastime {
  HomeActivity activity;
  double participation;  ///< share of days
  double mean_min;       ///< of those days; log-normal
  double session_min;    ///< `assumed`: mean of one session
};
inline constexpr std::array<Pastime, 4> pastimes{{{HomeActivity::tv, 0.787, 143.0, 70.0},
                                                  {HomeActivity::read, 0.211, 74.0, 40.0},
                                                  {HomeActivity::hobby, 0.318, 111.0, 60.0},
                                                  {HomeActivity::chores, 0.60, 78.0, 40.0}}};

/// How often somebody goes to the toilet at night, on average. Ref: [Soysal2023], share of adults who do at all in
/// three groups of age, both sexes, as a Poisson distribution has it.
[[nodiscard]] double night_visits(double age_years);

// A schedule's day as actions in a room: what was drawn as times and places, with the seats and ways that it takes.

struct DayDraw;

/// Actions of every person of a trial on one day, in the order of its people; times are seconds of the run.
using DayPlan = std::vector<std::vector<ScriptedAction>>;

/// Days since 1970-01-01 of the day that a run simulates: replicates are days that follow each other.
[[nodiscard]] std::int64_t day_of(const CompiledStudy& study, std::uint32_t run);

/// The times and places of that day. The same seed gives the same days. The run is of a trial with a schedule.
[[nodiscard]] DayDraw draw_times(const CompiledStudy& study, std::uint32_t run);
/// The actions of that day. People without a part in the schedule keep the actions that they have.
[[nodiscard]] DayPlan draw_day(const CompiledStudy& study, std::uint32_t run);

// A household's day as actions in a scene: which places what is drawn takes.

/// How an activity is told and done: the rows' phase, how somebody of natural style moves, and marks' words for places
/// to do it, the best first.
struct HomeManner {
  const char* phase;
  std::optional<Activity> activity;
  std::vector<std::string_view> uses;
};
[[nodiscard]] HomeManner manner_of(HomeActivity activity);

/// The scene's places to do it: whose marks say so, and seats for anything.
[[nodiscard]] std::size_t n_places_for(const SceneSpec& scene, HomeActivity activity);

/// Residents lie in bed when the day begins. Whatever they do, they do at a place for it, or at a seat for anything;
/// two share no place at one time. Where none is free they wait for the toilet, and do anything else where they could
/// rest, or else where they are. The run is of a trial with a household.
[[nodiscard]] DayPlan plan_home_day(const CompiledStudy& study, std::uint32_t run);

}  // namespace pirsim::sim
