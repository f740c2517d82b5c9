// The catalogue's entries, one file each.
#pragma once

#include "pirsim/effects/catalogue.hpp"

namespace pirsim::effects {

const Effect& false_triggers();
const Effect& trigger_bursts();
const Effect& missed_triggers();
const Effect& dead_time();
const Effect& pulse_stretching();
const Effect& clock_lag();

}  // namespace pirsim::effects
