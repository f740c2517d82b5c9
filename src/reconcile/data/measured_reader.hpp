// Reads measured rows or sums, and says what is wrong or odd about them. Private to reconcile.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/read/csv_reader.hpp"
#include "pirsim/columns.hpp"
#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {

class MeasuredReader {
 public:
  MeasuredReader(std::string_view text, const std::string& file, const StudyFrame& frame);
  /// Throws Error(input) with every fault.
  [[nodiscard]] Measured read();

 private:
  using RunKey = std::pair<std::size_t, int>;  ///< trial, replicate
  struct Row {
    std::size_t line = 0;  ///< row of the table
    double time_s = 0.0;
  };

  void read_sums();
  void read_rows();
  [[nodiscard]] std::vector<std::optional<std::size_t>> sensor_columns();
  [[nodiscard]] std::optional<std::size_t> column_of(std::string_view name);
  void refuse_unknown_columns(const std::vector<std::string>& sensors);
  [[nodiscard]] std::optional<std::size_t> trial_of(std::size_t row);
  [[nodiscard]] int replicate_of(std::size_t row);
  [[nodiscard]] std::optional<double> number(std::size_t row, std::size_t column);
  void refuse_too_many(const RunKey& run, std::size_t row);
  void refuse_too_long(const std::vector<Row>& rows);
  [[nodiscard]] std::optional<std::size_t> find(const std::vector<std::string>& names, const std::string& what,
                                                std::size_t row, std::size_t column);
  [[nodiscard]] std::size_t first_place(double time_s) const;
  void add_run(RunKey key, std::vector<Row> rows, const std::vector<std::optional<std::size_t>>& columns);
  [[nodiscard]] bool check_times(const std::vector<Row>& rows);
  [[nodiscard]] std::vector<std::uint8_t> bits_of(std::size_t row,
                                                  const std::vector<std::optional<std::size_t>>& columns);
  void mark_main(Series& series, const std::vector<Row>& rows, const std::vector<std::size_t>& places);
  void number_runs();
  void refuse_too_little();

  /// Of a row: its run, and its second there; none for one that no run has.
  [[nodiscard]] std::optional<std::pair<RunKey, double>> place_of(std::size_t row);
  [[nodiscard]] std::optional<std::pair<RunKey, double>> place_in_days(std::size_t row);
  void note_people(std::size_t row, const RunKey& run, double time_s);

  StudyFrame frame_;  ///< of whole runs
  const StudyFrame& asked_;
  std::string file_;
  io::CsvTable table_;
  std::vector<ColumnInfo> columns_;  ///< that the table may have, beside the sensors'
  Diagnostics faults_;
  io::RepeatedFaults repeated_;
  Measured measured_;
  std::optional<std::size_t> trial_, replicate_, phase_, time_;
  std::set<std::string> unknown_names_;
  std::map<std::size_t, std::set<int>> replicates_;  ///< of a trial
  std::optional<std::size_t> local_time_, people_;   ///< columns that say something of days
  std::vector<std::int32_t> counted_;                ///< (n_days x n_rows) people in the data, or -1
  std::size_t outside_ = 0;                          ///< rows
  std::size_t inserted_rows_ = 0, unknown_bits_ = 0, unread_runs_ = 0, filled_rows_ = 0;
};

}  // namespace pirsim::reconcile
