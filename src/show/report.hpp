// What pages carry: charts as JSON for their script, and texts that are built in. Private to io.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "show/charts.hpp"

namespace pirsim::io::detail {

// Charts as the JSON that io/pages/report.js draws.

using ChartJson = nlohmann::ordered_json;
/// `kind` says which chart it is.
[[nodiscard]] ChartJson to_json(const Chart& chart);

/// Plain text as HTML.
[[nodiscard]] std::string escaped(const std::string& text);

// Texts that are built into the library for pages that work without a network.

[[nodiscard]] std::string_view vega_script() noexcept;    ///< defines `vega`; made by tools/make_vega_bundle.py
[[nodiscard]] std::string_view report_script() noexcept;  ///< src/io/pages/report.js
[[nodiscard]] std::string_view palette() noexcept;        ///< src/io/pages/palette.css, the colours of all pages
[[nodiscard]] std::string_view report_style() noexcept;   ///< src/io/pages/report.css
[[nodiscard]] std::string_view three_script() noexcept;   ///< defines `three`; made by tools/vendor_three
[[nodiscard]] std::string_view view_page() noexcept;      ///< src/io/pages/view.html, a template
[[nodiscard]] std::string_view view_script() noexcept;    ///< src/io/pages/{run,time_line,room,view}.js
[[nodiscard]] std::string_view view_style() noexcept;     ///< src/io/pages/view.css

}  // namespace pirsim::io::detail

// A page for a reader: text, tables and charts in one HTML file that works without a network. Charts are drawn by
// Vega, which the page carries with it.

namespace pirsim::io {

struct Table {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
};

/// A heading, paragraphs, then tables, then charts of one or more kinds.
struct ReportSection {
  std::string heading;
  std::vector<std::string> paragraphs;
  std::vector<Table> tables;
  std::vector<Chart> charts;
};

struct Report {
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<ReportSection> sections;
  std::string footer;        ///< what made it
  std::string finding = {};  ///< the result in a sentence or two, set off below the title
};

/// Plain text everywhere: nothing in it is taken as HTML.
[[nodiscard]] std::string to_html(const Report& report);
/// Atomically; throws Error(io).
void write_report(const std::filesystem::path& file, const Report& report);

}  // namespace pirsim::io
