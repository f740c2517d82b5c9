// Who meets when and in which room, on one day.
#pragma once

#include "sim/day_draw.hpp"

namespace pirsim::sim {

/// Adds the day's meetings, and puts those of the staff into their stays. draw: with the stays of all staff.
void draw_meetings(const DaySource& source, DayDraw& draw);

}  // namespace pirsim::sim
