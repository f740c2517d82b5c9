// The last gate: whatever form or map a log was read by, what came out of it is plausible, or no result comes.
#pragma once

#include <cstdint>

#include "logs/log_file.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {

// Both throw Error(input) by the first rule that is broken, with maps that settle it if any do; what is merely odd is
// added to the remarks.

/// Of a log whose rows are all read: whether its times can be those of real rows. now_us: since 1970. What isn't known
/// at its begin is left out.
void pass_times(LogReading& reading, const LogFile& first, std::int64_t now_us);

/// Whether what the tracks say can be what motion sensors saw.
void pass_tracks(const Log& log, LogReading& reading, const LogFile& first);

}  // namespace pirsim::io
