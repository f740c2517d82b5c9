// Who comes and goes, and when, so that a count is what data say: before anybody has walked anywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace pirsim::sim {

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

}  // namespace pirsim::sim
