// Where people stand who aren't on their way: beside a desk, at the screen, on a cleaner's round.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pirsim/random.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

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
