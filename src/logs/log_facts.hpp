// Stretches of time in which a track keeps its value. Private to io.
#pragma once

#include <algorithm>
#include <cstdint>

#include "pirsim/log.hpp"

namespace pirsim::io {

struct LogRun {
  std::int64_t from_us, to_us;
  std::int32_t value;
};

/// Calls tell(run) for all of a track, in order of time, until the log's end. Readings hold from the reading before.
template <typename Tell>
void each_stretch(const Log& log, const LogTrack& track, Tell tell) {
  for (std::size_t i = 0; i < track.changes.size(); ++i) {
    const LogChange& change = track.changes[i];
    const bool is_last = i + 1 == track.changes.size();
    const std::int64_t end = is_last ? log.end_us : track.changes[i + 1].us - track.changes[i + 1].since_last_us;
    const std::int64_t begin = change.us - change.since_last_us;
    tell(LogRun{begin, std::max(begin, end), change.value});
  }
}

}  // namespace pirsim::io
