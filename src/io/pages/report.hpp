// A page for a reader: text, tables and charts in one HTML file that works without a network. Charts are drawn by
// Vega, which the page carries with it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/pages/charts.hpp"

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
