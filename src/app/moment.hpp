// A moment of a run, as options take it and as messages tell it.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

#include "schema/clock.hpp"

namespace pirsim::app {

/// An option that takes a moment; `otherwise` says in its help what holds without it.
void offer_moment(CLI::App& command, const std::string& name, std::string& text, const std::string& what,
                  const std::string& otherwise);

/// Seconds of the run; below 0 for a date before it. A time of day is the first such moment of the run. Throws
/// Error(usage) that names the option, for what is no moment and for a time of day in a run without a clock.
[[nodiscard]] double moment(const std::string& option, const std::string& text, const std::optional<RunClock>& clock);

}  // namespace pirsim::app
