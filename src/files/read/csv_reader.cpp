#include "files/read/csv_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "model/core/text.hpp"

namespace pirsim::io {

void RepeatedFaults::add(const std::string& kind, const Where& where, const std::string& message) {
  const auto known = std::ranges::find(kinds_, kind, &Kind::name);
  if (known == kinds_.end()) {
    kinds_.push_back({kind, where, message, 1});
  } else {
    ++known->n;
  }
}

void RepeatedFaults::add(const std::string& kind, const Diagnostics& found) {
  for (const Issue& issue : found.issues()) {
    if (issue.severity == Severity::error) add(kind, issue.where, issue.message);
  }
}

std::size_t RepeatedFaults::size() const noexcept {
  std::size_t n = 0;
  for (const Kind& kind : kinds_) n += kind.n;
  return n;
}

void RepeatedFaults::tell(Diagnostics& faults) const {
  for (const Kind& kind : kinds_) {
    const std::size_t more = kind.n - 1;
    faults.error(kind.first, kind.message + (more == 0 ? "" : "; " + std::to_string(more) + " more like this"));
  }
}

/// Reads one character after the other; knows line and column.
class CsvParser {
 public:
  /// The text outlives the parser.
  CsvParser(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  CsvTable table() {
    CsvTable table;
    table.file_ = file_;
    while (!text_.empty()) {
      if (skip_line_without_data(table.header_.empty())) continue;
      if (table.header_.empty()) table.separator_ = separator_ = separator_in(text_.substr(0, text_.find('\n')));
      std::vector<CsvTable::Field> record = read_record();
      if (table.header_.empty()) {
        table.header_ = std::move(record);
        check_header(table);
      } else {
        check_width(table, record);
        table.rows_.push_back(std::move(record));
      }
    }
    if (table.header_.empty()) throw Error(ErrorCode::input, {file_, 1, 1}, "expected a line with column names");
    widths_.tell(faults_);
    faults_.throw_if_errors();
    return table;
  }

 private:
  [[nodiscard]] bool at_line_end() const {
    return text_.empty() || text_.starts_with('\n') || text_.starts_with("\r\n");
  }
  void advance() {
    if (text_.front() == '\n') {
      ++line_;
      column_ = 0;
    }
    ++column_;
    text_.remove_prefix(1);
  }
  void end_line() {
    while (!text_.empty()) {
      const bool last = text_.front() == '\n';
      advance();
      if (last) return;
    }
  }
  /// A comment stands before the header: behind it a name may begin so.
  bool skip_line_without_data(bool is_before_header) {
    if (!at_line_end() && !(is_before_header && text_.front() == '#')) return false;
    end_line();
    return true;
  }
  [[noreturn]] void refuse(int line, int column, const std::string& message) const {
    throw Error(ErrorCode::input, {file_, line, column}, message);
  }

  std::vector<CsvTable::Field> read_record() {
    std::vector<CsvTable::Field> record;
    while (true) {
      if (record.size() == max_fields) refuse(line_, column_, "more than " + std::to_string(max_fields) + " fields");
      record.push_back(read_field());
      if (at_line_end()) break;
      advance();  // the separator
    }
    end_line();
    return record;
  }
  CsvTable::Field read_field() {
    CsvTable::Field field{{}, line_, column_};
    if (text_.starts_with('"')) {
      read_quoted(field);
    } else {
      while (!at_line_end() && text_.front() != separator_) {
        if (text_.front() == '"') refuse(line_, column_, "a quote inside a field that doesn't begin with one");
        field.text += text_.front();
        advance();
      }
    }
    if (const std::string found = invisible_character(field.text, Lines::many); !found.empty())
      refuse(field.line, field.column, "the field '" + field.text + "' contains " + found);
    return field;
  }
  void read_quoted(CsvTable::Field& field) {
    advance();
    while (true) {
      if (text_.empty()) refuse(field.line, field.column, "this quote is never closed");
      if (text_.starts_with("\"\"")) {
        field.text += '"';
        advance();
      } else if (text_.front() == '"') {
        break;
      } else {
        field.text += text_.front();
      }
      advance();
    }
    advance();
    if (at_line_end() || text_.front() == separator_) return;
    refuse(line_, column_, std::string("expected '") + separator_ + "' after the closing quote");
  }

  void check_header(const CsvTable& table) {
    std::set<std::string> names;
    for (const CsvTable::Field& field : table.header_) {
      if (names.insert(field.text).second) continue;
      faults_.error({file_, field.line, field.column}, "column '" + field.text + "' appears twice");
    }
  }
  void check_width(const CsvTable& table, const std::vector<CsvTable::Field>& record) {
    if (record.size() == table.header_.size()) return;
    widths_.add("width", {file_, record.front().line, record.front().column},
                "expected " + std::to_string(table.header_.size()) + " fields, got " + std::to_string(record.size()));
  }

  static constexpr std::size_t max_fields = 10'000;  // assumed: a column a sensor makes some tens

  /// A table of one column has none.
  static char separator_in(std::string_view header) {
    const char found = separator_of(std::string(header));
    return found == ' ' ? ',' : found;
  }

  std::string_view text_;
  std::string file_;
  char separator_ = ',';
  int line_ = 1;
  int column_ = 1;
  Diagnostics faults_;
  RepeatedFaults widths_;
};

CsvTable CsvTable::read(const std::filesystem::path& path) {
  return parse(decompressed(read_input(path), max_text_file_bytes), path.string());
}
CsvTable CsvTable::parse(std::string_view text, const std::string& file) {
  const std::string read = text_from(std::string(text), file);
  return CsvParser(read, file).table();
}

std::vector<std::string> CsvTable::names() const {
  std::vector<std::string> names;
  for (const Field& field : header_) names.push_back(field.text);
  return names;
}
std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  const auto found = std::find_if(header_.begin(), header_.end(), [&](const Field& f) { return f.text == name; });
  if (found == header_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header_.begin());
}
std::optional<std::size_t> CsvTable::required_column(std::string_view name, Diagnostics& faults) const {
  const std::optional<std::size_t> found = column(name);
  if (!found) {
    faults.error({file_, header_.front().line, 1},
                 "column '" + std::string(name) + "' is missing" + near_or_all(name, names()));
  }
  return found;
}

const std::string& CsvTable::text(std::size_t row, std::size_t column) const { return rows_[row][column].text; }
Where CsvTable::where(std::size_t row, std::size_t column) const {
  const Field& field = rows_[row][column];
  return {file_, field.line, field.column};
}
std::optional<int> CsvTable::integer(std::size_t row, std::size_t column, Diagnostics& faults) const {
  if (text(row, column).empty()) return std::nullopt;
  const std::optional<int> value = parse_number<int>(text(row, column));
  if (!value) {
    faults.error(where(row, column),
                 header_[column].text + ": expected a whole number, got '" + text(row, column) + "'");
  }
  return value;
}
std::optional<double> CsvTable::number(std::size_t row, std::size_t column, Diagnostics& faults) const {
  if (text(row, column).empty()) return std::nullopt;
  // Between commas, "1,234" may be a thousand.
  const std::optional<double> value =
      separator_ == ',' ? parse_number<double>(text(row, column)) : decimal_number(text(row, column));
  if (value && std::isfinite(*value)) return value;
  faults.error(where(row, column), header_[column].text + ": expected a number, got '" + text(row, column) + "'");
  return std::nullopt;
}

namespace {

struct MeasuredColumns {
  std::optional<std::size_t> trial, sensor, real, min_sim, max_sim, mean_sim;
};

MeasuredColumns find_columns(const CsvTable& table, Diagnostics& faults) {
  MeasuredColumns columns;
  columns.trial = table.column("seat") ? table.column("seat") : table.required_column("trial", faults);
  columns.sensor = table.required_column("sensor", faults);
  columns.real = table.required_column("real", faults);
  columns.min_sim = table.column("min_sim");
  columns.max_sim = table.column("max_sim");
  columns.mean_sim = table.column("mean_sim");
  return columns;
}

void check_cell(const CsvTable& table, std::size_t row, const MeasuredColumns& columns, const MeasuredCell& cell,
                Diagnostics& faults) {
  if (table.text(row, *columns.real).empty()) faults.error(table.where(row, *columns.real), "real: expected a number");
  if (cell.real < 0) faults.error(table.where(row, *columns.real), "real: a count can't be negative");
  if (cell.min_sim.has_value() != cell.max_sim.has_value()) {
    faults.error(table.where(row, 0), "expected both or neither of min_sim and max_sim");
  } else if (cell.min_sim && *cell.min_sim > *cell.max_sim) {
    faults.error(table.where(row, *columns.min_sim), "min_sim is greater than max_sim");
  }
}

}  // namespace

std::vector<MeasuredCell> read_measured_cells(const std::filesystem::path& path) {
  const CsvTable table = CsvTable::read(path);
  Diagnostics faults;
  const MeasuredColumns columns = find_columns(table, faults);
  faults.throw_if_errors();
  std::vector<MeasuredCell> cells;
  std::set<std::pair<std::string, std::string>> seen;
  for (std::size_t row = 0; row < table.n_rows(); ++row) {
    MeasuredCell cell{table.text(row, *columns.trial), table.text(row, *columns.sensor), 0, {}, {}, {}};
    cell.real = table.integer(row, *columns.real, faults).value_or(0);
    if (columns.min_sim) cell.min_sim = table.integer(row, *columns.min_sim, faults);
    if (columns.max_sim) cell.max_sim = table.integer(row, *columns.max_sim, faults);
    if (columns.mean_sim) cell.mean_sim = table.number(row, *columns.mean_sim, faults);
    check_cell(table, row, columns, cell, faults);
    if (!seen.emplace(cell.trial, cell.sensor).second) {
      faults.error(table.where(row, 0), "trial '" + cell.trial + "' and sensor '" + cell.sensor + "' appear twice");
    }
    cells.push_back(std::move(cell));
  }
  faults.throw_if_errors();
  return cells;
}

TimeColumn::TimeColumn(const CsvTable& table, const std::string& wanted, Diagnostics& faults) : table_(table) {
  if (!wanted.empty()) {
    column_ = table.required_column(wanted, faults);
  } else {
    find(faults);
  }
  if (!column_ || table.n_rows() == 0) return;
  order_ = order_in(faults);
  const auto first = parse_stamp(text(0), order_);
  if (!first) return;
  kind_ = first->kind == Stamp::Kind::date ? Stamp::Kind::local : first->kind;
  offset_s_ = first->offset_s;
  if (kind_ == Stamp::Kind::number) epoch_unit_us_ = epoch_unit_us(first->number);
}

void TimeColumn::find(Diagnostics& faults) {
  const bool has_rows = table_.n_rows() > 0;
  for (const char* name : {"time", "time_s", "t"}) {
    const auto column = column_ ? std::nullopt : table_.column(name);
    if (column && !(has_rows && table_.text(0, *column).empty())) column_ = column;
  }
  if (table_.column("t") && table_.column("time_s"))
    faults.error(table_.header_place(), "columns 't' and 'time_s' mean the same: give one of them");
  const auto date = table_.column("Date"), time = table_.column("Time");
  if (!column_ && date && time) column_ = time, date_ = date;
  if (column_) return;
  std::vector<std::size_t> moments;
  for (std::size_t i = 0; has_rows && i < table_.names().size(); ++i) {
    const auto stamp = parse_stamp(table_.text(0, i), Dates::found);
    if (stamp && (stamp->kind == Stamp::Kind::local || stamp->kind == Stamp::Kind::absolute)) moments.push_back(i);
  }
  if (moments.size() == 1) {
    column_ = moments.front();
  } else {
    faults.error(table_.header_place(), "no column `time`, `time_s` or `t`, nor `Date` and `Time`; there are " +
                                            joined(table_.names(), ", ") + ": say `time: COLUMN` in the script");
  }
}

Dates TimeColumn::order_in(Diagnostics& faults) const {
  bool is_open = false;
  for (std::size_t row = 0; row < table_.n_rows(); ++row) {
    const auto order = order_of_date(text(row));
    if (!order) continue;
    if (order->order != Dates::found) return order->order;
    is_open = true;
  }
  if (is_open)
    faults.error(where(0), "'" + text(0) + "' can be two dates, and no other row decides: write it as 2026-03-02");
  return Dates::found;
}

std::string TimeColumn::text(std::size_t row) const {
  return (date_ ? table_.text(row, *date_) + ' ' : std::string()) + table_.text(row, *column_);
}

std::optional<double> TimeColumn::seconds(std::size_t row, Diagnostics& faults) const {
  constexpr double farthest_s = 1e10;  // 300 years
  const auto stamp = parse_stamp(text(row), order_);
  if (stamp && kind_ == Stamp::Kind::number && stamp->kind == kind_) {
    const double seconds = epoch_unit_us_ ? stamp->number * *epoch_unit_us_ / us_per_s : stamp->number;
    if (std::abs(seconds) <= farthest_s) return seconds;
  } else if (stamp && (stamp->kind == kind_ || (stamp->kind == Stamp::Kind::date && kind_ == Stamp::Kind::local))) {
    return static_cast<double>(stamp->us) / us_per_s + offset_s_;
  }
  faults.error(where(row), std::string("expected ") + (is_clock() ? "" : "seconds, or ") +
                               "a local date and time, e.g. 2026-03-02T07:00:00, got '" + text(row) + "'");
  return std::nullopt;
}

namespace {

bool split_at_spaces(std::string_view line, std::vector<std::string_view>& fields) {
  const std::string_view spaces = " \t";
  while (true) {
    const std::size_t begin = line.find_first_not_of(spaces);
    if (begin == std::string_view::npos) return true;
    const std::size_t end = std::min(line.find_first_of(spaces, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

/// After a quote: what stands in quotes, and the line behind them; false if they aren't closed.
bool take_quoted(std::string_view& line, std::string& text) {
  text.clear();
  while (!line.empty()) {
    const char c = line.front();
    line.remove_prefix(1);
    if (c != '"') {
      text += c;
    } else if (line.starts_with('"')) {
      text += '"';
      line.remove_prefix(1);
    } else {
      return true;
    }
  }
  return false;
}

}  // namespace

char separator_of(const std::string& line) {
  constexpr std::array separators{',', ';', '\t', '|'};
  const auto n = [&](char c) { return std::ranges::count(line, c); };
  const char most = *std::ranges::max_element(separators, {}, n);
  return n(most) == 0 ? ' ' : most;
}

bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                  std::vector<std::string>& unquoted) {
  fields.clear();
  if (separator == ' ') return split_at_spaces(line, fields);
  std::size_t n_quoted = 0;
  if (const auto quotes = static_cast<std::size_t>(std::ranges::count(line, '"')); unquoted.size() < quotes)
    unquoted.resize(quotes);  // before any field points into it
  while (true) {
    if (line.starts_with('"')) {
      line.remove_prefix(1);
      std::string& text = unquoted[n_quoted++];
      if (!take_quoted(line, text)) return false;
      if (!line.empty() && line.front() != separator) return false;
      fields.emplace_back(text);
    } else {
      const std::size_t end = std::min(line.find(separator), line.size());
      fields.push_back(line.substr(0, end));
      line.remove_prefix(end);
    }
    if (line.empty()) return true;
    line.remove_prefix(1);
  }
}

}  // namespace pirsim::io
