#include "pirsim/io/report.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "io/page_texts.hpp"
#include "pirsim/core/units.hpp"
#include "pirsim/io/atomic_file.hpp"

namespace pirsim::io {
namespace {

using Json = nlohmann::ordered_json;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

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
            {"outline", polygons(chart.outline)},
            {"dashed", polygons(chart.dashed)}};
  Json values = Json::array();
  for (const auto& value : chart.values) values.push_back(value ? number(*value) : Json(nullptr));
  json["values"] = std::move(values);
  json["markers"] = Json::array();
  for (const MapChart::Marker& marker : chart.markers) {
    // Vega turns clockwise, and z runs down the page.
    json["markers"].push_back({{"label", marker.label},
                               {"x", marker.point.x},
                               {"z", marker.point.y},
                               {"angle_deg", -degrees(marker.heading)}});
  }
  return json;
}

Json to_json(const HistogramChart& chart) {
  Json json{{"kind", "histogram"}, {"label", chart.label}, {"unit", chart.unit}, {"values", chart.values}};
  json["real"] = chart.real ? Json(*chart.real) : Json(nullptr);
  return json;
}

Json to_json(const SeriesChart& chart) {
  Json json{{"kind", "series"}, {"window_s", chart.window_s}, {"end_s", chart.end_s}};
  json["rows"] = Json::array();
  for (const auto& row : chart.rows) json["rows"].push_back({{"name", row.name}, {"times_s", row.times_s}});
  json["phases"] = Json::array();
  for (const auto& phase : chart.phases) {
    json["phases"].push_back({{"name", phase.name}, {"from_s", phase.from_s}, {"to_s", phase.to_s}});
  }
  return json;
}

/// JSON inside a script element must not end it.
std::string inlined(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += 6) text.replace(at, 1, "\\u003c");
  return text;
}

void write_paragraphs(std::ostream& out, const std::vector<std::string>& paragraphs) {
  for (const std::string& paragraph : paragraphs) out << "<p>" << escaped(paragraph) << "</p>\n";
}

void write_table(std::ostream& out, const Table& table) {
  out << "<div class=\"table\"><table><thead><tr>";
  for (const std::string& heading : table.headings) out << "<th scope=\"col\">" << escaped(heading) << "</th>";
  out << "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out << "<tr>";
    for (const std::string& cell : row) out << "<td>" << escaped(cell) << "</td>";
    out << "</tr>\n";
  }
  out << "</tbody></table></div>\n";
}

/// Charts of one kind stand in one grid.
void write_charts(std::ostream& out, const ReportSection& section, Json& charts) {
  std::string open_kind;
  for (const auto& chart : section.charts) {
    Json json = std::visit([](const auto& c) { return to_json(c); }, chart);
    const auto kind = json["kind"].get<std::string>();
    if (kind != open_kind) {
      if (!open_kind.empty()) out << "</div>\n";
      out << "<div class=\"charts " << kind << "\">\n";
      open_kind = kind;
    }
    const auto [title, note] = std::visit([](const auto& c) { return std::pair(c.title, c.note); }, chart);
    out << "<figure><figcaption>" << escaped(title);
    if (!note.empty()) out << "<small>" << escaped(note) << "</small>";
    out << "</figcaption><div class=\"plot\" role=\"img\" aria-label=\"" << escaped(title + ". " + note)
        << "\" data-chart=\"" << charts.size() << "\"></div></figure>\n";
    charts.push_back(std::move(json));
  }
  if (!open_kind.empty()) out << "</div>\n";
}

}  // namespace

std::string to_html(const Report& report) {
  std::ostringstream out;
  Json charts = Json::array();
  out << "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      << "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" "
         "href=\"data:,\">\n"
      << "<title>" << escaped(report.title) << "</title>\n<style>\n"
      << detail::report_style() << "</style>\n</head>\n<body>\n"
      << "<h1>" << escaped(report.title) << "</h1>\n";
  write_paragraphs(out, report.paragraphs);
  if (report.sections.size() > 2) {
    out << "<nav>";
    for (std::size_t i = 0; i < report.sections.size(); ++i) {
      out << "<a href=\"#s" << i << "\">" << escaped(report.sections[i].heading) << "</a>";
    }
    out << "</nav>\n";
  }
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    const ReportSection& section = report.sections[i];
    out << "<h2 id=\"s" << i << "\">" << escaped(section.heading) << "</h2>\n";
    write_paragraphs(out, section.paragraphs);
    for (const Table& table : section.tables) write_table(out, table);
    write_charts(out, section, charts);
  }
  out << "<noscript><p>The charts need JavaScript; the tables don't.</p></noscript>\n"
      << "<footer>" << escaped(report.footer) << "</footer>\n<div id=\"tip\" role=\"status\"></div>\n"
      << "<script type=\"application/json\" id=\"charts\">" << inlined(charts) << "</script>\n<script>"
      << detail::vega_script() << "</script>\n<script>" << detail::report_script() << "</script>\n</body>\n</html>\n";
  return out.str();
}

void write_report(const std::filesystem::path& file, const Report& report) {
  AtomicFile output(file);
  output.stream() << to_html(report);
  output.commit();
}

}  // namespace pirsim::io
