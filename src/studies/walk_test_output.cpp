#include <span>
#include <sstream>
#include <string_view>

#include "core/text.hpp"
#include "pirsim/csv.hpp"
#include "studies/area_tally.hpp"
#include "studies/room_plan.hpp"
#include "studies/walk_test.hpp"
#include "studies/walk_words.hpp"

namespace pirsim::studies {
namespace {

PassCount count_passes(const WalkTestResult& result, Tries PointResult::*motion, const WalkRequirement& requirement) {
  PassCount count;
  for (const PointResult& point : result.points) {
    if ((point.*motion).made == 0) continue;
    ++count.tried;
    count.passed += passes(point.*motion, requirement) ? 1 : 0;
  }
  return count;
}

/// Of the points of each area. A line each; none without areas.
std::vector<std::string> passes_by_area(const WalkTest& test, const WalkTestResult& result) {
  const Areas areas(test.scene());
  const FloorGrid& grid = test.grid();
  std::vector<PassCount> major(areas.size()), minor(areas.size());
  const auto note = [](const Tries& tries, const WalkRequirement& requirement, PassCount& count) {
    if (tries.made == 0) return;
    ++count.tried;
    count.passed += passes(tries, requirement) ? 1 : 0;
  };
  for (std::size_t i = 0; i < result.points.size() && !areas.empty(); ++i) {
    const std::size_t column = i % grid.n_columns(), row = i / grid.n_columns();
    if (!grid.on_floor(column, row)) continue;
    const std::size_t area = areas.at(grid.centre(column, row));
    note(result.points[i].major, test.spec().major, major[area]);
    note(result.points[i].minor, test.spec().minor, minor[area]);
  }
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < areas.size(); ++i)
    lines.push_back(WalkWords(test).of_area(with_sensors(test.scene(), areas, i), major[i], minor[i]));
  return lines;
}

io::MapChart map_of(const WalkTest& test, const std::string& title, const std::string& label) {
  const FloorGrid& grid = test.grid();
  io::MapChart chart;
  chart.title = title;
  chart.label = label;
  chart.lower = grid.centre(0, 0) - 0.5 * Vec2(grid.spacing_m());
  chart.spacing_m = grid.spacing_m();
  chart.columns = static_cast<int>(grid.n_columns());
  chart.rows = static_cast<int>(grid.n_rows());
  chart.plan = plan_of(test.scene());
  for (const SensorSpec& sensor : test.scene().sensors) {
    chart.markers.push_back(
        {sensor.id, floor_point(sensor.world_from_sensor.origin), heading_of(sensor.world_from_sensor)});
  }
  return chart;
}

void add_maps(io::ReportSection& section, const WalkTest& test, const WalkTestResult& result,
              Tries PointResult::*motion, const WalkRequirement& requirement, const std::string& time) {
  io::MapChart probability = map_of(test, "Probability of being noticed", "probability");
  io::MapChart pass = map_of(test, "Pass or fail", "verdict");
  pass.colours = io::MapChart::Colours::pass_or_fail;
  probability.note = time + "; no colour: nothing could be tried there";
  pass.note = "required: " + percent(requirement.probability);
  probability.unit = "of the tries noticed";
  for (const PointResult& point : result.points) {
    const Tries& tries = point.*motion;
    probability.values.push_back(tries.probability());
    pass.values.push_back(tries.made == 0 ? std::nullopt : std::optional(passes(tries, requirement) ? 1.0 : 0.0));
  }
  section.charts.emplace_back(std::move(probability));
  section.charts.emplace_back(std::move(pass));
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

}  // namespace

namespace {

struct PointLine {
  std::string x_m, z_m;  ///< with all decimals
  const PointResult& point;
  std::string_view major, minor;
};

constexpr Column<PointLine> point_lines[]{
    {{"x_m", Holds::number, "of the point", "m"}, [](const PointLine& line) -> Cell { return line.x_m; }},
    {{"z_m", Holds::number, "of the point", "m"}, [](const PointLine& line) -> Cell { return line.z_m; }},
    {{"major_tries", Holds::count, "walks across it that are possible"},
     [](const PointLine& line) -> Cell { return line.point.major.made; }},
    {{"major_noticed", Holds::count, "of them, in which a sensor reported motion in time"},
     [](const PointLine& line) -> Cell { return line.point.major.noticed; }},
    {{"major", Holds::text, "`pass`, `fail`, or `untried` where nobody can walk"},
     [](const PointLine& line) -> Cell { return line.major; }},
    {{"minor_tries", Holds::count, "movements of arms over it"},
     [](const PointLine& line) -> Cell { return line.point.minor.made; }},
    {{"minor_noticed", Holds::count, "of them, in which a sensor reported motion in time"},
     [](const PointLine& line) -> Cell { return line.point.minor.noticed; }},
    {{"minor", Holds::text, "`pass`, `fail`, or `untried` where nobody can sit"},
     [](const PointLine& line) -> Cell { return line.minor; }},
    {{"minor_deaf", Holds::count, "of those without notice, in which a sensor saw what moved"},
     [](const PointLine& line) -> Cell { return line.point.minor.deaf; }},
};

}  // namespace

std::string to_csv(const WalkTest& test, const WalkTestResult& result) {
  constexpr int decimals = 4;
  std::ostringstream out;
  io::TableWriter<PointLine> csv(out, std::span<const Column<PointLine>>(point_lines));
  const FloorGrid& grid = test.grid();
  const auto verdict = [](const Tries& tries, const WalkRequirement& requirement) -> std::string_view {
    return tries.made == 0 ? "untried" : passes(tries, requirement) ? "pass" : "fail";
  };
  for (std::size_t row = 0; row < grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      if (!grid.on_floor(column, row)) continue;
      const Vec2 centre = grid.centre(column, row);
      const PointResult& point = result.points[row * grid.n_columns() + column];
      csv.write({fixed(centre.x, decimals), fixed(centre.y, decimals), point, verdict(point.major, test.spec().major),
                 verdict(point.minor, test.spec().minor)});
    }
  }
  return out.str();
}

