#include "dataset/room_floor.hpp"

#include <algorithm>

namespace pirsim::dataset {
namespace {

constexpr int most_spots = 60;  // that are tried for one thing

}  // namespace

bool RoomFloor::fits(const Spot& spot, const Piece& piece) const {
  const Rectangle solid = spot * piece.solid;
  return plan_.is_free(solid) && plan_.is_free(spot * piece.kept) &&
         std::ranges::none_of(kept_, [&](const Rectangle& kept) { return overlap(solid, kept); });
}

void RoomFloor::put(const Spot& spot, const Piece& piece) {
  plan_.occupy(spot * piece.solid);
  kept_.push_back(spot * piece.kept);
}

std::optional<Spot> RoomFloor::put_at_wall(const Piece& piece, double half_m, Stream& stream) {
  for (int k = 0; k < most_spots; ++k) {
    const Wall& wall = one_of(plan_.walls(), stream);
    const double room = wall.length_m() - 2.0 * half_m;
    const std::uint32_t where = stream.index(4);  // a quarter each in the corners
    const double along = draw_length({0.0, std::max(0.0, room)}, stream);
    if (room < 0.0) continue;
    const Spot spot = wall.facing_room(half_m + (where == 0 ? 0.0 : where == 1 ? room : along));
    if (!fits(spot, piece)) continue;
    put(spot, piece);
    return spot;
  }
  return std::nullopt;
}

std::optional<Spot> RoomFloor::put_anywhere(const Piece& piece, Stream& stream) {
  const Rectangle& b = bounds();
  for (int k = 0; k < most_spots; ++k) {
    const double x = draw_length({b.lower.x, b.upper.x}, stream), z = draw_length({b.lower.y, b.upper.y}, stream);
    const Spot spot{{x, z}, static_cast<int>(stream.index(2))};
    if (!fits(spot, piece)) continue;
    put(spot, piece);
    return spot;
  }
  return std::nullopt;
}

}  // namespace pirsim::dataset
