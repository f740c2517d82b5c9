#include <iomanip>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/response.hpp"
#include "studies/area_tally.hpp"
#include "studies/room_plan.hpp"
#include "studies/walk_test.hpp"

namespace pirsim::studies {
namespace {

bool passes(const Tries& tries, const WalkRequirement& requirement) {
  return tries.made > 0 && *tries.probability() >= requirement.probability - 1e-12;
}

struct PassCount {
  std::size_t tried = 0, passed = 0;
};

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
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const auto told = [](const PassCount& count) {
      return std::to_string(count.passed) + " of " + std::to_string(count.tried);
    };
    lines.push_back(with_sensors(test.scene(), areas, i) + ": walker " + told(major[i]) + " points pass, arms " +
                    told(minor[i]));
  }
  return lines;
}

std::string percent(double share) { return fixed(100.0 * share, 0) + " %"; }

std::string seconds(double value) {
  std::ostringstream out;
  out << value << " s";
  return out.str();
}

std::string sentence(const std::string& motion, const PassCount& count, const WalkRequirement& requirement) {
  return motion + " noticed within " + seconds(requirement.within_s) + " in at least " +
         percent(requirement.probability) + " of " + std::to_string(requirement.directions) +
         " directions: " + std::to_string(count.passed) + " of " + std::to_string(count.tried) + " points pass";
}

std::string seats_in_words(const WalkTestResult& result) {
  std::string noticed, deaf, unseen;
  for (const SeatResult& seat : result.seats) {
    (seat.noticed ? noticed : seat.deaf ? deaf : unseen) += " " + seat.seat;
  }
  const auto named = [](const std::string& seats) { return seats.empty() ? " none" : seats; };
  return "seats where a sitter's arms are noticed:" + named(noticed) + "; seen, but not noticed:" + named(deaf) +
         "; unseen:" + named(unseen);
}

/// Of all tries with a sitter: how many failed, and in how many of those the sitter was seen.
std::string deafness_in_words(const WalkTestResult& result) {
  int missed = 0, deaf = 0;
  for (const PointResult& point : result.points) {
    missed += point.minor.made - point.minor.noticed;
    deaf += point.minor.deaf;
  }
  return "of " + std::to_string(missed) + " tries without notice, sensors saw the sitter in " + std::to_string(deaf);
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
              Tries PointResult::*motion, const WalkRequirement& requirement) {
  io::MapChart probability = map_of(test, "Probability of being noticed", "probability");
  io::MapChart pass = map_of(test, "Pass or fail", "verdict");
  pass.colours = io::MapChart::Colours::pass_or_fail;
  probability.note = "within " + seconds(requirement.within_s) + "; no colour: nothing could be tried there";
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

}  // namespace

std::string to_csv(const WalkTest& test, const WalkTestResult& result) {
  std::ostringstream out;
  out << "x_m,z_m,major_tries,major_noticed,major,minor_tries,minor_noticed,minor,minor_deaf\n"
      << std::fixed << std::setprecision(4);
  const FloorGrid& grid = test.grid();
  const auto write = [&](const Tries& tries, const WalkRequirement& requirement) {
    const char* verdict = tries.made == 0 ? "untried" : passes(tries, requirement) ? "pass" : "fail";
    out << ',' << tries.made << ',' << tries.noticed << ',' << verdict;
  };
  for (std::size_t row = 0; row < grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      if (!grid.on_floor(column, row)) continue;
      const Vec2 centre = grid.centre(column, row);
      const PointResult& point = result.points[row * grid.n_columns() + column];
      out << centre.x << ',' << centre.y;
      write(point.major, test.spec().major);
      write(point.minor, test.spec().minor);
      out << ',' << point.minor.deaf << '\n';
    }
  }
  return out.str();
}

std::string to_text(const WalkTest& test, const WalkTestResult& result) {
  std::string by_area;
  for (const std::string& line : passes_by_area(test, result)) by_area += "  " + line + "\n";
  return sentence("walker", count_passes(result, &PointResult::major, test.spec().major), test.spec().major) + "\n" +
         sentence("sitter's arms", count_passes(result, &PointResult::minor, test.spec().minor), test.spec().minor) +
         "; " + deafness_in_words(result) + "\n" + (result.seats.empty() ? "" : seats_in_words(result) + "\n") +
         by_area;
}

io::Report walk_test_report(const WalkTest& test, const WalkTestResult& result) {
  const WalkTestSpec& spec = test.spec();
  io::Report report;
  report.title = spec.name + ": walk test of " + test.scene().name;
  report.paragraphs = {
      "At every point of a grid a person of the study's measures walks across in several directions (major motion), "
      "and "
      "sits there facing several ways and moves both forearms (minor motion). A try counts as noticed if any sensor "
      "reports motion in time; the sensors' response is " +
          responses_in_words(test.scene(), spec.sensing) +
          ". In the manner of NEMA WD 7 and EN 50131-2-2; not a conformity test.",
      signs_of_maps(test.scene())};
  const std::vector<std::string> by_area = passes_by_area(test, result);
  if (!by_area.empty())
    report.paragraphs.push_back("By area (its sensors in brackets): " + joined(by_area, "; ") + ".");
  io::ReportSection major{"Major motion: walking", {}, {}, {}}, minor{"Minor motion: arms of a sitter", {}, {}, {}};
  major.paragraphs = {sentence("Walker", count_passes(result, &PointResult::major, spec.major), spec.major) + "."};
  minor.paragraphs = {sentence("Arms", count_passes(result, &PointResult::minor, spec.minor), spec.minor) + "; " +
                      deafness_in_words(result) + "."};
  if (!result.seats.empty()) minor.paragraphs.push_back("Facing as the seats do, " + seats_in_words(result) + ".");
  add_maps(major, test, result, &PointResult::major, spec.major);
  add_maps(minor, test, result, &PointResult::minor, spec.minor);
  report.sections = {std::move(major), std::move(minor)};
  return report;
}

}  // namespace pirsim::studies