std::string to_text(const WalkTest& test, const WalkTestResult& result) {
  const WalkWords words(test);
  const std::string seats = words.of_seats(result);
  std::string text = words.of_major(count_passes(result, &PointResult::major, test.spec().major)) + "\n" +
                     words.of_minor(count_passes(result, &PointResult::minor, test.spec().minor)) + "; " +
                     words.of_deafness(result) + "\n" + (seats.empty() ? "" : seats + "\n");
  for (const std::string& line : passes_by_area(test, result)) text += "  " + line + "\n";
  return text;
}

io::Report walk_test_report(const WalkTest& test, const WalkTestResult& result) {
  const WalkTestSpec& spec = test.spec();
  const WalkWords words(test);
  io::Report report;
  report.title = words.title();
  report.paragraphs = {words.method(), signs_of_maps(test.scene())};
  const std::vector<std::string> by_area = passes_by_area(test, result);
  if (!by_area.empty())
    report.paragraphs.push_back("By area (its sensors in brackets): " + joined(by_area, "; ") + ".");
  io::ReportSection major{"Major motion: walking", {}, {}, {}}, minor{words.minor_heading(), {}, {}, {}};
  major.paragraphs = {capitalised(words.of_major(count_passes(result, &PointResult::major, spec.major))) + "."};
  minor.paragraphs = {capitalised(words.of_minor(count_passes(result, &PointResult::minor, spec.minor))) + "; " +
                      words.of_deafness(result) + "."};
  const std::string seats = words.of_seats(result);
  if (!seats.empty()) minor.paragraphs.push_back((spec.arm ? "In all, " : "Facing as the seats do, ") + seats + ".");
  add_maps(major, test, result, &PointResult::major, spec.major, words.time_of_major());
  add_maps(minor, test, result, &PointResult::minor, spec.minor, words.time_of_minor());
  report.sections = {std::move(major), std::move(minor)};
  return report;
}

}  // namespace pirsim::studies
