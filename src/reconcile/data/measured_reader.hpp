// Logs of real sensors as measured data: their windows where the script's runs are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/read/csv_reader.hpp"
#include "files/read/row_reader.hpp"
#include "pirsim/columns.hpp"
#include "pirsim/log.hpp"
#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {

/// Whether a file is a log rather than pirsim's own rows or sums: its first line has times and neither `time_s` nor
/// sums, or it is a database. Pipes are read once, by whoever parses rows: they are none.
[[nodiscard]] bool is_log(const std::filesystem::path& file);

/// begin_s: of the script's clock, when its run begins (since 1970); none without a clock. Throws Error(input) for a
/// log of other times or sensors, and for readings that are longer than the script's windows.
[[nodiscard]] Measured measured_of(const Log& log, const StudyFrame& frame, std::optional<std::int64_t> begin_s);

/// What the data's own counts (n_days x n_rows of the frame's units; -1: not known) say that the script's don't.
void note_people(const StudyFrame& frame, std::span<const std::int32_t> counted, LogMap::People means,
                 std::vector<DataNote>& notes);

// Reads measured rows or sums, and says what is wrong or odd about them. Private to reconcile.

class MeasuredReader {
 public:
  MeasuredReader(std::string_view bytes, const std::string& file, const StudyFrame& frame);
  /// Throws Error(input) with every fault.
  [[nodiscard]] Measured read();

 private:
  using RunKey = std::pair<std::size_t, int>;  ///< trial, replicate
  struct Row {
    Where where;  ///< of its time
    double time_s = 0.0;
    bool is_counted = true;  ///< by its phase
    std::vector<std::uint8_t> bits{};
  };
  using Place = std::optional<std::pair<RunKey, double>>;  ///< of a row: its run, and its second there

  void read_sums(const io::CsvTable& table);
  void read_rows(io::RowReader& reader);
  void refuse_unknown_columns(const std::vector<std::string>& names, std::span<const ColumnInfo> columns);
  [[nodiscard]] std::vector<std::optional<std::size_t>> sensor_columns(const std::vector<std::string>& names);
  [[nodiscard]] std::optional<std::size_t> find(const std::vector<std::string>& names, const std::string& what,
                                                const std::string& name, const Where& where);
  void refuse_too_many(const RunKey& run, const Where& where);
  void refuse_too_long(const std::vector<Row>& rows);
  [[nodiscard]] std::size_t first_place(double time_s) const;
  void add_run(RunKey key, const std::vector<Row>& rows);
  [[nodiscard]] bool check_times(const std::vector<Row>& rows);
  void mark_main(Series& series, const std::vector<Row>& rows, const std::vector<std::size_t>& places);
  void number_runs();
  void refuse_too_little();

  [[nodiscard]] int replicate_of(const Sample& row, const io::RowFormat& format);
  [[nodiscard]] Place place_of(const Sample& row, const io::RowFormat& format);
  [[nodiscard]] Place place_in_days(const Sample& row, const io::RowFormat& format);

  StudyFrame frame_;  ///< of whole runs
  const StudyFrame& asked_;
  std::string text_, file_;
  Diagnostics faults_;
  io::RepeatedFaults repeated_;
  Measured measured_;
  bool tells_phases_ = false;  ///< that are counted
  double step_s_ = 0.0;        ///< of the rows
  std::set<std::string> unknown_names_;
  std::map<std::size_t, std::set<int>> replicates_;  ///< of a trial
  std::size_t outside_ = 0;                          ///< rows
  std::size_t inserted_rows_ = 0, unknown_bits_ = 0, unread_runs_ = 0, filled_rows_ = 0;
};

}  // namespace pirsim::reconcile
