// Charts as programs for gnuplot, which makes pictures of them.
#pragma once

#include <filesystem>
#include <string>

#include "pirsim/io/report.hpp"

namespace pirsim::io {

/// A program that writes the map as a labelled PNG.
[[nodiscard]] std::string gnuplot_program(const MapChart& chart, const std::filesystem::path& png);

}  // namespace pirsim::io
