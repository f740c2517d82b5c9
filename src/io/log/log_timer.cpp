#include "io/log/log_timer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "io/log/log_units.hpp"

namespace pirsim::io {
namespace {

// What is outside is a clock that wasn't set, or a column that is no time. `assumed`: no log of motion is older.
constexpr int first_year = 1990, end_year = 2100;

int year_of(std::int64_t us) {
  const auto day = std::chrono::floor<std::chrono::days>(
      std::chrono::sys_time<std::chrono::microseconds>(std::chrono::microseconds(us)));
  return static_cast<int>(std::chrono::year_month_day(day).year());
}

}  // namespace

void set_unit(TimeColumns& columns, double typical, std::string_view name) {
  const double size = std::abs(typical);
  const bool is_in_ms = name.ends_with("_ms") || name.find("milli") != std::string_view::npos;
  columns.zero = size < (is_in_ms ? 1e11 : 1e8) ? TimeColumns::Zero::own : TimeColumns::Zero::epoch;
  if (columns.zero == TimeColumns::Zero::own) {
    columns.unit_us = is_in_ms ? 1e3 : 1e6;
  } else {  // 2001 is 1e9 s
    columns.unit_us = size < 1e11 ? 1e6 : size < 1e14 ? 1e3 : size < 1e17 ? 1.0 : 1e-3;
  }
}

LogTimer::LogTimer(const TimeColumns& columns, LogZone* zone, double shift_s)
    : columns_(columns), zone_(zone), shift_us_(std::llround(shift_s * 1e6)) {}

LogTimer::Read LogTimer::read(std::span<const std::string_view> fields) {
  if (columns_.more.empty()) return read_text(fields[columns_.first]);
  joined_.assign(fields[columns_.first]);
  for (const std::size_t column : columns_.more) (joined_ += ' ') += fields[column];
  return read_text(joined_);
}

LogTimer::Read LogTimer::read_text(std::string_view text) {
  const auto stamp = parse_stamp(text, columns_.order);
  if (!stamp) return {std::nullopt, "'" + std::string(text) + "' is no time that can be read"};
  const bool is_midnight = stamp->kind == Stamp::Kind::date && columns_.kind == Stamp::Kind::local;
  if (stamp->kind != columns_.kind && !is_midnight) {
    return {std::nullopt, "'" + std::string(text) + "' is another kind of time than those above it"};
  }
  Read result = from(*stamp);
  if (!result.us) return result;
  *result.us += shift_us_;
  if (clock() == LogClock::elapsed) return result;
  const int year = year_of(*result.us);
  if (year >= first_year && year < end_year) return result;
  return {std::nullopt, "'" + std::string(text) + "' is in the year " + std::to_string(year) +
                            ", and no log is from before 1990 or after 2099: was the clock set?"};
}

LogTimer::Read LogTimer::from(const Stamp& stamp) {
  switch (stamp.kind) {
    case Stamp::Kind::number: {
      const double us = stamp.number * columns_.unit_us;
      constexpr double most_us = 8e15;  // the year 2223
      if (std::abs(us) > most_us) return {std::nullopt, shortest_number(stamp.number) + " is too large for a time"};
      return {std::llround(us)};
    }
    case Stamp::Kind::time_of_day:
      return {stamp.us};
    case Stamp::Kind::absolute:
      if (zone_ == nullptr) note_offset(stamp.us, stamp.offset_s);
      return {stamp.us};
    case Stamp::Kind::date:
    case Stamp::Kind::local:
      break;
  }
  return zone_ == nullptr ? Read{stamp.us} : in_zone(stamp.us);
}

/// An hour that there is twice: the first time, until the times step back or once they did.
LogTimer::Read LogTimer::in_zone(std::int64_t local_us) {
  constexpr std::int64_t a_step_us = 1200 * us_per_s;  // assumed: rows that merely changed places are nearer
  const LogZone::Found found = zone_->utc_of(local_us);
  const bool steps_back = local_us + a_step_us < last_local_us_;
  last_local_us_ = local_us;
  if (found.kind != LogZone::Kind::ambiguous) {
    pass_ = Pass::first;
    return {found.utc_us, {}, found.kind == LogZone::Kind::missing ? Oddity::missing : Oddity::none};
  }
  const bool is_before_both = steps_back && pass_ == Pass::second;  // another sensor's rows begin
  if (steps_back) pass_ = is_before_both ? Pass::first : Pass::second;
  return {pass_ == Pass::second ? found.later_us : found.utc_us, {}, Oddity::ambiguous};
}

void LogTimer::note_offset(std::int64_t us, std::int32_t offset_s) {
  if (seen_.empty() || seen_.back().offset_s != offset_s) seen_.push_back({us + shift_us_, offset_s});
}

LogClock LogTimer::clock() const noexcept {
  const bool is_number = columns_.kind == Stamp::Kind::number;
  if (columns_.kind == Stamp::Kind::time_of_day || (is_number && columns_.zero == TimeColumns::Zero::own))
    return LogClock::elapsed;
  const bool is_told = is_number || columns_.kind == Stamp::Kind::absolute || zone_ != nullptr;
  return is_told ? LogClock::zoned : LogClock::local;
}

std::vector<LogOffset> LogTimer::offsets(std::int64_t begin_us, std::int64_t end_us) {
  if (clock() != LogClock::zoned) return {{begin_us, 0}};
  if (zone_ != nullptr) return zone_->offsets(begin_us, end_us);
  if (seen_.empty()) return {{begin_us, 0}};
  std::ranges::stable_sort(seen_, {}, &LogOffset::from_us);
  std::vector<LogOffset> changes;
  for (const LogOffset& offset : seen_) {
    if (changes.empty() || changes.back().offset_s != offset.offset_s) changes.push_back(offset);
  }
  return changes;
}

}  // namespace pirsim::io
