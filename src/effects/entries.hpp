// The catalogue's entries, one file each.
#pragma once

#include "effects/catalogue.hpp"

namespace pirsim::effects {

const Effect& seats_shifted();
const Effect& mirrored_room();
const Effect& missing_occluder();
const Effect& second_person();
const Effect& seat_shift();
const Effect& seat_scatter();
const Effect& body_size();
const Effect& sensor_yaw();
const Effect& sensor_tilt();
const Effect& sensor_height();
const Effect& arm_motion();
const Effect& trunk_tilt();
const Effect& fidgeting();
const Effect& thermal_contrast();
const Effect& range_scale();
const Effect& soft_zone_edges();
const Effect& wall_reflection();
const Effect& dual_polarity();
const Effect& warm_chair();
const Effect& false_triggers();
const Effect& trigger_bursts();
const Effect& missed_triggers();
const Effect& dead_time();
const Effect& pulse_stretching();
const Effect& clock_lag();
const Effect& dead_sensor();
const Effect& labels_swapped();

}  // namespace pirsim::effects
