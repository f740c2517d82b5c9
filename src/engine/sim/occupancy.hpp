// An occupancy's counts as actions in a room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/schedule.hpp"
#include "pirsim/random.hpp"

namespace pirsim::sim {

/// Finds where people stand once all seats are taken. A fault: more people than the room holds. trial: with its people
/// planned.
void plan_occupancy(TrialModel& trial, const SceneSpec& scene, Diagnostics& faults);

/// The actions of everybody in a run of a trial with counts. People without a part in it keep the actions that they
/// have. Times are such that somebody alone crosses the floor's edge at the moment that was drawn.
[[nodiscard]] DayPlan draw_occupancy(const CompiledStudy& study, std::uint32_t run);

// Who comes and goes, and when, so that a count is what data say: before anybody has walked anywhere.

/// Somebody is in a part of the floor from comes_s to goes_s, in seconds of the run; of who is there all along these
/// lie before its beginning and beyond its end.
struct CountedVisit {
  enum class Beyond { outside, other_part };
  static constexpr double from_the_beginning = -std::numeric_limits<double>::infinity();
  static constexpr double to_the_end = std::numeric_limits<double>::infinity();
  std::size_t person = 0;
  std::size_t place = 0;  ///< of the places that there are; nobody else has it meanwhile
  double comes_s = from_the_beginning, goes_s = to_the_end;
  Beyond comes_from = Beyond::outside, goes_to = Beyond::outside;  ///< other_part: their next visit begins as this ends
};

/// What visits are drawn from.
struct CountSource {
  std::span<const double> times_s;         ///< of the data, ascending
  std::vector<std::vector<int>> people{};  ///< (n_parts x n_times) of each part of the floor that is counted by itself
  double begin_s = 0.0, end_s = 0.0;       ///< of the run, in the seconds of the data
  double changes_within_s = std::numeric_limits<double>::infinity();
  std::size_t n_people = 0;                  ///< who may come; at least the greatest number
  std::size_t n_seats = 0;                   ///< of the places, the first ones: they are taken before anybody stands
  std::vector<std::size_t> part_of_place{};  ///< (n_places)
  std::uint64_t seed = 1;
  std::uint32_t run = 0;
};

/// In the order of coming. A change happens at a random moment between the reading that shows it and the one before:
/// not in the last seconds, as people may be held up at the door. Who comes, who goes and which free place they take
/// have even odds, but that nobody turns round on the threshold if another could. Where one part has fewer people and
/// another has more, they go from one to the other. What is drawn between two readings
/// doesn't depend on the number of changes before. Takes time in proportion to readings, and changes times people.
[[nodiscard]] std::vector<CountedVisit> draw_visits(const CountSource& source);

// Where people stand who aren't on their way: beside a desk, at the screen, on a cleaner's round.

/// The places that one person can get to from a door and that are in nobody's way.
class StandingPlaces {
 public:
  StandingPlaces(const SceneSpec& scene, const PersonModel& person, const std::string& door);

  /// About a metre from a seat; or none.
  [[nodiscard]] std::optional<Vec2> beside(const std::string& seat, Stream& stream) const;
  /// Up to so many, at most so far from a point.
  [[nodiscard]] std::vector<Vec2> around(const Vec2& point, double radius_m, std::size_t most, Stream& stream) const;
  /// As many as stand side by side, in rows; in nobody's way.
  [[nodiscard]] std::vector<Vec2> all() const;
  /// Spread over the floor, in an order of short ways.
  [[nodiscard]] std::vector<Vec2> round(std::size_t most, Stream& stream) const;
  /// What those who sit on these seats see best, within 3 m of the nearest: where to speak from; or none.
  [[nodiscard]] std::optional<Vec2> before(const std::vector<std::string>& seats) const;

 private:
  [[nodiscard]] bool can_be_reached(const Vec2& place) const;
  [[nodiscard]] bool is_out_of_the_way(const Vec2& place) const;
  [[nodiscard]] double seen_by(const std::vector<const SeatSpec*>& seats, const Vec2& place) const;

  const SceneSpec& scene_;
  const PersonModel& person_;
  std::vector<DoorLeaf> leaves_;
  Vec2 outside_{0.0};
};

}  // namespace pirsim::sim
