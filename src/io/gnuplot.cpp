#include "io/gnuplot.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "pirsim/csv.hpp"

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

namespace {

void write_head(std::ostream& out, const std::filesystem::path& png, const std::string& title, int width, int height) {
  out << "set terminal pngcairo size " << width << ',' << height << " font 'sans,12'\nset output "
      << quoted(png.string()) << "\nset title " << quoted(title) << " noenhanced font ',14'\nset tics out nomirror\n";
}

/// Names at 0, 1, 2, ...
void write_tics(std::ostream& out, const std::string& axis, const std::vector<std::string>& names, int first,
                const std::string& more) {
  out << "set " << axis << "tics " << more << " (";
  for (std::size_t i = 0; i < names.size(); ++i) {
    out << (i == 0 ? "" : ", ") << quoted(names[i]) << ' ' << first + static_cast<int>(i);
  }
  out << ") noenhanced\n";
}

std::string or_value(const std::optional<double>& limit, double value) { return csv_number(limit.value_or(value)); }

}  // namespace

std::string gnuplot_program(const GridChart& chart, const std::filesystem::path& png) {
  const auto n_columns = static_cast<int>(chart.columns.size()), n_rows = static_cast<int>(chart.rows.size());
  const int square = n_columns > 8 ? 30 : 60;
  std::ostringstream out;
  out << "$squares << END\n";
  for (int i = 0; i < n_rows * n_columns; ++i) {
    const auto& value = chart.cells[static_cast<std::size_t>(i)].value;
    out << i % n_columns << ' ' << i / n_columns << ' ' << (value ? csv_number(*value) : "NaN") << '\n';
  }
  out << "END\n$texts << END\n";
  for (int i = 0; i < n_rows * n_columns; ++i) {
    const GridChart::Cell& cell = chart.cells[static_cast<std::size_t>(i)];
    if (cell.text.empty() || !cell.value) continue;
    const bool dark = std::abs(*cell.value) > 0.6 * chart.max;
    std::string text = cell.text;
    std::ranges::replace_if(
        text, [](char c) { return c == '"' || c == '\n'; }, ' ');
    out << i % n_columns << ' ' << i / n_columns << " \"" << text << "\" " << (dark ? "0xffffff" : "0x1b1f24") << '\n';
  }
  out << "END\n";
  const int title_px = 11 * static_cast<int>(chart.title.size());
  write_head(out, png, chart.title, std::max(title_px, square * n_columns + 330), std::max(260, 26 * n_rows + 190));
  write_tics(out, "y", chart.rows, 0, "");
  write_tics(out, "x", chart.columns, 0, n_columns > 8 ? "rotate by 60 right" : "");
  out << "unset key\nset cblabel " << quoted(chart.label) << " noenhanced\nset xrange [-0.5:" << n_columns - 0.5
      << "]\nset yrange [" << n_rows - 0.5 << ":-0.5]\n";
  if (chart.colours == GridChart::Colours::about_zero) {
    out << "set cbrange [" << csv_number(-chart.max) << ':' << csv_number(chart.max)
        << "]\nset palette defined (-1 '#134b85', -0.5 '#83b9db', 0 '#f1efea', 0.5 '#fcc589', 1 '#994a0d')\n";
  } else {
    out << "set cbrange [0:" << csv_number(chart.max)
        << "]\nset palette defined (0 '#f7fbff', 0.25 '#c6dbef', 0.5 '#6baed6', 0.75 '#2171b5', 1 '#08306b')\n";
  }
  out << "plot $squares using 1:2:3 with image, $texts using 1:2:3:4 with labels noenhanced textcolor rgb variable "
         "font ',9'\n";
  return out.str();
}

std::string gnuplot_program(const LineChart& chart, const std::filesystem::path& png) {
  std::ostringstream out;
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    out << "$line" << i << " << END\n";
    for (const LineChart::Point& point : chart.lines[i].points) {
      out << csv_number(point.x) << ' ' << csv_number(point.y) << ' ' << or_value(point.low, point.y) << ' '
          << or_value(point.high, point.y) << '\n';
    }
    out << "END\n";
  }
  write_head(out, png, chart.title, 560, 460);
  out << "set xlabel " << quoted(chart.x_label) << " noenhanced\nset ylabel " << quoted(chart.y_label)
      << " noenhanced\nset xrange [" << csv_number(chart.x_low) << ':' << csv_number(chart.x_high) << "]\nset yrange ["
      << csv_number(chart.y_low) << ':' << csv_number(chart.y_high) << "]\nset key "
      << (chart.lines.size() > 1 ? "below" : "off") << '\n';
  if (!chart.x_names.empty()) write_tics(out, "x", chart.x_names, 1, "");
  constexpr const char* colours[] = {"#0969da", "#cf222e", "#8c959f", "#9a6700"};
  out << "plot " << (chart.guide == LineChart::Guide::diagonal ? "x with lines dt 2 lc rgb '#57606a' notitle, " : "");
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    out << (i == 0 ? "" : ", ") << "$line" << i << " using 1:2:3:4 with yerrorlines lw 1.6 pt 7 ps 0.9 lc rgb '"
        << colours[i % std::size(colours)] << "' title " << quoted(chart.lines[i].name) << " noenhanced";
  }
  out << '\n';
  return out.str();
}

std::string gnuplot_program(const BarChart& chart, const std::filesystem::path& png) {
  std::ostringstream out;
  std::vector<std::string> names;
  double most = 0.0;
  out << "$bars << END\n";
  for (const BarChart::Bar& bar : chart.bars) {
    out << names.size() << ' ' << csv_number(bar.value) << ' ' << or_value(bar.low, bar.value) << ' '
        << or_value(bar.high, bar.value) << '\n';
    most = std::max({most, bar.value, bar.high.value_or(bar.value)});
    names.push_back(bar.name);
  }
  out << "END\n";
  const auto n = static_cast<int>(names.size());
  write_head(out, png, chart.title, 760, 26 * n + 130);
  write_tics(out, "y", names, 0, "");
  out << "unset key\nset xlabel " << quoted(chart.label) << " noenhanced\nset yrange [" << n - 0.5
      << ":-0.5]\nset xrange [0:" << csv_number(most > 0.0 ? 1.02 * most : 1.0)
      << "]\nset style fill solid\nplot $bars using (0.5*$2):1:(0.5*$2):(0.36) with boxxyerror lc rgb '#8c959f', $bars "
         "using "
         "2:1:3:4 with xerrorbars lw 1.6 pt 0 lc rgb '#1b1f24'\n";
  return out.str();
}

}  // namespace pirsim::io
