#include "sim/standing_places.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "pirsim/geometry.hpp"
#include "sim/doors.hpp"

namespace pirsim::sim {

StandingPlaces::StandingPlaces(const SceneSpec& scene, const PersonModel& person, const std::string& door)
    : scene_(scene), person_(person), leaves_(leaves_of(scene, 1.0)) {
  const EntranceSpec& entrance = *std::ranges::find(scene.entrances, door, &EntranceSpec::id);
  outside_ = floor_point(entrance.world_from_entrance * Vec3(0, 0, entrance.outside_m));
}

bool StandingPlaces::can_be_reached(const Vec2& place) const {
  return scene_.floor.contains(place) && person_.floor->walkable(place) && person_.floor->has_way(outside_, place);
}

/// Not where others sit down, nor in a doorway.
bool StandingPlaces::is_out_of_the_way(const Vec2& place) const {
  constexpr double from_seat_m = 0.8, from_standing_place_m = 0.75, from_door_m = 1.2;  // assumed: a body and some room
  const bool in_doorway = std::ranges::any_of(scene_.entrances, [&](const EntranceSpec& door) {
    return glm::distance(place, floor_point(door.world_from_entrance.origin)) < from_door_m;
  });
  const bool at_door = std::ranges::any_of(
      leaves_, [&](const DoorLeaf& leaf) { return leaf.distance_to_sweep_m(place) < Doors::hold_m; });
  return !in_doorway && !at_door && std::ranges::none_of(person_.seats, [&](const auto& entry) {
    const SeatPlan& plan = entry.second;
    const Frame& seat = plan.place.world_from_seat;
    return glm::distance(place, floor_point(seat.origin)) < from_seat_m ||
           glm::distance(place, plan.stand(seat)) < from_standing_place_m;
  });
}

std::optional<Vec2> StandingPlaces::beside(const std::string& seat, Stream& stream) const {
  constexpr int directions = 12;
  const auto desk = std::ranges::find(scene_.seats, seat, &SeatSpec::id);
  const double first = 2.0 * pi * stream.uniform();
  if (desk == scene_.seats.end()) return std::nullopt;
  for (const double away_m : {1.0, 1.2, 0.85, 1.5}) {
    for (int k = 0; k < directions; ++k) {
      const Vec2 place = floor_point(desk->world_from_seat.origin) +
                         away_m * direction_of(first + 2.0 * pi * k / static_cast<double>(directions));
      if (is_out_of_the_way(place) && can_be_reached(place)) return place;
    }
  }
  return std::nullopt;
}

std::vector<Vec2> StandingPlaces::around(const Vec2& point, double radius_m, std::size_t most, Stream& stream) const {
  std::vector<Vec2> places;
  for (int tries = 0; tries < 40 && places.size() < most; ++tries) {
    const double away_m = radius_m * std::sqrt(stream.uniform());
    const Vec2 place = point + away_m * direction_of(2.0 * pi * stream.uniform());
    if (is_out_of_the_way(place) && can_be_reached(place)) places.push_back(place);
  }
  return places;
}

std::vector<Vec2> StandingPlaces::all() const {
  constexpr double apart_m = 0.9;  // assumed: two bodies with arms, and some room (0.8-1.2)
  const Vec2 lower = scene_.floor.lower(), upper = scene_.floor.upper();
  std::vector<Vec2> places;
  for (double x = lower.x + 0.5 * apart_m; x < upper.x; x += apart_m) {
    for (double z = lower.y + 0.5 * apart_m; z < upper.y; z += apart_m) {
      if (is_out_of_the_way({x, z}) && can_be_reached({x, z})) places.emplace_back(x, z);
    }
  }
  return places;
}

std::vector<Vec2> StandingPlaces::round(std::size_t most, Stream& stream) const {
  const Vec2 lower = scene_.floor.lower(), size = scene_.floor.upper() - lower;
  std::vector<Vec2> left, ordered;
  for (std::size_t tries = 0; tries < 10 * most && left.size() < most; ++tries) {
    const Vec2 place = lower + size * Vec2(stream.uniform(), stream.uniform());
    if (can_be_reached(place)) left.push_back(place);
  }
  for (Vec2 here = outside_; !left.empty(); here = ordered.back()) {
    const auto nearest = std::ranges::min_element(left, {}, [&](const Vec2& p) { return glm::distance(p, here); });
    ordered.push_back(*nearest);
    left.erase(nearest);
  }
  return ordered;
}

/// Cosine of the angle by which whoever looks there most askance turns from straight ahead.
double StandingPlaces::seen_by(const std::vector<const SeatSpec*>& seats, const Vec2& place) const {
  double least = 1.0, nearest_m = std::numeric_limits<double>::max();
  for (const SeatSpec* seat : seats) {
    const Vec2 way = place - floor_point(seat->world_from_seat.origin);
    const double away_m = std::max(0.01, glm::length(way));
    nearest_m = std::min(nearest_m, away_m);
    least = std::min(least, glm::dot(way / away_m, direction_of(heading_of(seat->world_from_seat))));
  }
  constexpr double farthest_m = 3.0;
  return nearest_m > farthest_m ? -1.0 : least;
}

std::optional<Vec2> StandingPlaces::before(const std::vector<std::string>& ids) const {
  constexpr double step_m = 0.25;
  std::vector<const SeatSpec*> seats;
  for (const SeatSpec& seat : scene_.seats) {
    if (std::ranges::find(ids, seat.id) != ids.end()) seats.push_back(&seat);
  }
  struct Candidate {
    double seen;
    Vec2 place;
  };
  std::vector<Candidate> candidates;
  const Vec2 lower = scene_.floor.lower(), upper = scene_.floor.upper();
  for (double x = lower.x + 0.5 * step_m; x < upper.x; x += step_m) {
    for (double z = lower.y + 0.5 * step_m; z < upper.y; z += step_m) {
      if (const double seen = seen_by(seats, {x, z}); seen > -0.99) candidates.push_back({seen, {x, z}});
    }
  }
  std::ranges::stable_sort(candidates, std::greater(), &Candidate::seen);
  for (const Candidate& candidate : candidates) {
    if (is_out_of_the_way(candidate.place) && can_be_reached(candidate.place)) return candidate.place;
  }
  return std::nullopt;
}

}  // namespace pirsim::sim
