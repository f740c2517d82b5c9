// The floor of one room while it is furnished: what stands on it, and what must stay free to get there.
#pragma once

#include <optional>
#include <vector>

#include "dataset/floor_plan.hpp"

namespace pirsim::dataset {

/// In the axes of a Spot on the wall: the room is towards -Z, x to the right of who looks into the room.
struct Piece {
  Rectangle solid;
  Rectangle kept;  ///< of no other solid; may overlap what others keep
};

class RoomFloor {
 public:
  explicit RoomFloor(const Rectangle& clear) : plan_(clear) {}

  [[nodiscard]] const Rectangle& bounds() const noexcept { return plan_.bounds(); }
  [[nodiscard]] const std::vector<Wall>& walls() const noexcept { return plan_.walls(); }
  [[nodiscard]] bool fits(const Spot& spot, const Piece& piece) const;
  void put(const Spot& spot, const Piece& piece);
  void keep_free(const Rectangle& rectangle) { kept_.push_back(rectangle); }

  /// Its back to a wall, often in a corner: half_m from its middle to its sides. None after some attempts. Puts it
  /// there.
  [[nodiscard]] std::optional<Spot> put_at_wall(const Piece& piece, double half_m, Stream& stream);
  /// Anywhere, turned by quarters.
  [[nodiscard]] std::optional<Spot> put_anywhere(const Piece& piece, Stream& stream);

 private:
  FloorPlan plan_;  ///< occupied by solids
  std::vector<Rectangle> kept_;
};

}  // namespace pirsim::dataset
