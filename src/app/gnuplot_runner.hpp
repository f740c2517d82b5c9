// Runs gnuplot, if it is installed.
#pragma once

#include <string>

namespace pirsim::app {

/// Whether gnuplot ran the program to its end; false too if there is no gnuplot.
[[nodiscard]] bool run_gnuplot(const std::string& program);

}  // namespace pirsim::app
