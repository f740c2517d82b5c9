// Columns that several layers name, tables that pirsim only reads, and the names that no sensor may have.
#pragma once

#include "pirsim/columns.hpp"

namespace pirsim {

/// Of what tells of a dataset's rooms and days.
inline constexpr ColumnInfo room_column{"room", Holds::whole, "Number of the room; see the resource rooms."},
    day_column{"day", Holds::whole, "Number of the day in this room, from 1; see the resource days."};

/// Of measured sums: seconds with motion by trial and sensor, with what others simulated.
[[nodiscard]] std::span<const ColumnInfo> sum_columns();

/// Whether a study's rows, measured ones or a dataset's have a column that is called so.
[[nodiscard]] bool is_column_name(std::string_view name);

}  // namespace pirsim
