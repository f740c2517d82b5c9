#include <nlohmann/json.hpp>

#include "pirsim/geometry.hpp"
#include "show/report.hpp"

namespace pirsim::io::detail {
namespace {

using Json = ChartJson;

Json polygons(const std::vector<std::vector<Vec2>>& loops) {
  Json result = Json::array();
  for (const auto& loop : loops) {
    Json points = Json::array();
    for (const Vec2& p : loop) points.push_back({p.x, p.y});
    if (!points.empty()) result.push_back(std::move(points));
  }
  return result;
}

/// Whole numbers without a decimal point: maps are large.
Json number(double value) {
  const auto whole = static_cast<long long>(value);
  return static_cast<double>(whole) == value ? Json(whole) : Json(value);
}

Json polygon_groups(const std::vector<std::vector<std::vector<Vec2>>>& groups) {
  Json result = Json::array();
  for (const auto& loops : groups) result.push_back(polygons(loops));
  return result;
}

Json markers(const std::vector<RoomPlan::Marker>& all) {
  Json result = Json::array();
  for (const RoomPlan::Marker& marker : all) {
    // Vega turns clockwise, and z runs down the page.
    result.push_back({{"label", marker.label},
                      {"x", marker.point.x},
                      {"z", marker.point.y},
                      {"angle_deg", -degrees(marker.heading)}});
  }
  return result;
}

Json to_json(const MapChart& chart) {
  Json json{{"kind", "map"},
            {"label", chart.label},
            {"unit", chart.unit},
            {"x0", chart.lower.x},
            {"z0", chart.lower.y},
            {"spacing_m", chart.spacing_m},
            {"columns", chart.columns},
            {"rows", chart.rows},
            {"max", chart.max},
            {"pass_or_fail", chart.colours == MapChart::Colours::pass_or_fail},
            {"outline", polygons(chart.plan.outline)},
            {"furniture", polygons(chart.plan.furniture)},
            {"walls", polygon_groups(chart.plan.walls)},
            {"wall_lines", polygons(chart.plan.wall_lines)},
            {"dashed", polygons(chart.dashed)}};
  json["ringed"] = Json::array();
  for (const Vec2& point : chart.ringed) {
    json["ringed"].push_back({{"x", point.x}, {"z", point.y}, {"label", chart.ringed_as}});
  }
  Json values = Json::array();
  for (const auto& value : chart.values) values.push_back(value ? number(*value) : Json(nullptr));
  json["values"] = std::move(values);
  json["classes"] = Json::array();
  for (const MapChart::Class& one : chart.classes)
    json["classes"].push_back({{"above", one.above}, {"name", one.name}});
  json["people"] = markers(chart.people);
  json["markers"] = markers(chart.markers);
  json["seats"] = markers(chart.plan.seats);
  json["areas"] = Json::array();
  for (const RoomPlan::Area& area : chart.plan.areas) {
    json["areas"].push_back(
        {{"label", area.label}, {"x", area.middle.x}, {"z", area.middle.y}, {"loops", polygons(area.loops)}});
  }
  json["doors"] = Json::array();
  std::vector<std::vector<Vec2>> sweeps;
  for (const RoomPlan::Door& door : chart.plan.doors) {
    json["doors"].push_back(
        {{"label", door.label}, {"x", door.from.x}, {"z", door.from.y}, {"x2", door.to.x}, {"z2", door.to.y}});
    if (!door.sweep.empty()) sweeps.push_back(door.sweep);
  }
  json["sweeps"] = polygons(sweeps);
  return json;
}

Json to_json(const HistogramChart& chart) {
  Json json{{"kind", "histogram"}, {"label", chart.label}, {"unit", chart.unit}};
  for (const auto& [count, runs] : chart.counts) json["counts"].push_back({count, runs});
  json["real"] = chart.real ? Json(*chart.real) : Json(nullptr);
  return json;
}

Json to_json(const SeriesChart& chart) {
  Json json{
      {"kind", "series"}, {"window_s", chart.window_s}, {"end_s", chart.end_s}, {"first_clock", chart.first_clock}};
  json["rows"] = Json::array();
  for (const auto& row : chart.rows) json["rows"].push_back({{"name", row.name}, {"times_s", row.times_s}});
  json["people"] = Json::array();
  for (const auto& count : chart.people) {
    Json& one = json["people"].emplace_back(Json{{"from_s", count.from_s}, {"n", nullptr}});
    if (count.people) one["n"] = *count.people;
    if (count.likely) one["low"] = count.likely->low, one["high"] = count.likely->high;
  }
  json["phases"] = Json::array();
  for (const auto& phase : chart.phases) {
    json["phases"].push_back({{"name", phase.name}, {"from_s", phase.from_s}, {"to_s", phase.to_s}});
  }
  return json;
}

Json or_null(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json to_json(const GridChart& chart) {
  Json json{{"kind", "grid"},
            {"label", chart.label},
            {"row_label", chart.row_label},
            {"column_label", chart.column_label},
            {"rows", chart.rows},
            {"columns", chart.columns},
            {"colours", chart.colours == GridChart::Colours::about_zero ? "about_zero" : "from_zero"},
            {"max", chart.max}};
  json["cells"] = Json::array();
  for (const GridChart::Cell& cell : chart.cells) {
    json["cells"].push_back({{"v", or_null(cell.value)},
                             {"text", cell.text},
                             {"hint", cell.hint},
                             {"framed", cell.mark == GridChart::Mark::framed}});
  }
  return json;
}

Json to_json(const BandChart& chart) {
  Json json{{"kind", "band"}, {"label", chart.label}, {"low", chart.low}, {"high", chart.high}, {"limit", chart.limit}};
  json["rows"] = Json::array();
  for (const BandChart::Row& row : chart.rows) {
    Json points = Json::array();
    for (const BandChart::Point& point : row.points) {
      points.push_back(
          {{"at", point.position}, {"hint", point.hint}, {"outside", point.mark == BandChart::Point::Mark::outside}});
    }
    json["rows"].push_back({{"name", row.name}, {"points", std::move(points)}});
  }
  return json;
}

Json to_json(const BarChart& chart) {
  constexpr const char* weights[] = {"plain", "strong", "faint"};
  Json json{{"kind", "bars"}, {"label", chart.label}};
  json["bars"] = Json::array();
  for (const BarChart::Bar& bar : chart.bars) {
    json["bars"].push_back({{"name", bar.name},
                            {"v", bar.value},
                            {"text", bar.text},
                            {"hint", bar.hint},
                            {"weight", weights[static_cast<int>(bar.weight)]},
                            {"low", or_null(bar.low)},
                            {"high", or_null(bar.high)}});
  }
  return json;
}

Json to_json(const DotsChart& chart) {
  return {{"kind", "dots"},
          {"label", chart.label},
          {"values", chart.values},
          {"low", chart.low},
          {"high", chart.high},
          {"axis", {chart.axis_low, chart.axis_high}},
          {"reference", or_null(chart.reference)},
          {"reference_label", chart.reference_label},
          {"log", chart.scale == DotsChart::Scale::logarithmic}};
}

/// Runs as triples of numbers: a year has tens of thousands.
Json to_json(const DaysChart& chart) {
  Json json{{"kind", "days"},
            {"from", chart.from_s},
            {"bin", chart.bin_s},
            {"n", chart.n_bins},
            {"clock", chart.ticks == DaysChart::Ticks::clock}};
  json["days"] = Json::array();
  for (const DaysChart::Day& day : chart.days) {
    Json lines = Json::array();
    for (const DaysChart::Line& line : day.lines) {
      Json runs = Json::array();
      for (const DaysChart::Run& run : line.runs) {
        runs.push_back(run.from);
        runs.push_back(run.to);
        runs.push_back(run.level);
      }
      lines.push_back(
          {{"name", line.name}, {"people", line.shows == DaysChart::Shows::people}, {"runs", std::move(runs)}});
    }
    json["days"].push_back({{"name", day.name}, {"lines", std::move(lines)}});
  }
  return json;
}

Json to_json(const LineChart& chart) {
  Json json{{"kind", "lines"},
            {"x_label", chart.x_label},
            {"y_label", chart.y_label},
            {"x", {chart.x_low, chart.x_high}},
            {"y", {chart.y_low, chart.y_high}},
            {"x_names", chart.x_names},
            {"clock", chart.x_ticks == LineChart::Ticks::clock},
            {"diagonal", chart.guide == LineChart::Guide::diagonal}};
  json["points"] = Json::array();
  json["names"] = Json::array();
  for (const LineChart::Line& line : chart.lines) {
    json["names"].push_back(line.name);
    for (const LineChart::Point& point : line.points) {
      json["points"].push_back({{"line", line.name},
                                {"x", point.x},
                                {"y", point.y},
                                {"low", or_null(point.low)},
                                {"high", or_null(point.high)},
                                {"hint", point.hint}});
    }
  }
  return json;
}

}  // namespace

ChartJson to_json(const Chart& chart) {
  return std::visit([](const auto& which) { return to_json(which); }, chart);
}

}  // namespace pirsim::io::detail
