// The one reader of rows: of runs, of a dataset's days, measured ones, and those that `pirsim log -o` writes.
// docs/formats/rows.md
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/read/csv_reader.hpp"
#include "pirsim/columns.hpp"

namespace pirsim::io {

/// What a table's first line says its columns are, and what each line tells by that.
class RowFormat {
 public:
  /// A column that isn't a sensor's, an area's or a door's, by its name or alias.
  enum Column : std::size_t { replicate, room, trial, day, time_s, time, phase, people, n_columns };

  /// where: of the header. Throws Error(input) with all that is wrong with it.
  RowFormat(std::string_view header, const Where& where);

  [[nodiscard]] const ColumnOwners& columns() const noexcept { return owners_; }
  [[nodiscard]] bool has(Column column) const noexcept { return at_[column].has_value(); }
  /// In the line that was read last, which is still there.
  [[nodiscard]] Where where(Column column) const { return place(at_[column].value_or(0)); }

  /// A line after the header. A room of a dataset is its row's replicate, the day its trial. An empty bit is
  /// unknown_bit, an empty number of people unknown_people. Columns that are empty in the first row of a dataset's day
  /// are those of other rooms: absent_bit, absent_people. False after a fault, which is added.
  bool read(std::string_view line, int line_number, Sample& row, RepeatedFaults& faults);

 private:
  void name_columns(const Where& header);
  void refuse_slips(Diagnostics& faults) const;
  void mark_absent(Sample& row, RepeatedFaults& faults);
  [[nodiscard]] bool split(RepeatedFaults& faults);
  [[nodiscard]] Where place(std::size_t field) const;
  template <typename Number>
  void take(Number& number, std::size_t field, RepeatedFaults& faults) const;
  [[nodiscard]] int count(std::size_t field, RepeatedFaults& faults) const;
  [[nodiscard]] std::uint8_t bit(std::size_t field, RepeatedFaults& faults) const;
  void take_clock(std::string& clock, RepeatedFaults& faults) const;

  std::vector<std::string> names_;
  ColumnOwners owners_;
  std::vector<std::size_t> sensors_, areas_, doors_;  ///< fields
  std::array<std::optional<std::size_t>, n_columns> at_;
  std::string file_;
  std::vector<std::string_view> fields_;
  std::vector<std::string> unquoted_;
  std::string_view line_;
  int line_number_ = 0;
  std::optional<std::pair<int, std::string>> own_day_;  ///< whose columns are known
  std::vector<bool> is_absent_;                         ///< by field, in that day
};

/// Rows of a table, one after the other, as they come. What is wrong with them is told with line and column, each kind
/// once with how many more there are.
class RowReader {
 public:
  /// A file or a pipe, compressed or not. It is opened once. Throws Error: io, input.
  explicit RowReader(const std::filesystem::path& file);
  /// The bytes of one; `name` stands in messages.
  RowReader(std::string_view bytes, const std::string& name);
  ~RowReader();

  [[nodiscard]] const RowFormat& format() const noexcept { return format_; }
  /// How far most of the first rows are apart, or the time of a single one; 0 without rows.
  [[nodiscard]] double step_s() const noexcept { return step_s_; }

  /// False at the end. Throws Error(input) for a faulty row, for one that isn't a whole number of steps after the one
  /// before, and where rows of a run don't follow each other.
  [[nodiscard]] bool next(Sample& row);
  /// Rows that the run lacks before the one that was read last.
  [[nodiscard]] std::int64_t n_missing() const noexcept { return n_missing_; }
  /// The same, but also the rows that are missing: bits and people that nobody knows.
  [[nodiscard]] bool next_of_all(Sample& row);
  [[nodiscard]] bool is_filled() const noexcept { return n_to_fill_ > 0; }  ///< the last of those was missing

 private:
  class Lines;
  explicit RowReader(std::unique_ptr<Lines> lines);
  [[nodiscard]] double usual_step_s();
  void check(const Sample& row);
  void check_clock(const Sample& row);
  [[nodiscard]] std::int64_t missing_in(double step_s);
  [[noreturn]] void refuse();

  std::unique_ptr<Lines> lines_;
  RowFormat format_;
  RepeatedFaults faults_;
  double step_s_ = 0.0;
  std::int64_t n_missing_ = 0;
  std::set<std::pair<int, std::string>> runs_;  ///< that have begun
  int replicate_ = 0;                           ///< of the row before, as what follows
  std::string trial_, clock_;
  double time_s_ = 0.0;
  std::int64_t gap_ = 0;  ///< before it
  int n_alike_ = 0;       ///< gaps of that length without a row in between that follows at once

  Sample behind_gap_;
  std::int64_t n_to_fill_ = 0;
};

}  // namespace pirsim::io
