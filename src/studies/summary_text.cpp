// A summary as CSV, as a table for a terminal and as Markdown.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <span>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/csv.hpp"
#include "studies/summary.hpp"

namespace pirsim::studies {
namespace {

/// As few digits as it takes: published means are whole numbers or have a decimal.
std::string shortest(double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%g", value);
  return buffer;
}
template <typename Number>
std::string optional_text(const std::optional<Number>& value, int digits) {
  return value ? fixed(static_cast<double>(*value), digits) : std::string{};
}

using Row = std::vector<std::string>;

/// One line of the table: what it is called, and its text for a cell.
struct Line {
  std::string label;
  std::function<std::string(const CellSummary&)> text;
};

std::string verdict(const CellSummary& cell) {
  if (!cell.inside) return {};
  return *cell.inside ? "in" : "out";
}

/// The lines that have something to say, in the paper's order, ours first.
std::vector<Line> lines_for(const std::vector<CellSummary>& cells) {
  std::vector<Line> lines;
  const auto any = [&](auto condition) { return std::any_of(cells.begin(), cells.end(), condition); };
  const bool measured = any([](const CellSummary& c) { return c.measured.has_value(); });
  const bool published = any([](const CellSummary& c) { return c.measured && c.measured->min_sim; });
  if (measured) {
    lines.push_back({"real", [](const CellSummary& c) { return c.measured ? std::to_string(c.measured->real) : ""; }});
  }
  lines.push_back({"min", [](const CellSummary& c) { return c.runs > 0 ? std::to_string(c.min) : ""; }});
  lines.push_back({"max", [](const CellSummary& c) { return c.runs > 0 ? std::to_string(c.max) : ""; }});
  lines.push_back({"mean", [](const CellSummary& c) { return c.runs > 0 ? fixed(c.mean, 1) : ""; }});
  if (measured) {
    lines.push_back({"real in min..max", verdict});
    lines.push_back({"CRPS", [](const CellSummary& c) { return optional_text(c.crps, 1); }});
  }
  if (published) {
    const auto paper = [](auto member) {
      return [member](const CellSummary& c) {
        if (!c.measured || !((*c.measured).*member)) return std::string{};
        return shortest(static_cast<double>(*((*c.measured).*member)));
      };
    };
    lines.push_back({"published min", paper(&MeasuredCell::min_sim)});
    lines.push_back({"published max", paper(&MeasuredCell::max_sim)});
    lines.push_back({"published mean", paper(&MeasuredCell::mean_sim)});
  }
  return lines;
}

/// Header and body; a trial's name stands on its first line only.
std::vector<Row> cell_table(const Summary& summary) {
  const std::vector<CellSummary> cells = summary.cells();
  const std::size_t n_sensors = summary.sensors().size();
  std::vector<Row> table{{"trial", ""}};
  table[0].insert(table[0].end(), summary.sensors().begin(), summary.sensors().end());
  const std::vector<Line> lines = lines_for(cells);
  for (std::size_t trial = 0; trial < summary.trials().size(); ++trial) {
    for (const Line& line : lines) {
      Row row{&line == &lines.front() ? summary.trials()[trial] : std::string{}, line.label};
      for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
        row.push_back(line.text(cells[trial * n_sensors + sensor]));
      }
      table.push_back(std::move(row));
    }
  }
  return table;
}

/// Nothing where nothing was measured.
std::vector<Row> overall_table(const Summary& summary) {
  const OverallSummary ours = summary.overall();
  if (ours.cells == 0) return {};
  const std::optional<OverallSummary> published = summary.published();
  std::vector<Row> table{{"over all cells", "this study"}};
  if (published) table[0].push_back("published");
  const auto add = [&](const std::string& label, const std::function<std::string(const OverallSummary&)>& text) {
    table.push_back({label, text(ours)});
    if (published) table.back().push_back(text(*published));
  };
  add("cells compared", [](const auto& o) { return std::to_string(o.cells); });
  add("real in min..max", [](const auto& o) { return std::to_string(o.inside); });
  add("the same, cells shuffled",
      [](const auto& o) { return fixed(o.shuffled_inside, 1) + " +- " + fixed(o.shuffled_inside_sd, 1); });
  add("total real", [](const auto& o) { return fixed(o.real_total, 0); });
  add("total simulated mean", [](const auto& o) { return fixed(o.simulated_total, 0); });
  add("bias (simulated - real)", [](const auto& o) { return fixed(o.bias, 1); });
  add("mean absolute error", [](const auto& o) { return fixed(o.mean_absolute_error, 1); });
  add("mean CRPS", [](const auto& o) { return o.mean_crps ? fixed(*o.mean_crps, 1) : std::string("-"); });
  return table;
}

/// Nothing without areas.
std::vector<Row> area_table(const Summary& summary) {
  if (summary.areas().empty()) return {};
  std::vector<Row> table{{"people in areas", "person-windows a run", "windows with people, %", "most at once"}};
  for (const AreaSums& sums : summary.areas()) {
    const auto runs = static_cast<double>(summary.runs()),
               rows = static_cast<double>(std::max<std::int64_t>(1, sums.rows));
    table.push_back({sums.area, fixed(static_cast<double>(sums.person_rows) / runs, 1),
                     fixed(100.0 * static_cast<double>(sums.occupied) / rows, 1), std::to_string(sums.most)});
  }
  return table;
}

/// The first `left` columns to the left, the others to the right.
std::string aligned(const std::vector<Row>& table, std::size_t left) {
  std::vector<std::size_t> widths;
  for (const Row& row : table) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const Row& row : table) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - row[i].size(), ' ');
      line += (i > 0 ? "  " : "") + (i < left ? row[i] + padding : padding + row[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string markdown(const std::vector<Row>& table, std::size_t left) {
  std::string text;
  for (std::size_t r = 0; r < table.size(); ++r) {
    text += '|';
    for (const std::string& field : table[r]) text += ' ' + markdown_text(field) + " |";
    text += '\n';
    if (r > 0) continue;
    text += '|';
    for (std::size_t i = 0; i < table[0].size(); ++i) text += i < left ? "---|" : "---:|";
    text += '\n';
  }
  return text;
}

}  // namespace

namespace {

/// With the texts of what has a fixed number of decimals.
struct CellLine {
  const CellSummary& cell;
  std::string mean, crps, published_min, published_max, published_mean;
};

/// Empty where nothing ran.
Cell of_runs(const CellSummary& cell, int CellSummary::*value) {
  return cell.runs > 0 ? Cell(std::int64_t{cell.*value}) : Cell();
}

constexpr Column<CellLine> cell_lines[]{
    {{"trial", Holds::text, "as the script names it"}, [](const CellLine& line) -> Cell { return line.cell.trial; }},
    {{"sensor", Holds::text, "as the scene names it"}, [](const CellLine& line) -> Cell { return line.cell.sensor; }},
    {{"runs", Holds::count, "that were simulated"}, [](const CellLine& line) -> Cell { return line.cell.runs; }},
    {{"min", Holds::count, "least number of rows with motion in a run"},
     [](const CellLine& line) { return of_runs(line.cell, &CellSummary::min); }},
    {{"max", Holds::count, "greatest number of them"},
     [](const CellLine& line) { return of_runs(line.cell, &CellSummary::max); }},
    {{"mean", Holds::number, "mean of them"}, [](const CellLine& line) -> Cell { return line.mean; }},
    {{"real", Holds::count, "the measured number"},
     [](const CellLine& line) -> Cell {
       return line.cell.measured ? Cell(std::int64_t{line.cell.measured->real}) : Cell();
     }},
    {{"inside", Holds::bit, "1 if it lies between `min` and `max`"},
     [](const CellLine& line) -> Cell {
       return line.cell.inside ? Cell(std::int64_t{*line.cell.inside ? 1 : 0}) : Cell();
     }},
    {{"crps", Holds::number, "continuous ranked probability score"},
     [](const CellLine& line) -> Cell { return line.crps; }},
    {{"published_min", Holds::number, "least that others simulated"},
     [](const CellLine& line) -> Cell { return line.published_min; }},
    {{"published_max", Holds::number, "greatest that others simulated"},
     [](const CellLine& line) -> Cell { return line.published_max; }},
    {{"published_mean", Holds::number, "mean of what others simulated"},
     [](const CellLine& line) -> Cell { return line.published_mean; }},
};

}  // namespace

std::string to_csv(const Summary& summary) {
  std::ostringstream text;
  io::TableWriter<CellLine> csv(text, std::span<const Column<CellLine>>(cell_lines));
  for (const CellSummary& cell : summary.cells()) {
    const MeasuredCell measured = cell.measured.value_or(MeasuredCell{});
    csv.write({cell, cell.runs > 0 ? fixed(cell.mean, 3) : "", optional_text(cell.crps, 3),
               optional_text(measured.min_sim, 0), optional_text(measured.max_sim, 0),
               optional_text(measured.mean_sim, 3)});
  }
  return text.str();
}

std::string to_text(const Summary& summary) {
  std::string text = aligned(cell_table(summary), 2);
  for (const auto& table : {overall_table(summary), area_table(summary)}) {
    if (!table.empty()) text += "\n" + aligned(table, 1);
  }
  return text;
}

std::string to_markdown(const Summary& summary) {
  std::string text = markdown(cell_table(summary), 2);
  for (const auto& table : {overall_table(summary), area_table(summary)}) {
    if (!table.empty()) text += "\n" + markdown(table, 1);
  }
  return text;
}

}  // namespace pirsim::studies
