// Ways over the floor: the shortest over a grid of cells, pulled tight, and remembered for the next replicate.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::body {

struct Step {
  int column = 0;
  int row = 0;
};
inline constexpr int n_directions = 8;
/// Direction d + 4 is the way back of d; even directions are straight, odd ones diagonal.
inline constexpr std::array<Step, n_directions> steps{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
[[nodiscard]] constexpr int opposite(int direction) noexcept { return (direction + 4) % n_directions; }

/// Which of its eight neighbours can be reached from each cell; cells count row by row.
struct StepGrid {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> open;  ///< (rows x columns) bit d is set if the step in direction d can be taken

  [[nodiscard]] bool is_open(int cell, int direction) const noexcept {
    return (open[static_cast<std::size_t>(cell)] >> direction & 1) != 0;
  }
  [[nodiscard]] int neighbour(int cell, int direction) const noexcept {
    const Step step = steps[static_cast<std::size_t>(direction)];
    return cell + step.row * columns + step.column;
  }
  /// There and back.
  void close(int cell, int direction) noexcept {
    open[static_cast<std::size_t>(cell)] &= static_cast<std::uint8_t>(~(1U << direction));
    open[static_cast<std::size_t>(neighbour(cell, direction))] &=
        static_cast<std::uint8_t>(~(1U << opposite(direction)));
  }
};

/// A* with the octile distance; a straight step costs 1, a diagonal one sqrt 2. Of equally good cells the one of
/// the lowest index goes first. The cells from start to goal, both included; empty if there is no way.
[[nodiscard]] std::vector<int> shortest_way(const StepGrid& grid, int start, int goal);

/// A label per cell, equal for cells that are connected (the lowest index of them).
[[nodiscard]] std::vector<int> connected_parts(const StepGrid& grid);

/// Whether one can go straight from the first point to the second.
using StraightWay = std::function<bool(const Vec2&, const Vec2&)>;

/// A shorter way with the same ends, each leg of which `straight` allows; `way` itself must be allowed.
[[nodiscard]] std::vector<Vec2> pulled_tight(std::vector<Vec2> way, const StraightWay& straight);

/// What people in the way leave of a grid.
struct StepsLeft {
  StepGrid grid;
  std::vector<int> parts;  ///< connected_parts() of it
};

/// Safe to use from any thread, of bounded size, and without influence on what is found.
class WayMemory {
 public:
  using Way = std::optional<std::vector<Vec2>>;
  using Others = std::vector<std::array<double, 3>>;  ///< centre and radius of each

  /// What work() finds that these leave; worked out once for the same ones in a row: whoever looks for a place to make
  /// way asks about hundreds of places at once.
  [[nodiscard]] std::shared_ptr<const StepsLeft> left_by(Others others, const std::function<StepsLeft()>& work) {
    {
      const std::lock_guard lock(mutex_);
      if (left_ && others == others_) return left_;
    }
    auto left = std::make_shared<const StepsLeft>(work());
    const std::lock_guard lock(mutex_);
    others_ = std::move(others);
    left_ = left;
    return left;
  }

  /// What search() finds between the points; searched once for points that are the same bit for bit.
  [[nodiscard]] Way way(const Vec2& from, const Vec2& to, const std::function<Way()>& search) {
    const std::array<double, 4> ends{from.x, from.y, to.x, to.y};
    {
      const std::lock_guard lock(mutex_);
      if (const auto known = ways_.find(ends); known != ways_.end()) return known->second;
    }
    Way found = search();
    const std::lock_guard lock(mutex_);
    if (ways_.size() >= most_ways) ways_.clear();
    ways_.emplace(ends, found);
    return found;
  }

 private:
  static constexpr std::size_t most_ways = 1024;  ///< a study with fixed seats has two a seat
  std::mutex mutex_;
  std::map<std::array<double, 4>, Way> ways_;
  Others others_;                          ///< the last ones that were asked about
  std::shared_ptr<const StepsLeft> left_;  ///< what they leave
};

}  // namespace pirsim::body
