#include "reconcile/ensemble/presence_draw.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "schema/occupancy_runs.hpp"

namespace pirsim::reconcile {
namespace {

constexpr double least_apart_s = 0.1;  ///< readings stay in order

/// How much later the reading of a place is.
struct Knot {
  std::size_t place = 0;
  double later_s = 0.0;
};

double later_at(const std::vector<Knot>& knots, std::size_t place) {
  const auto after = std::ranges::lower_bound(knots, place, {}, &Knot::place);
  if (after->place == place) return after->later_s;
  const Knot& before = *(after - 1);
  const double share = static_cast<double>(place - before.place) / static_cast<double>(after->place - before.place);
  return before.later_s + share * (after->later_s - before.later_s);
}

void draw_seats(const SceneSpec& scene, const NuisanceSpec& nuisance, Stream& stream, OccupancySpec& occupancy) {
  std::vector<std::string> seats = seats_of(occupancy, scene);
  const std::vector<int>& people = occupancy.counts->people;
  const auto most = static_cast<std::size_t>(people.empty() ? 0 : std::max(1, *std::ranges::max_element(people)));
  const double share = nuisance.own_seats * stream.uniform();
  if (!occupancy.counts->areas.empty()) return;  // which seats are spare differs from area to area
  if (seats.size() <= most || most == 0) return;
  const double spare = static_cast<double>(seats.size() - most);
  const auto unused = std::min(seats.size() - most, static_cast<std::size_t>(share * (spare + 1.0)));
  for (std::size_t i = 0; i < unused; ++i)
    seats.erase(seats.begin() + stream.index(static_cast<std::uint32_t>(seats.size())));
  if (unused > 0) occupancy.seats = std::move(seats);
}

}  // namespace

CountsSpec with_other_times(const CountsSpec& counts, double within_s, Stream& stream) {
  CountsSpec moved = counts;
  const std::size_t n = counts.people.size();
  if (n < 3 || within_s <= 0.0) return moved;
  std::vector<Knot> knots{{0, 0.0}};
  for (std::size_t k = 1; k < n; ++k) {
    if (are_as_many(counts, k)) continue;
    const double later_s = within_s * (2.0 * stream.uniform() - 1.0);
    if (knots.back().place < k - 1) knots.push_back({k - 1, later_s});
    if (k + 1 < n) knots.push_back({k, later_s});
  }
  knots.push_back({n - 1, 0.0});
  for (std::size_t k = 1; k + 1 < n; ++k) {
    moved.times_s[k] = std::max(counts.times_s[k] + later_at(knots, k), moved.times_s[k - 1] + least_apart_s);
  }
  for (std::size_t k = n - 1; k-- > 1;)
    moved.times_s[k] = std::min(moved.times_s[k], moved.times_s[k + 1] - least_apart_s);
  return moved;
}

void draw_presence(const SceneSpec& scene, const NuisanceSpec& nuisance, Stream& stream, OccupancySpec& occupancy) {
  if (!occupancy.counts) return;
  draw_seats(scene, nuisance, stream, occupancy);
  occupancy.counts = with_other_times(*occupancy.counts, nuisance.time_s, stream);
}

}  // namespace pirsim::reconcile
