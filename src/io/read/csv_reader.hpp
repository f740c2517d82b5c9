// Tables from CSV files (RFC 4180), with the place of every field.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/error.hpp"
#include "schema/measured_cell.hpp"

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

/// A header and rows of as many fields. Quoted fields, doubled quotes, line ends inside quotes, CRLF and a byte order
/// mark are understood, and UTF-16 with its mark; empty lines are skipped, and comments before the header: lines that
/// begin with '#'.
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
  std::vector<Field> header_;
  std::vector<std::vector<Field>> rows_;
};

/// Columns trial (or seat), sensor, real and, if they are there, min_sim, max_sim, mean_sim; others are ignored.
[[nodiscard]] std::vector<MeasuredCell> read_measured_cells(const std::filesystem::path& path);

}  // namespace pirsim::io
