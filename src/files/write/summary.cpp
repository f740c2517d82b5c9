#include "files/write/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <span>
#include <sstream>
#include <utility>

#include "files/write/campaign.hpp"
#include "model/core/text.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"

namespace pirsim::studies {

double crps(const Tally& ensemble, double observed) {
  if (ensemble.empty()) throw Error(ErrorCode::usage, "crps: no member");
  double n = 0.0;
  for (const auto& [value, times] : ensemble) n += static_cast<double>(times);
  double error = 0.0, pairs = 0.0, below = 0.0;
  for (const auto& [value, count] : ensemble) {
    const auto x = static_cast<double>(value), times = static_cast<double>(count);
    error += times * std::abs(x - observed);
    pairs += x * times * (2.0 * below + times - n);  // sum over pairs of x_j - x_i, `times` members at once
    below += times;
  }
  return error / n - pairs / (n * n);
}

namespace {

std::optional<std::size_t> index_of(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

/// One cell's simulated distribution against its measured count.
struct Comparison {
  double real, min, max, mean;
  std::optional<double> crps;
};

OverallSummary overall_of(const std::vector<Comparison>& cells) {
  OverallSummary overall;
  if (cells.empty()) return overall;
  std::vector<RangedValue> ranges;
  double crps_sum = 0.0;
  bool all_scored = true;
  for (const Comparison& cell : cells) {
    ranges.push_back({cell.real, cell.min, cell.max});
    overall.real_total += cell.real;
    overall.simulated_total += cell.mean;
    overall.mean_absolute_error += std::abs(cell.mean - cell.real);
    crps_sum += cell.crps.value_or(0.0);
    all_scored = all_scored && cell.crps.has_value();
  }
  const auto n = static_cast<double>(cells.size());
  const InsideCount inside = count_inside(ranges);
  overall.cells = static_cast<int>(cells.size());
  overall.inside = inside.inside;
  overall.shuffled_inside = inside.shuffled_mean;
  overall.shuffled_inside_sd = inside.shuffled_sd;
  overall.bias = (overall.simulated_total - overall.real_total) / n;
  overall.mean_absolute_error /= n;
  if (all_scored) overall.mean_crps = crps_sum / n;
  return overall;
}

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

Summary::Summary(std::vector<std::string> trials, std::vector<std::string> sensors, std::vector<MeasuredCell> measured)
    : trials_(std::move(trials)),
      sensors_(std::move(sensors)),
      counts_(trials_.size() * sensors_.size()),
      measured_(counts_.size()) {
  for (MeasuredCell& cell : measured) {
    const auto trial = index_of(trials_, cell.trial);
    const auto sensor = index_of(sensors_, cell.sensor);
    if (trial && sensor) measured_[*trial * sensors_.size() + *sensor] = std::move(cell);
  }
}

void AreaSums::add(int people) {
  ++rows;
  occupied += people > 0 ? 1 : 0;
  person_rows += people;
  most = std::max(most, people);
}

void AreaSums::add(const AreaSums& other) {
  rows += other.rows;
  occupied += other.occupied;
  person_rows += other.person_rows;
  most = std::max(most, other.most);
}

void Summary::add_run(std::string_view trial, std::span<const int> counts, std::span<const AreaSums> areas) {
  const auto index = index_of(trials_, trial);
  if (!index) {
    throw Error(ErrorCode::usage, "summary: no trial '" + std::string(trial) + "'" + near_or_all(trial, trials_));
  }
  if (counts.size() != sensors_.size()) throw Error(ErrorCode::usage, "summary: expected one count a sensor");
  for (std::size_t sensor = 0; sensor < counts.size(); ++sensor) {
    ++counts_[*index * sensors_.size() + sensor][counts[sensor]];
  }
  ++runs_;
  if (areas_.empty()) {
    areas_.assign(areas.begin(), areas.end());
  } else {
    for (std::size_t i = 0; i < areas_.size(); ++i) areas_[i].add(areas[i]);
  }
}

std::vector<CellSummary> Summary::cells() const {
  std::vector<CellSummary> cells;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    CellSummary cell;
    cell.counts = counts_[i];
    cell.trial = trials_[i / sensors_.size()];
    cell.sensor = sensors_[i % sensors_.size()];
    cell.measured = measured_[i];
    if (!cell.counts.empty()) {
      cell.min = cell.counts.begin()->first;
      cell.max = cell.counts.rbegin()->first;
      std::int64_t total = 0;
      for (const auto& [count, times] : cell.counts) {
        cell.runs += times;
        total += count * times;
      }
      cell.mean = static_cast<double>(total) / static_cast<double>(cell.runs);
      if (cell.measured) {
        cell.inside = cell.min <= cell.measured->real && cell.measured->real <= cell.max;
        cell.crps = crps(cell.counts, cell.measured->real);
      }
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

OverallSummary Summary::overall() const {
  std::vector<Comparison> compared;
  for (const CellSummary& cell : cells()) {
    if (cell.runs == 0 || !cell.measured) continue;
    compared.push_back({static_cast<double>(cell.measured->real), static_cast<double>(cell.min),
                        static_cast<double>(cell.max), cell.mean, cell.crps});
  }
  return overall_of(compared);
}

std::optional<OverallSummary> Summary::published() const {
  std::vector<Comparison> compared;
  for (const std::optional<MeasuredCell>& cell : measured_) {
    if (!cell || !cell->min_sim || !cell->max_sim || !cell->mean_sim) continue;
    compared.push_back({static_cast<double>(cell->real), static_cast<double>(*cell->min_sim),
                        static_cast<double>(*cell->max_sim), *cell->mean_sim, std::nullopt});
  }
  if (compared.empty()) return std::nullopt;
  return overall_of(compared);
}

RunCounts::RunCounts(std::size_t n_sensors, SummarySpec spec, const std::vector<std::string>& areas)
    : spec_(std::move(spec)), counts_(n_sensors, 0) {
  for (const std::string& area : areas) areas_.push_back({.area = area});
}

void RunCounts::reset() {
  std::ranges::fill(counts_, 0);
  for (AreaSums& sums : areas_) sums = {.area = sums.area};
}

void RunCounts::add(const Sample& row) {
  const auto& phases = spec_.phases;
  if (!phases.empty() && std::find(phases.begin(), phases.end(), row.phase) == phases.end()) return;
  for (std::size_t sensor = 0; sensor < counts_.size(); ++sensor) counts_[sensor] += row.bits[sensor] == 1 ? 1 : 0;
  for (std::size_t area = 0; area < areas_.size(); ++area) {
    if (row.people_of_areas[area] >= 0) areas_[area].add(row.people_of_areas[area]);
  }
}

InsideCount count_inside(std::span<const RangedValue> cells) {
  const std::size_t n = cells.size();
  const auto fits = [&](std::size_t value, std::size_t range) {
    return cells[range].min <= cells[value].value && cells[value].value <= cells[range].max;
  };
  InsideCount count;
  if (n == 0) return count;
  std::vector<double> of_value(n, 0.0);  // in how many ranges a value fits
  std::vector<double> of_range(n, 0.0);  // how many values fit in a range
  double fitting = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    count.inside += fits(i, i) ? 1 : 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (!fits(i, j)) continue;
      of_value[i] += 1.0;
      of_range[j] += 1.0;
      fitting += 1.0;
    }
  }
  // Hoeffding (1951): sum over i of a(i, pi(i)) has mean (sum of a) / n and variance (sum of d^2) / (n - 1), where d is
  // a without its row and column means.
  const auto size = static_cast<double>(n);
  count.shuffled_mean = fitting / size;
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double d = (fits(i, j) ? 1.0 : 0.0) - of_value[i] / size - of_range[j] / size + fitting / (size * size);
      squares += d * d;
    }
  }
  if (n > 1) count.shuffled_sd = std::sqrt(squares / (size - 1.0));
  return count;
}

// A summary as CSV, as a table for a terminal and as Markdown.

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

RowTally::RowTally(std::vector<std::string> trials, SummarySpec spec, std::vector<MeasuredCell> measured)
    : trials_(std::move(trials)), spec_(std::move(spec)), measured_(std::move(measured)) {}

void RowTally::add(std::string_view bytes) {
  for (const char c : bytes) {
    is_quoted_ = is_quoted_ != (c == '"');
    if (c != '\n' || is_quoted_) {
      line_ += c;
      continue;
    }
    take_line(line_);
    line_.clear();
  }
}

void RowTally::take_line(std::string_view line) {
  ++n_lines_;
  if (!format_) {
    const io::RowFormat& format = format_.emplace(line, Where{"rows", n_lines_, 1});
    summary_.emplace(trials_, format.columns().sensors, std::move(measured_));
    counts_.emplace(format.columns().sensors.size(), spec_, format.columns().areas);
    return;
  }
  io::RepeatedFaults found;
  if (!format_->read(line, n_lines_, row_, found)) {
    Diagnostics faults;
    found.tell(faults);
    faults.throw_if_errors();
  }
  if (row_.replicate != replicate_ || row_.trial != trial_) {
    end_run();
    replicate_ = row_.replicate;
    trial_ = row_.trial;
  }
  counts_->add(row_);
}

void RowTally::end_run() {
  if (replicate_) summary_->add_run(trial_, counts_->counts(), counts_->areas());
  counts_->reset();
}

const Summary& RowTally::finish() {
  if (!summary_ || !line_.empty()) throw Error(ErrorCode::input, "the rows end within a line");
  end_run();
  replicate_.reset();
  return *summary_;
}

}  // namespace pirsim::studies
