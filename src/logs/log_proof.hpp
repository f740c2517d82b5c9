// Readings and events as they come in, put together to tracks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pirsim/log.hpp"

namespace pirsim::io {

/// Of one file, all sensors at the same moments.
class ReadingTracks {
 public:
  struct Cadence {
    std::int64_t interval_us = 0;
    std::int64_t longest_gap_us = 0;  ///< between two readings that both hold until the next one
  };
  /// unknown: of each track, the value that tells nothing.
  ReadingTracks(const Cadence& cadence, std::vector<std::int32_t> unknown);

  enum class Order { later, same, earlier };
  /// What isn't later than the last reading is left out.
  Order add(std::int64_t us, std::span<const std::int32_t> values);

  [[nodiscard]] bool is_empty() const noexcept { return n_ == 0; }
  [[nodiscard]] std::int64_t first_us() const noexcept { return first_us_; }
  [[nodiscard]] std::int64_t last_us() const noexcept { return last_us_; }
  [[nodiscard]] std::uint64_t n_readings() const noexcept { return n_; }
  [[nodiscard]] std::size_t n_changes() const noexcept { return n_changes_; }
  [[nodiscard]] const Cadence& cadence() const noexcept { return cadence_; }
  [[nodiscard]] std::vector<std::vector<LogChange>>& changes() noexcept { return changes_; }

 private:
  void put(std::size_t track, std::int64_t us, std::int64_t since_last_us, std::int32_t value);

  Cadence cadence_;
  std::vector<std::int32_t> unknown_;
  std::vector<std::vector<LogChange>> changes_;
  std::int64_t first_us_ = 0, last_us_ = 0;
  std::uint64_t n_ = 0;
  std::size_t n_changes_ = 0;
};

/// How often a sensor's cells were states, and the first that was none.
struct CellCounts {
  std::uint64_t n_states = 0, n_other = 0;
  Where odd_at{};
  std::string odd_text{};

  void add_odd(std::string_view text, const std::string& path, int line) {
    if (n_other++ > 0) return;
    odd_at = {path, line, 0};
    odd_text = text;
  }
};

/// How the times of rows step back, from one to the next.
class StepsBack {
 public:
  /// Another file, which may tell of earlier times.
  void restart() noexcept { is_first_ = true; }
  /// Whether it is earlier than the row before.
  bool add(std::int64_t us) {
    if (std::exchange(is_first_, false)) last_us_ = latest_us_ = us;
    const bool steps = us < last_us_;
    n_steps_ += steps ? 1 : 0;
    is_behind_ = us < latest_us_ || (is_behind_ && us == latest_us_);
    n_behind_ += is_behind_ ? 1 : 0;
    last_us_ = us;
    latest_us_ = std::max(latest_us_, us);
    farthest_us_ = std::max(farthest_us_, latest_us_ - us);
    return steps;
  }
  [[nodiscard]] std::uint64_t n_steps() const noexcept { return n_steps_; }
  /// Rows after a step, until the times are later than before.
  [[nodiscard]] std::uint64_t n_behind() const noexcept { return n_behind_; }
  [[nodiscard]] std::int64_t farthest_us() const noexcept { return farthest_us_; }

 private:
  bool is_first_ = true, is_behind_ = false;
  std::uint64_t n_steps_ = 0, n_behind_ = 0;
  std::int64_t last_us_ = 0, latest_us_ = 0, farthest_us_ = 0;
};

/// Of all files; events may come in any order.
class EventTracks {
 public:
  struct Track : CellCounts {
    explicit Track(std::string_view name) : in_log(name) {}
    std::string in_log;
    std::vector<LogChange> events{};
    StepsBack order{};
    struct FilePart {
      std::size_t file;
      std::int64_t first_us, last_us;
      std::size_t first_event;  ///< that the file tells
    };
    std::vector<FilePart> parts{};  ///< of each file that tells of it
  };
  void begin_file() noexcept { ++file_; }
  /// Finds or makes it; none if there are too many.
  [[nodiscard]] Track* track(std::string_view in_log);
  /// False if it is earlier than the track's last one.
  bool add(Track& track, std::int64_t us, std::int32_t value);
  /// The file tells of it at this time, too.
  void note(Track& track, std::int64_t us);

  [[nodiscard]] std::size_t n_events() const noexcept { return n_events_; }
  [[nodiscard]] std::vector<Track>& tracks() noexcept { return tracks_; }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const noexcept { return std::hash<std::string_view>{}(text); }
  };
  std::vector<Track> tracks_;
  std::unordered_map<std::string, std::size_t, Hash, std::equal_to<>> index_;
  std::size_t n_events_ = 0, file_ = 0;
};

/// What a map says of the ends of motion.
struct MotionEnds {
  std::optional<std::int64_t> hold_us;     ///< how long an `on` lasts whose end isn't told: no `off` comes next
  std::optional<std::int64_t> longest_us;  ///< an `on` of which nothing was told for longer is unknown from there on
};
/// Events in order of time, those that change nothing left out. Calls lost(moment) where motion became unknown.
[[nodiscard]] std::vector<LogChange> changes_of(EventTracks::Track& track, const MotionEnds& ends,
                                                const std::function<void(std::int64_t)>& lost);

/// Of events that are the begin and the end of intervals in turn: on where any interval is, off at all other times from
/// begin_us on. Calls overlap(moment) where one begins within another.
[[nodiscard]] std::vector<LogChange> united(EventTracks::Track& track, std::int64_t begin_us,
                                            const std::function<void(std::int64_t)>& overlap);

// What the rows themselves say of a log's form: proofs, so that no form is guessed.

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
