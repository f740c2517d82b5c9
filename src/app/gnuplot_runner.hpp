// Runs gnuplot, if it is installed.
#pragma once

#include <string>
#include <vector>

#include "app/options.hpp"

namespace pirsim::app {

/// Has gnuplot run one program after the other. Without gnuplot, or where it fails, a warning is all that happens.
void draw(const std::vector<std::string>& gnuplot_programs, Verbosity verbosity);

}  // namespace pirsim::app
