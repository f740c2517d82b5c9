// Charts as programs for gnuplot, which makes pictures of them.
#pragma once

#include <filesystem>
#include <string>

#include "io/charts.hpp"

namespace pirsim::io {

/// Programs that write the chart as a labelled PNG. Texts are put in as they are, never as markup.
[[nodiscard]] std::string gnuplot_program(const MapChart& chart, const std::filesystem::path& png);
[[nodiscard]] std::string gnuplot_program(const GridChart& chart, const std::filesystem::path& png);
[[nodiscard]] std::string gnuplot_program(const LineChart& chart, const std::filesystem::path& png);
[[nodiscard]] std::string gnuplot_program(const BarChart& chart, const std::filesystem::path& png);

}  // namespace pirsim::io
