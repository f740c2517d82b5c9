// Time zones, and the moments of a log's rows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/read/stamps.hpp"
#include "pirsim/error.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {

/// Rows that merely changed places are nearer; what steps back by more is a clock that was put back (assumed).
inline constexpr std::int64_t put_back_us = 300 * us_per_s;

// A time zone of the IANA data base, with its summer time.

class LogZone {
 public:
  /// Throws Error: input, at `where`, for a name that the system's data base hasn't got; io if there is none.
  LogZone(const std::string& name, const Where& where);
  ~LogZone();

  /// How much local time is ahead of UTC then, seconds.
  [[nodiscard]] std::int32_t offset_at(std::int64_t utc_us);
  /// From begin to end.
  [[nodiscard]] std::vector<LogOffset> offsets(std::int64_t begin_us, std::int64_t end_us);

  enum class Kind {
    unique,
    ambiguous,  ///< clocks were put back: it was so late twice
    missing     ///< clocks were put forward: it was never so late
  };
  struct Found {
    std::int64_t utc_us;
    std::int64_t later_us;  ///< of an ambiguous time: the second one
    Kind kind;
  };
  /// A missing time is taken as that of a clock that wasn't put forward.
  [[nodiscard]] Found utc_of(std::int64_t local_us);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

// From a row's time stamp to a moment.

/// Which columns tell the time, and how.
struct TimeColumns {
  std::size_t first = 0;
  std::vector<std::size_t> more{};  ///< what follows the first: a time of day, AM or PM, an offset
  Stamp::Kind kind = Stamp::Kind::local;
  double unit_us = 1e6;  ///< of numbers; of days what their times are rounded to
  enum class Zero {
    epoch,
    own,
    excel,             ///< days since 1899-12-30, as spreadsheets count them
    matlab             ///< days since the year 0
  } zero = Zero::own;  ///< of numbers: what they count from
  LogMap::Dates order = LogMap::Dates::found;
  std::string format{};  ///< of a map

  [[nodiscard]] std::size_t last() const { return more.empty() ? first : std::max(first, std::ranges::max(more)); }
  [[nodiscard]] bool has(std::size_t column) const {
    return column == first || std::ranges::find(more, column) != more.end();
  }
};

/// In microseconds, of "time_ms", "Time (h)", "minutes since start"; none if the name tells no unit of time.
[[nodiscard]] std::optional<double> unit_in(std::string_view name);
/// What numbers of this size count, since 1970 or since something of the log's own: small ones the unit that a map's
/// time_format or the name of their column tells, or else seconds.
void set_unit(TimeColumns& columns, double typical, std::string_view name);

class LogTimer {
 public:
  /// The zone, if there is one, outlives it.
  LogTimer(const TimeColumns& columns, LogZone* zone, double shift_s);

  enum class Oddity {
    none,
    ambiguous,
    missing,
    unset  ///< a year of clocks that weren't set
  };
  struct Read {
    std::optional<std::int64_t> us;
    std::string fault = {};  ///< why there is none
    Oddity oddity = Oddity::none;
  };
  [[nodiscard]] Read read(std::span<const std::string_view> fields);
  /// Of a text alone, as --from has it.
  [[nodiscard]] Read read_text(std::string_view text);

  [[nodiscard]] LogClock clock() const noexcept;
  /// Of local time, from begin to end.
  [[nodiscard]] std::vector<LogOffset> offsets(std::int64_t begin_us, std::int64_t end_us);

 private:
  [[nodiscard]] Read from(const Stamp& stamp);
  [[nodiscard]] Read in_zone(std::int64_t local_us);
  void note_offset(std::int64_t us, std::int32_t offset_s);

  TimeColumns columns_;
  LogZone* zone_;
  std::int64_t shift_us_;
  std::string joined_;
  std::vector<LogOffset> seen_;                           ///< of stamps that tell theirs, where it changes
  enum class Pass { first, second } pass_ = Pass::first;  ///< of an hour that there is twice
  std::int64_t last_local_us_ = 0;
};

// Stretches of time in which a track keeps its value.

struct LogRun {
  std::int64_t from_us, to_us;
  std::int32_t value;
};

/// Calls tell(run) for all of a track, in order of time, until the log's end. Readings hold from the reading before.
template <typename Tell>
void each_stretch(const Log& log, const LogTrack& track, Tell tell) {
  for (std::size_t i = 0; i < track.changes.size(); ++i) {
    const LogChange& change = track.changes[i];
    const bool is_last = i + 1 == track.changes.size();
    const std::int64_t end = is_last ? log.end_us : track.changes[i + 1].us - track.changes[i + 1].since_last_us;
    const std::int64_t begin = change.us - change.since_last_us;
    tell(LogRun{begin, std::max(begin, end), change.value});
  }
}

}  // namespace pirsim::io
