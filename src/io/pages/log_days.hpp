// The days of a log as lines of a chart. Private to io.
#pragma once

#include "io/pages/charts.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {

[[nodiscard]] DaysChart days_of(const Log& log);

}  // namespace pirsim::io
