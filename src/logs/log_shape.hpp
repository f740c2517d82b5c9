// What a log's first lines tell of its form.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "logs/log_head.hpp"
#include "logs/log_proof.hpp"
#include "logs/times.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {

/// How the columns of one file are to be read.
struct LogShape {
  char separator = ',';
  int header_line = 0;             ///< 0: the first line is a row
  std::vector<std::string> names;  ///< of the columns; "column 3" where none is told
  HeadTable head;                  ///< the first rows
  TimeColumns time;
  bool is_newest_first = false;  ///< each row of the head is earlier than the one before: nothing else is found then
  LogMap::Form form = LogMap::Form::wide;

  // Of a wide log.
  std::vector<std::size_t> sensors;   ///< columns
  std::optional<std::size_t> people;  ///< column
  LogMap::People people_mean = LogMap::People::count;
  std::vector<std::size_t> runs;      ///< columns that tell runs apart, of rows that have no clock
  std::vector<std::string> others;    ///< columns that nothing is read from
  std::vector<std::string> doubtful;  ///< of them, those whose names don't tell that they are no sensors
  LogMap::Rows rows = LogMap::Rows::found;
  LogMap::Empty empty = LogMap::Empty::found;
  ReadingTracks::Cadence cadence;  ///< of readings; an interval of 0: no two rows have different times

  // Of events and intervals.
  std::vector<std::size_t> sensor;   ///< columns that name it together; none: the file does
  std::optional<std::size_t> state;  ///< intervals may have none; events: each is the begin of motion
  std::optional<TimeColumns> end;    ///< of intervals

  /// Every row has so many fields; 0: at least those that are read, since what follows them is text or nothing.
  [[nodiscard]] std::size_t n_fields() const noexcept {
    return separator == ' ' || header_line == 0 ? 0 : names.size();
  }
  [[nodiscard]] std::size_t n_read_fields() const;
};

/// head: the first lines that are neither empty nor comments; one at least. zone: of local times, or null. before: what
/// rows are in the log's files so far, or found. Throws Error(input), with the maps that settle it if two forms fit.
[[nodiscard]] LogShape shape_of(const std::vector<HeadLine>& head, const LogMap& map, const std::string& file,
                                LogZone* zone, LogMap::Rows before);

}  // namespace pirsim::io
