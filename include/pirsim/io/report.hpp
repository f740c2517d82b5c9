// A page for a reader: text, tables and charts in one HTML file that works without a network. Charts are drawn by
// Vega, which the page carries with it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pirsim/geom/frame.hpp"

namespace pirsim::io {

/// Squares of a floor seen from above, coloured by a value.
struct MapChart {
  struct Marker {
    std::string label;
    Vec2 point{0.0};       ///< (x, z), metres
    double heading = 0.0;  ///< radians, 0 facing -Z (up the page), positive turning left
  };
  std::string title, note;
  std::string label;  ///< of the colour bar: "seconds with motion"
  std::string unit;   ///< after a value: "s of 60"
  Vec2 lower{0.0};    ///< corner of the first square, (x, z)
  double spacing_m = 1.0;
  int columns = 0, rows = 0;
  std::vector<std::optional<double>> values;  ///< (rows x columns), none off the floor
  double max = 1.0;                           ///< of the colour bar
  std::vector<std::vector<Vec2>> outline;     ///< closed polygons, drawn solid: walls
  std::vector<std::vector<Vec2>> dashed;      ///< closed polygons, drawn dashed: what was taken out
  std::vector<Marker> markers;                ///< sensors
};

/// How often a count came out, over the runs, and the measured one as a line.
struct HistogramChart {
  std::string title, note;
  std::string label;  ///< of the horizontal axis
  std::string unit;
  std::vector<int> values;  ///< (n_runs), at least one
  std::optional<int> real;
};

/// In which windows each of several sensors reported motion.
struct SeriesChart {
  struct Row {
    std::string name;
    std::vector<double> times_s;  ///< ends of the windows with motion
  };
  struct Phase {
    std::string name;
    double from_s = 0.0, to_s = 0.0;
  };
  std::string title, note;
  double window_s = 1.0;
  double end_s = 0.0;
  std::vector<Row> rows;
  std::vector<Phase> phases;  ///< shaded
};

struct Table {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
};

/// A heading, paragraphs, then tables, then charts of one or more kinds.
struct ReportSection {
  std::string heading;
  std::vector<std::string> paragraphs;
  std::vector<Table> tables;
  std::vector<std::variant<MapChart, HistogramChart, SeriesChart>> charts;
};

struct Report {
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<ReportSection> sections;
  std::string footer;  ///< what made it
};

/// Plain text everywhere: nothing in it is taken as HTML.
[[nodiscard]] std::string to_html(const Report& report);
/// Atomically; throws Error(io).
void write_report(const std::filesystem::path& file, const Report& report);

}  // namespace pirsim::io
