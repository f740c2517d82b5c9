// One number of a measured study, with what others simulated for it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/read/stamps.hpp"
#include "pirsim/dates.hpp"
#include "pirsim/error.hpp"

namespace pirsim {

/// How often one sensor reported motion in one trial.
struct MeasuredCell {
  std::string trial;
  std::string sensor;
  int real = 0;                    ///< measured count
  std::optional<int> min_sim;      ///< least published simulated count
  std::optional<int> max_sim;      ///< greatest published simulated count
  std::optional<double> mean_sim;  ///< mean of the published simulated counts
};

}  // namespace pirsim

// Tables from CSV files (RFC 4180), with the place of every field.

namespace pirsim::io {

/// Faults that a file has line after line: each kind is told once, with the place of the first and how many there are.
class RepeatedFaults {
 public:
  void add(const std::string& kind, const Where& where, const std::string& message);
  void add(const std::string& kind, const Diagnostics& found);  ///< each of its errors
  void tell(Diagnostics& faults) const;
  [[nodiscard]] bool empty() const noexcept { return kinds_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept;  ///< of all kinds together

 private:
  struct Kind {
    std::string name;
    Where first;
    std::string message;
    std::size_t n = 0;
  };
  std::vector<Kind> kinds_;
};

/// A header and rows of as many fields, separated by commas, semicolons or tabs. Quoted fields, doubled quotes, line
/// ends inside quotes, CRLF and a byte order mark are understood, and UTF-16 with its mark; empty lines are skipped,
/// and comments before the header: lines that begin with '#'.
class CsvTable {
 public:
  /// The file may be compressed by gzip or Zstandard. Throws Error: io (no file), input (content).
  [[nodiscard]] static CsvTable read(const std::filesystem::path& path);
  [[nodiscard]] static CsvTable parse(std::string_view text, const std::string& file);

  [[nodiscard]] std::size_t n_rows() const noexcept { return rows_.size(); }
  [[nodiscard]] std::vector<std::string> names() const;
  /// Of the line with the names.
  [[nodiscard]] Where header_place() const { return {file_, header_.front().line, header_.front().column}; }
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  /// A missing one is reported with the name that comes nearest.
  [[nodiscard]] std::optional<std::size_t> required_column(std::string_view name, Diagnostics& faults) const;

  [[nodiscard]] const std::string& text(std::size_t row, std::size_t column) const;
  [[nodiscard]] Where where(std::size_t row, std::size_t column) const;
  // None if the field is empty, and after a fault, which is reported.
  [[nodiscard]] std::optional<int> integer(std::size_t row, std::size_t column, Diagnostics& faults) const;
  [[nodiscard]] std::optional<double> number(std::size_t row, std::size_t column, Diagnostics& faults) const;

 private:
  struct Field {
    std::string text;
    int line = 0;
    int column = 0;
  };
  friend class CsvParser;
  std::string file_;
  char separator_ = ',';
  std::vector<Field> header_;
  std::vector<std::vector<Field>> rows_;
};

/// Columns trial (or seat), sensor, real and, if they are there, min_sim, max_sim, mean_sim; others are ignored.
[[nodiscard]] std::vector<MeasuredCell> read_measured_cells(const std::filesystem::path& path);

// When a row of a table is: a column of local times or of seconds, or one of dates beside one of times.

class TimeColumn {
 public:
  /// wanted: the column's name, or "": `time`, `time_s`, `t`, or `Date` and `Time`, the first of these that the table
  /// has and fills, or else its only column of moments. The table outlives this. A missing one is told.
  TimeColumn(const CsvTable& table, const std::string& wanted, Diagnostics& faults);

  [[nodiscard]] bool is_found() const noexcept { return column_.has_value(); }
  /// Are they moments, whose seconds count since 1970-01-01T00:00 of a clock on the wall: the one that the first row
  /// tells, of a number since 1970 UTC? Otherwise they are plain seconds.
  [[nodiscard]] bool is_clock() const noexcept {
    return kind_ == Stamp::Kind::local || kind_ == Stamp::Kind::absolute || epoch_unit_us_.has_value();
  }
  /// Where a row's fault stands.
  [[nodiscard]] Where where(std::size_t row) const { return table_.where(row, *column_); }
  /// None after a fault, which is told.
  [[nodiscard]] std::optional<double> seconds(std::size_t row, Diagnostics& faults) const;

 private:
  void find(Diagnostics& faults);
  [[nodiscard]] Dates order_in(Diagnostics& faults) const;
  [[nodiscard]] std::string text(std::size_t row) const;

  const CsvTable& table_;
  std::optional<std::size_t> column_, date_;
  Dates order_ = Dates::found;
  Stamp::Kind kind_ = Stamp::Kind::number;
  std::int32_t offset_s_ = 0;
  std::optional<double> epoch_unit_us_;  ///< of numbers that count since 1970
};

// The fields of one line of a table. Private to io.

/// What separates the fields of a header: the most frequent of comma, semicolon, tab and bar; a space if there is none.
[[nodiscard]] char separator_of(const std::string& line);

/// The fields of a line. '"' quotes, doubled within quotes; ' ' separates at every run of spaces and tabs. They live as
/// long as the line and `unquoted`. False if a quote isn't closed.
[[nodiscard]] bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                                std::vector<std::string>& unquoted);

}  // namespace pirsim::io
