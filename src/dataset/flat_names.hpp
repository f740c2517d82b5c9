// What areas, doors and sensors of drawn flats are called, so that the homes of a dataset share columns.
#pragma once

#include <string>

#include "pirsim/columns.hpp"
#include "pirsim/flat.hpp"

namespace pirsim::dataset {

/// `which`: of those of its kind, from 1.
[[nodiscard]] std::string area_name(FlatRoomKind kind, int which = 1);
/// Whether the doorway into such a room has a leaf.
[[nodiscard]] bool has_leaf(FlatRoomKind kind) noexcept;

/// A door is called as the area behind it, the front door so.
inline constexpr const char* front_door_name = "front";
[[nodiscard]] std::string room_sensor_name(const std::string& area);
[[nodiscard]] std::string doorway_sensor_name(const std::string& door);

/// All that flats of these ranges can have; none needs to have them all.
[[nodiscard]] ColumnOwners columns_of(const FlatSpec& spec);

}  // namespace pirsim::dataset
