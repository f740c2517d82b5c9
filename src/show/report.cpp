#include "show/report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "files/disk/file.hpp"

namespace pirsim::io {

std::string detail::escaped(const std::string& text) {
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

namespace {

using detail::escaped;
using Json = detail::ChartJson;

/// JSON inside a script element must not end it.
std::string inlined(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += 6) text.replace(at, 1, "\\u003c");
  return text;
}

void write_paragraphs(std::ostream& out, const std::vector<std::string>& paragraphs) {
  for (const std::string& paragraph : paragraphs) out << "<p>" << escaped(paragraph) << "</p>\n";
}

constexpr std::size_t longest_number = 30;  ///< longer cells are prose: left-aligned and wrapped

void write_table(std::ostream& out, const Table& table) {
  const auto has_words = [&](std::size_t column) {
    return std::ranges::any_of(
        table.rows, [&](const auto& row) { return column < row.size() && row[column].size() > longest_number; });
  };
  out << "<div class=\"table\"><table><thead><tr>";
  for (std::size_t i = 0; i < table.headings.size(); ++i) {
    out << "<th scope=\"col\"" << (has_words(i) ? " class=\"words\">" : ">") << escaped(table.headings[i]) << "</th>";
  }
  out << "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out << "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      out << (has_words(i) ? "<td class=\"words\">" : "<td>") << escaped(row[i]) << "</td>";
    }
    out << "</tr>\n";
  }
  out << "</tbody></table></div>\n";
}

/// A long room's map needs a row of its own.
bool is_wide(const Chart& chart) {
  const auto* map = std::get_if<MapChart>(&chart);
  return map != nullptr && (map->columns > 2 * map->rows || !map->classes.empty());
}

/// Charts of one kind stand in one grid.
void write_charts(std::ostream& out, const ReportSection& section, Json& charts) {
  std::string open_kind;
  for (const auto& chart : section.charts) {
    Json json = detail::to_json(chart);
    const std::string kind = json["kind"].get<std::string>() + (is_wide(chart) ? " wide" : "");
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
      << detail::palette() << detail::report_style() << "</style>\n</head>\n<body>\n"
      << "<h1>" << escaped(report.title) << "</h1>\n";
  if (!report.finding.empty()) out << "<p class=\"lead\">" << escaped(report.finding) << "</p>\n";
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
