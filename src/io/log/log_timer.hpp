// From a row's time stamp to a moment. Private to io.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/log/log_zone.hpp"
#include "io/log/stamp.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {

/// Which columns tell the time, and how.
struct TimeColumns {
  std::size_t first = 0;
  std::vector<std::size_t> more{};  ///< what follows the first: a time of day, AM or PM, an offset
  Stamp::Kind kind = Stamp::Kind::local;
  double unit_us = 1e6;                             ///< of numbers
  enum class Zero { epoch, own } zero = Zero::own;  ///< of numbers: what they count from
  LogMap::Dates order = LogMap::Dates::found;

  [[nodiscard]] std::size_t last() const { return more.empty() ? first : std::max(first, std::ranges::max(more)); }
  [[nodiscard]] bool has(std::size_t column) const {
    return column == first || std::ranges::find(more, column) != more.end();
  }
};

/// What numbers of this size count, by the name of their column if they are small: seconds, milli-, micro- or
/// nanoseconds, since 1970 or since something of the log's own.
void set_unit(TimeColumns& columns, double typical, std::string_view name);

class LogTimer {
 public:
  /// The zone, if there is one, outlives it.
  LogTimer(const TimeColumns& columns, LogZone* zone, double shift_s);

  enum class Oddity { none, ambiguous, missing };
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

}  // namespace pirsim::io
