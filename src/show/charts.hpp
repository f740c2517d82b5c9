// Charts as plain data. Report pages draw them with Vega.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "model/core/range.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/interval.hpp"

namespace pirsim::io {

/// What stands in a room, seen from above; (x, z), metres.
struct RoomPlan {
  struct Marker {
    std::string label;
    Vec2 point{0.0};
    double heading = 0.0;  ///< radians, 0 facing -Z (up the page), positive turning left
  };
  struct Door {
    std::string label;
    Vec2 from{0.0}, to{0.0};  ///< its jambs
    std::vector<Vec2> sweep;  ///< closed polygon: of its leaf, if it has one
  };
  struct Area {
    std::string label;
    Vec2 middle{0.0};  ///< where its name has room
    std::vector<std::vector<Vec2>> loops;
  };
  std::vector<std::vector<Vec2>> outline;    ///< closed polygons: edges of the floor
  std::vector<std::vector<Vec2>> furniture;  ///< closed polygons
  /// Cut through: of each its closed polygons, inside by the even-odd rule.
  std::vector<std::vector<std::vector<Vec2>>> walls;
  std::vector<std::vector<Vec2>> wall_lines;  ///< of walls without thickness
  std::vector<Marker> seats;
  std::vector<Door> doors;
  std::vector<Area> areas;
};

/// Squares of a floor seen from above, coloured by a value.
struct MapChart {
  using Marker = RoomPlan::Marker;
  enum class Colours { scale, pass_or_fail };  ///< pass_or_fail: values are 1 or 0
  struct Class {
    double above = 0.0;  ///< its values are greater, up to the next one's bound
    std::string name;
  };
  std::string title, note;
  std::string label;  ///< of the colour bar: "seconds with motion"
  std::string unit;   ///< after a value: "s of 60"
  Vec2 lower{0.0};    ///< corner of the first square, (x, z)
  double spacing_m = 1.0;
  int columns = 0, rows = 0;
  std::vector<std::optional<double>> values;  ///< (rows x columns), none off the floor
  double max = 1.0;                           ///< of the colour bar
  Colours colours = Colours::scale;
  std::vector<Class> classes{};           ///< on pages: a colour for each instead of the scale, the first one's is pale
  RoomPlan plan;                          ///< drawn over the squares
  std::vector<std::vector<Vec2>> dashed;  ///< closed polygons, drawn dashed: what was taken out
  std::vector<Vec2> ringed{};             ///< points with an orange ring
  std::string ringed_as{};                ///< what a ring means
  std::vector<Marker> markers;            ///< sensors
  std::vector<Marker> people{};           ///< who face nowhere; on pages
};

/// How often a count came out, over the runs, and the measured one as a line.
struct HistogramChart {
  std::string title, note;
  std::string label;  ///< of the horizontal axis
  std::string unit;
  Tally counts;  ///< of one run or more
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
  struct Count {
    double from_s = 0.0;
    std::optional<int> people{};       ///< until the next one; none: unknown, and nothing is drawn
    std::optional<Interval> likely{};  ///< drawn pale behind it
  };
  std::vector<Row> rows;
  std::vector<Count> people{};  ///< drawn above the rows; empty: nothing is
  std::string first_clock{};    ///< ISO 8601, at the end of the first window; empty: the axis shows seconds
  std::vector<Phase> phases;    ///< shaded
};

/// Rows by columns of numbers: coloured squares with the numbers in them.
struct GridChart {
  enum class Colours { from_zero, about_zero };
  enum class Mark { none, framed };
  struct Cell {
    std::optional<double> value;  ///< none: an empty square
    std::string text;             ///< in the square
    std::string hint;             ///< when pointed at, below the names of row and column
    Mark mark = Mark::none;
  };
  std::string title, note;
  std::string label;  ///< of the colour bar
  std::string row_label, column_label;
  std::vector<std::string> rows, columns;
  std::vector<Cell> cells;  ///< (n_rows x n_columns)
  Colours colours = Colours::from_zero;
  double max = 1.0;  ///< the colours reach from 0, or from -max, to max
};

/// Points beside one band that is the same for all of them, from -1 to 1.
struct BandChart {
  struct Point {
    double position = 0.0;
    std::string hint;
    enum class Mark { inside, outside } mark = Mark::inside;
  };
  struct Row {
    std::string name;
    std::vector<Point> points;
  };
  std::string title, note;
  std::string label;      ///< of the horizontal axis
  std::string low, high;  ///< what points to the left and to the right of the band mean
  double limit = 4.0;     ///< points further out are drawn here
  std::vector<Row> rows;
};

/// Values as horizontal bars, with ranges.
struct BarChart {
  enum class Weight { plain, strong, faint };
  struct Bar {
    std::string name;
    double value = 0.0;
    std::string text;  ///< at its end
    Weight weight = Weight::plain;
    std::optional<double> low, high;  ///< a range, drawn as a line
    std::string hint = {};
  };
  std::string title, note, label;
  std::vector<Bar> bars;
};

/// How sure a number is: a few equally likely values as dots.
struct DotsChart {
  enum class Scale { linear, logarithmic };
  std::string title, note, label;
  std::vector<double> values;    ///< equally likely
  double low = 0.0, high = 0.0;  ///< shaded range
  double axis_low = 0.0, axis_high = 1.0;
  std::optional<double> reference;  ///< a dashed line
  std::string reference_label;
  Scale scale = Scale::linear;
};

/// Lines through points with ranges.
struct LineChart {
  struct Point {
    double x = 0.0, y = 0.0;
    std::optional<double> low, high;
    std::string hint = {};
  };
  struct Line {
    std::string name;
    std::vector<Point> points;
  };
  enum class Guide { none, diagonal };
  std::string title, note, x_label, y_label;
  std::vector<Line> lines;
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
  std::vector<std::string> x_names;  ///< of x = 1, 2, ...; empty: numbers
  enum class Ticks { numbers, clock };
  Ticks x_ticks = Ticks::numbers;  ///< clock: x is in hours of a day
  Guide guide = Guide::none;
};

/// Days below each other, each with a line a sensor: when there was motion, and when nothing is known.
struct DaysChart {
  /// Stretches of a line, in bins from the left end of the day.
  struct Run {
    int from = 0, to = 0;
    int level = 0;  ///< unknown, or 1 to 4: motion in up to 5, 20, 50, 100 % of the time; of people their number
  };
  static constexpr int unknown = -1;
  /// Of a share of time. Most sensors move little: equal steps would show one level.
  template <std::floating_point Share>
  [[nodiscard]] static int level_of(Share share) {
    constexpr std::array above{Share(0.0), Share(0.05), Share(0.2), Share(0.5)};
    return static_cast<int>(std::ranges::count_if(above, [&](Share least) { return share > least; }));
  }
  /// From the levels of one day's bins.
  [[nodiscard]] static std::vector<Run> runs_of(std::span<const std::int32_t> levels) {
    std::vector<Run> runs;
    for (int at = 0; at < static_cast<int>(levels.size()); ++at) {
      const int level = levels[static_cast<std::size_t>(at)];
      if (level == 0) continue;
      if (!runs.empty() && runs.back().to == at && runs.back().level == level) {
        ++runs.back().to;
      } else {
        runs.push_back({at, at + 1, level});
      }
    }
    return runs;
  }
  enum class Shows { motion, people };
  struct Line {
    std::string name;
    std::vector<Run> runs;  ///< what is left out is 0
    Shows shows = Shows::motion;
  };
  struct Day {
    std::string name;
    std::vector<Line> lines;
  };
  enum class Ticks { clock, seconds };
  std::string title, note;
  double from_s = 0.0;  ///< of each day, the left end
  double bin_s = 120.0;
  int n_bins = 720;
  Ticks ticks = Ticks::clock;
  std::vector<Day> days;
};

using Chart = std::variant<MapChart, HistogramChart, SeriesChart, GridChart, BandChart, BarChart, DotsChart, LineChart,
                           DaysChart>;

}  // namespace pirsim::io
