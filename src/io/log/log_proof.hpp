// What the rows themselves say of a log's form: proofs, so that no form is guessed. Private to io.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/log/log_tracks.hpp"

namespace pirsim::io {

/// A map of one line, to be pasted, that settles what rows leave open: "{pirsim_log: 1, rows: changes}".
[[nodiscard]] std::string settling_map(const std::string& keys);
/// "...; a map settles it: A, or B"
[[nodiscard]] std::string with_maps(const std::string& why, const std::vector<std::string>& keys);

/// A row of a wide log: its time, and the states of its sensors.
struct StateRow {
  std::int64_t us = 0;
  std::vector<std::int32_t> states;
};

/// Readings have a cadence; rows of changes come when something changes.
struct RowsProof {
  enum class Are { readings, changes, either } are = Are::either;
  std::string why;               ///< of either
  bool are_in_step = false;      ///< nearly all rows are as far apart
  ReadingTracks::Cadence usual;  ///< of readings; an interval of 0: no two rows have different times
};
[[nodiscard]] RowsProof proof_of_rows(std::span<const StateRow> rows);

/// A row that may be an event of the sensor that is named there.
struct NamedRow {
  std::int64_t us = 0;
  std::string_view name;
  std::int32_t state = 0;
};
struct NamesProof {
  double own_turns = 0.0;        ///< of rows whose name came before: the share with another state than there
  double all_turns = 0.0;        ///< of rows: the share with another state than the row before, whatever its name
  double switches = 0.0;         ///< of rows: the share with another name than the row before
  double turns_at_switch = 0.0;  ///< of rows with another name than the row before: the share with another state
  double same_time = 0.0;        ///< of rows: the share with another name than the row before, but its time
};
[[nodiscard]] NamesProof proof_of_names(std::span<const NamedRow> rows);

/// One column is on where the other one is off, and that changes often: they are no two sensors.
[[nodiscard]] bool are_opposites(std::span<const StateRow> rows, std::size_t a, std::size_t b);

/// A table whose columns were joined by time: a cell is empty where its sensor didn't change.
enum class Cells {
  full,      ///< or empty for whole stretches
  pivot,     ///< few are known, and those alternate
  scattered  ///< few are known, and don't tell why
};
[[nodiscard]] Cells cells_of(std::span<const StateRow> rows);

}  // namespace pirsim::io
