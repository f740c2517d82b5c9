#include "logs/times.hpp"

#include <date/tz.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "files/disk/file.hpp"
#include "logs/log_head.hpp"
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {
namespace {

using std::chrono::seconds;
/// Rounded down.
seconds whole_seconds(std::int64_t us) { return std::chrono::floor<seconds>(std::chrono::microseconds(us)); }

/// Some systems keep the rules of years to come in a form that the date library passes over: clocks would never be
/// changed again, and nobody would know. Such a data base lacks what every other one has.
void require_coming_years(const date::tzdb& known) {
  constexpr seconds july_2036{2'098'656'000};
  constexpr seconds ahead{7200};
  for (const date::time_zone& zone : known.zones) {
    if (zone.name() != "Europe/Berlin") continue;
    if (zone.get_info(date::sys_seconds(july_2036)).offset == ahead) return;
    throw Error(ErrorCode::io,
                "the system's time zones don't list summer times of the years to come (made by zic -b slim); "
                "time_zone needs those that do (zic -b fat)");
  }
}

const date::time_zone* find_zone(const std::string& name, const Where& where) {
  try {
    const date::tzdb& known = date::get_tzdb();
    require_coming_years(known);
    for (const date::time_zone& zone : known.zones) {
      if (zone.name() == name) return &zone;
    }
    std::vector<std::string> names;
    for (const date::time_zone& zone : known.zones) names.push_back(zone.name());
    throw Error(ErrorCode::input, where,
                "time_zone: '" + name + "' is not a time zone, as Europe/Berlin is one" + did_you_mean(name, names));
  } catch (const std::runtime_error& fault) {
    if (dynamic_cast<const Error*>(&fault) != nullptr) throw;
    throw Error(ErrorCode::io, std::string("the system's time zones can't be read (package tzdata): ") + fault.what());
  }
}

// What is outside is a clock that wasn't set, or a column that is no time. `assumed`: no log of motion is older.
constexpr int first_year = 1990, end_year = 2100;

int year_of(std::int64_t us) {
  const auto day = std::chrono::floor<std::chrono::days>(
      std::chrono::sys_time<std::chrono::microseconds>(std::chrono::microseconds(us)));
  return static_cast<int>(std::chrono::year_month_day(day).year());
}

}  // namespace

struct LogZone::Data {
  const date::time_zone* zone;
  std::optional<date::sys_info> last;  ///< most times have the offset of the one before

  const date::sys_info& at(seconds utc) {
    const date::sys_seconds moment(utc);
    if (!last || moment < last->begin || moment >= last->end) last = zone->get_info(moment);
    return *last;
  }
};

LogZone::LogZone(const std::string& name, const Where& where)
    : data_(std::make_unique<Data>(Data{find_zone(name, where), std::nullopt})) {}
LogZone::~LogZone() = default;

std::int32_t LogZone::offset_at(std::int64_t utc_us) {
  return static_cast<std::int32_t>(data_->at(whole_seconds(utc_us)).offset.count());
}

std::vector<LogOffset> LogZone::offsets(std::int64_t begin_us, std::int64_t end_us) {
  std::vector<LogOffset> found;
  std::int64_t from_us = begin_us;
  while (true) {
    const date::sys_info& info = data_->at(whole_seconds(from_us));
    found.push_back({from_us, static_cast<std::int32_t>(info.offset.count())});
    const seconds end = info.end.time_since_epoch();
    if (end > whole_seconds(end_us)) return found;
    from_us = us_per_s * end.count();
  }
}

LogZone::Found LogZone::utc_of(std::int64_t local_us) {
  constexpr std::int64_t away_us = 86'400 * us_per_s;  // from any change, so that none can concern it
  if (data_->last) {
    const std::int64_t utc_us = local_us - us_per_s * data_->last->offset.count();
    const seconds before = whole_seconds(utc_us - away_us), after = whole_seconds(utc_us + away_us);
    if (before >= data_->last->begin.time_since_epoch() && after < data_->last->end.time_since_epoch())
      return {utc_us, utc_us, Kind::unique};
  }
  const date::local_info found = data_->zone->get_info(date::local_seconds(whole_seconds(local_us)));
  const std::int64_t first = local_us - us_per_s * found.first.offset.count();
  data_->last = found.first;
  if (found.result == date::local_info::unique) return {first, first, Kind::unique};
  const std::int64_t second = local_us - us_per_s * found.second.offset.count();
  return {first, second, found.result == date::local_info::ambiguous ? Kind::ambiguous : Kind::missing};
}

std::optional<double> unit_in(std::string_view name) {
  constexpr std::array<std::string_view, 11> units{"us",  "micro", "ms", "milli", "s",  "sec",
                                                   "min", "h",     "hr", "hour",  "day"};
  constexpr std::array<double, units.size()> us{1.0, 1.0, 1e3, 1e3, 1e6, 1e6, 6e7, 3.6e9, 3.6e9, 3.6e9, 8.64e10};
  for (const std::string& word : words_of_name(name)) {
    for (std::size_t i = 0; i < units.size(); ++i) {
      if (word == units[i] || (units[i].size() > 2 && word.starts_with(units[i]))) return us[i];
    }
    if (word == "of" || word == "since") break;  // "time of day"
  }
  return std::nullopt;
}

void set_unit(TimeColumns& columns, double typical, std::string_view name) {
  const auto told = unit_in(columns.format);
  const double unit_us = told ? *told : unit_in(name).value_or(1e6);
  const bool is_own = std::abs(typical) < (unit_us < 1e3 ? 1e14 : unit_us < 1e6 ? 1e11 : 1e8);
  columns.zero = is_own ? TimeColumns::Zero::own : TimeColumns::Zero::epoch;
  columns.unit_us = is_own ? unit_us : *epoch_unit_us(typical);
}

/// In days since 1970; none: not days.
static std::optional<double> day_of_zero(TimeColumns::Zero zero) {
  constexpr double excel = -25'569.0, matlab = -719'529.0;
  if (zero != TimeColumns::Zero::excel && zero != TimeColumns::Zero::matlab) return std::nullopt;
  return zero == TimeColumns::Zero::excel ? excel : matlab;
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
  const auto stamp = parse_stamp(text, columns_.order, columns_.format);
  if (!stamp) {
    return {std::nullopt, "'" + std::string(text) + "' is no time that can be read" +
                              (columns_.format.empty() ? "" : " by time_format, '" + columns_.format + "'")};
  }
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
  return {std::nullopt,
          "'" + std::string(text) + "' is in the year " + std::to_string(year) +
              ", and no log is from before 1990 or after 2099",
          Oddity::unset};
}

LogTimer::Read LogTimer::from(const Stamp& stamp) {
  switch (stamp.kind) {
    case Stamp::Kind::number: {
      if (const auto zero = day_of_zero(columns_.zero)) {
        const double steps = (stamp.number + *zero) * us_per_day / columns_.unit_us;
        const std::int64_t local_us = std::llround(steps) * std::llround(columns_.unit_us);
        return zone_ == nullptr ? Read{local_us} : in_zone(local_us);
      }
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
  const LogZone::Found found = zone_->utc_of(local_us);
  const bool steps_back = local_us + put_back_us < last_local_us_;
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
  const bool are_days = is_number && day_of_zero(columns_.zero).has_value();
  const bool is_told = (is_number && !are_days) || columns_.kind == Stamp::Kind::absolute || zone_ != nullptr;
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

namespace pirsim {

// Moments of a log, and how they are told.

using io::us_per_s;
LogMoment Log::moment(std::int64_t us) const {
  const auto after = std::ranges::upper_bound(offsets, us, {}, &LogOffset::from_us);
  if (offsets.empty()) return {us, 0};
  return {us, after == offsets.begin() ? after->offset_s : (after - 1)->offset_s};
}

std::string to_text(const LogMoment& moment, LogClock clock) {
  if (clock == LogClock::elapsed) return shortest_number(moment.seconds()) + " s";
  const std::int64_t local = moment.local_us();
  const std::int64_t part = ((local % us_per_s) + us_per_s) % us_per_s;
  std::string text = RunClock{(local - part) / us_per_s}.text(0.0);
  if (part == 0) return text;
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), ".%06d", static_cast<int>(part));
  text += digits.data();
  while (text.ends_with('0')) text.pop_back();
  return text;
}

}  // namespace pirsim
