// Windows of a log as rows.
#pragma once

#include <functional>
#include <string_view>

#include "pirsim/log.hpp"

namespace pirsim::io {

/// CSV in pieces: time_s and time of a window's end, people if the log has a count, a column a sensor; what isn't known
/// is empty. time_s counts from the first window's begin, or as the log does.
void write_log_rows(const LogWindows& windows, const std::function<void(std::string_view)>& write);

}  // namespace pirsim::io
