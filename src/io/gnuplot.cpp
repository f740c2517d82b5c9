#include "pirsim/io/gnuplot.hpp"

#include <cmath>
#include <sstream>

#include "pirsim/io/csv_writer.hpp"

namespace pirsim::io {
namespace {

/// As a single-quoted string, in which nothing but the quote is special.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : c == '\n' ? std::string(" ") : std::string(1, c);
  return result + "'";
}

void write_loops(std::ostream& out, const std::string& name, const std::vector<std::vector<Vec2>>& loops) {
  out << '$' << name << " << END\n";
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i <= loop.size() && !loop.empty(); ++i) {
      out << csv_number(loop[i % loop.size()].x) << ' ' << csv_number(loop[i % loop.size()].y) << '\n';
    }
    out << '\n';
  }
  out << "END\n";
}

void write_squares(std::ostream& out, const MapChart& chart) {
  out << "$squares << END\n";
  for (int row = 0; row < chart.rows; ++row) {
    for (int column = 0; column < chart.columns; ++column) {
      const auto& value = chart.values[static_cast<std::size_t>(row * chart.columns + column)];
      out << csv_number(chart.lower.x + (column + 0.5) * chart.spacing_m) << ' '
          << csv_number(chart.lower.y + (row + 0.5) * chart.spacing_m) << ' ' << (value ? csv_number(*value) : "NaN")
          << '\n';
    }
    out << '\n';
  }
  out << "END\n";
}

/// Short arrows from the sensors the way they look.
void write_markers(std::ostream& out, const MapChart& chart) {
  out << "$markers << END\n";
  for (const auto& marker : chart.markers) {
    const Vec2 ahead = 0.25 * direction_of(marker.heading);
    out << csv_number(marker.point.x) << ' ' << csv_number(marker.point.y) << ' ' << csv_number(ahead.x) << ' '
        << csv_number(ahead.y) << '\n';
  }
  out << "END\n";
}

}  // namespace

std::string gnuplot_program(const MapChart& chart, const std::filesystem::path& png) {
  const double width_m = chart.columns * chart.spacing_m, depth_m = chart.rows * chart.spacing_m;
  constexpr int plot_px = 900, beside_px = 220, around_px = 130;  // axes and colour bar; title and axis
  std::ostringstream out;
  write_squares(out, chart);
  write_loops(out, "outline", chart.outline);
  write_loops(out, "dashed", chart.dashed);
  write_markers(out, chart);
  out << "set terminal pngcairo size " << plot_px + beside_px << ','
      << around_px + static_cast<int>(std::lround(plot_px * depth_m / width_m)) << " font 'sans,13'\n"
      << "set output " << quoted(png.string()) << "\nset title " << quoted(chart.title) << " noenhanced font ',16'\n"
      << "set xlabel 'x, m'\nset ylabel 'z, m'\nset cblabel " << quoted(chart.label) << " noenhanced\nunset key\n"
      << "set size ratio -1\nset tics out nomirror\nset cbrange [0:" << csv_number(chart.max) << "]\n"
      << "set xrange [" << csv_number(chart.lower.x - 0.1) << ':' << csv_number(chart.lower.x + width_m + 0.1) << "]\n"
      << "set yrange [" << csv_number(chart.lower.y + depth_m + 0.1) << ':' << csv_number(chart.lower.y - 0.1)
      << "]\n"
      // Viridis, by nine of its colours (Smith and van der Walt, CC0).
      << "set palette defined (0 '#440154', 1 '#472c7a', 2 '#3b518b', 3 '#2c718e', 4 '#21908d', 5 '#27ad81', "
         "6 '#5cc863', 7 '#aadc32', 8 '#fde725')\n"
      << "plot $squares with image, $outline with lines lw 2 lc rgb 'black', "
      << (chart.dashed.empty() ? "" : "$dashed with lines lw 2 dt 2 lc rgb 'white', ")
      << "$markers with vectors head filled size 0.1,25 lw 3 lc rgb '#ff4d6d', "
      << "$markers with points pt 7 ps 1.6 lc rgb '#ff4d6d'\n";
  return out.str();
}

}  // namespace pirsim::io
