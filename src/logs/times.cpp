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
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes a text from its front.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  [[nodiscard]] bool at_end() const { return text_.empty(); }
  [[nodiscard]] char front() const { return text_.empty() ? '\0' : text_.front(); }
  bool take(char c) {
    if (front() != c || text_.empty()) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool take_one_of(std::string_view characters) {
    return !text_.empty() && characters.find(front()) != std::string_view::npos && take(front());
  }
  bool take_word(std::string_view word) {  // in any case
    if (text_.size() < word.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i) {
      if (lower(text_[i]) != word[i]) return false;
    }
    text_.remove_prefix(word.size());
    return true;
  }
  /// Also those that don't break, which JavaScript writes before PM.
  void skip_spaces() {
    constexpr std::string_view no_break = "\xC2\xA0", narrow_no_break = "\xE2\x80\xAF";
    while (take(' ') || take_word(no_break) || take_word(narrow_no_break)) {
    }
  }
  struct Number {
    int value = 0;
    std::size_t digits = 0;
  };
  /// Of at most so many digits.
  std::optional<Number> number(std::size_t most) {
    Number number;
    while (number.digits < most && !text_.empty() && is_digit(front())) {
      number.value = 10 * number.value + (front() - '0');
      ++number.digits;
      text_.remove_prefix(1);
    }
    if (number.digits == 0 || is_digit(front())) return std::nullopt;
    return number;
  }
  /// Microseconds of digits after a point.
  std::optional<std::int64_t> fraction() {
    if (!is_digit(front())) return std::nullopt;
    std::int64_t us = 0, unit = us_per_s;
    while (is_digit(front())) {
      unit /= 10;
      us += unit * (front() - '0');
      text_.remove_prefix(1);
    }
    return us;
  }

 private:
  std::string_view text_;
};

struct Parts {
  int first = 0, second = 0, third = 0;
  bool has_short_year = false, has_year_last = false, has_dots = false;
};

std::optional<Parts> date_parts(Scanner& scan) {
  Scanner digits = scan;
  const auto all = digits.number(8);
  if (all && all->digits == 8 && (digits.front() == ' ' || digits.front() == 'T')) {
    scan = digits;
    return Parts{all->value / 10'000, all->value / 100 % 100, all->value % 100};
  }
  const auto first = scan.number(4);
  const char between = scan.front();
  if (!first || !scan.take_one_of("-/.")) return std::nullopt;
  const auto second = scan.number(2);
  if (!second || !scan.take(between)) return std::nullopt;
  const auto third = scan.number(4);
  if (!third) return std::nullopt;
  const bool year_first = first->digits == 4 && third->digits <= 2;
  const bool year_last = first->digits <= 2 && (third->digits == 4 || third->digits == 2);
  if (!year_first && !year_last) return std::nullopt;
  return Parts{first->value, second->value, third->value, year_last && third->digits == 2, year_last, between == '.'};
}

LogMap::Dates order_of_year_last(const Parts& parts) {
  if (parts.has_dots || parts.first > 12) return LogMap::Dates::day_first;
  if (parts.second > 12) return LogMap::Dates::month_first;
  return LogMap::Dates::found;
}

/// A year of two digits may be the first number as well as the last.
LogMap::Dates order_of(const Parts& parts) {
  constexpr int days = 31, months = 12;
  if (!parts.has_short_year || parts.second > months || parts.third > days) return order_of_year_last(parts);
  return parts.first > days ? LogMap::Dates::year_first : LogMap::Dates::found;
}

std::optional<std::int64_t> midnight(const Parts& parts, LogMap::Dates order) {
  constexpr int century = 2000;
  int year = parts.first, month = parts.second, day = parts.third;
  if (parts.has_short_year && order == LogMap::Dates::year_first) {
    year += century;
  } else if (parts.has_year_last) {
    if (order == LogMap::Dates::found || parts.has_dots) order = order_of_year_last(parts);
    year = parts.third + (parts.has_short_year ? century : 0);
    month = order == LogMap::Dates::day_first ? parts.second : parts.first;
    day = order == LogMap::Dates::day_first ? parts.first : parts.second;
  }
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  return us_per_day * std::chrono::sys_days(date).time_since_epoch().count();
}

/// "0:00:34", "10:49:41.25 am", "24:00".
std::optional<std::int64_t> time_of_day(Scanner& scan) {
  const auto hours = scan.number(2);
  if (!hours || !scan.take(':')) return std::nullopt;
  const auto minutes = scan.number(2);
  if (!minutes || minutes->digits != 2 || minutes->value > 59) return std::nullopt;
  std::int64_t us = 60 * us_per_s * minutes->value;
  if (scan.take(':')) {
    const auto seconds = scan.number(2);
    if (!seconds || seconds->digits != 2 || seconds->value > 59) return std::nullopt;
    us += us_per_s * seconds->value;
    if (scan.take_one_of(".,")) {
      const auto part = scan.fraction();
      if (!part) return std::nullopt;
      us += *part;
    }
  }
  int hour = hours->value;
  Scanner after = scan;
  after.skip_spaces();
  const bool is_afternoon = after.take_word("pm") || after.take_word("p.m.");
  if (is_afternoon || after.take_word("am") || after.take_word("a.m.")) {
    if (hour < 1 || hour > 12) return std::nullopt;
    hour = hour % 12 + (is_afternoon ? 12 : 0);
    scan = after;
  }
  us += 3600 * us_per_s * hour;
  if (us > us_per_day) return std::nullopt;
  return us;
}

/// "Z", " UTC", "+02:00", "-0530", "+01"; none: nothing of the kind, 2: what isn't one.
struct Offset {
  enum class Kind { none, given, wrong } kind = Kind::none;
  std::int32_t s = 0;
};
Offset offset(Scanner& scan) {
  if (scan.at_end()) return {};
  if (scan.take_word("z") || scan.take_word("utc") || scan.take_word("gmt")) {
    if (scan.at_end()) return {Offset::Kind::given, 0};
  }
  const bool is_behind = scan.front() == '-';
  if (!scan.take_one_of("+-")) return {Offset::Kind::wrong};
  const auto first = scan.number(4);
  if (!first || first->digits % 2 != 0) return {Offset::Kind::wrong};
  int hours = first->value, minutes = 0;
  if (first->digits == 4) {
    minutes = hours % 100;
    hours /= 100;
  } else if (scan.take(':')) {
    const auto second = scan.number(2);
    if (!second || second->digits != 2) return {Offset::Kind::wrong};
    minutes = second->value;
  }
  if (hours > 14 || minutes > 59 || !scan.at_end()) return {Offset::Kind::wrong};
  const std::int32_t s = 60 * (60 * hours + minutes);
  return {Offset::Kind::given, is_behind ? -s : s};
}

std::optional<Stamp> as_number(std::string_view text) {
  std::optional<double> value = parse_number<double>(text);
  if (!value) {  // a decimal comma
    std::string with_point(text);
    if (const std::size_t comma = with_point.find(','); comma != std::string::npos) with_point[comma] = '.';
    value = parse_number<double>(with_point);
  }
  if (!value || !std::isfinite(*value)) return std::nullopt;
  Stamp stamp;
  stamp.number = *value;
  return stamp;
}

std::optional<Stamp> as_time_of_day(std::string_view text) {
  Scanner scan(text);
  const auto us = time_of_day(scan);
  scan.skip_spaces();
  if (!us || !scan.at_end()) return std::nullopt;
  return Stamp{Stamp::Kind::time_of_day, *us, 0, 0.0};
}

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

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

std::optional<Stamp> parse_stamp(std::string_view text, LogMap::Dates order) {
  text = trimmed(text);
  if (text.empty() || text.size() > 64 || !(is_digit(text.front()) || text.front() == '-' || text.front() == '+'))
    return std::nullopt;
  Scanner scan(text);
  const auto parts = date_parts(scan);
  if (!parts) {
    auto stamp = as_time_of_day(text);
    return stamp ? stamp : as_number(text);
  }
  const auto day = midnight(*parts, order);
  if (!day) return std::nullopt;
  if (scan.at_end()) return Stamp{Stamp::Kind::date, *day, 0, 0.0};
  const bool has_comma = scan.take(',');  // JavaScript's "5/24/2019, 7:50:03 PM"
  if (!has_comma && !scan.take_one_of("Tt ")) return std::nullopt;
  scan.skip_spaces();
  const auto time = time_of_day(scan);
  scan.skip_spaces();
  if (!time) return std::nullopt;
  const Offset ahead = offset(scan);
  if (ahead.kind == Offset::Kind::wrong) return std::nullopt;
  if (ahead.kind == Offset::Kind::none) return Stamp{Stamp::Kind::local, *day + *time, 0, 0.0};
  return Stamp{Stamp::Kind::absolute, *day + *time - ahead.s * us_per_s, ahead.s, 0.0};
}

std::optional<DateOrder> order_of_date(std::string_view text) {
  Scanner scan(trimmed(text));
  const auto parts = date_parts(scan);
  if (!parts || !parts->has_year_last) return std::nullopt;
  return DateOrder{order_of(*parts), order_of_year_last(*parts), parts->first, parts->third};
}

bool is_date_of_digits(std::string_view text) {
  const auto stamp = parse_stamp(std::string(trimmed(text)) + " 0:00", LogMap::Dates::found);
  return trimmed(text).size() == 8 && std::ranges::all_of(trimmed(text), is_digit) && stamp;
}

bool is_half_of_day(std::string_view text) {
  Scanner scan(trimmed(text));
  return (scan.take_word("am") || scan.take_word("pm") || scan.take_word("a.m.") || scan.take_word("p.m.")) &&
         scan.at_end();
}

bool is_offset(std::string_view text) {
  text = trimmed(text);
  const bool is_short = (text.starts_with('+') || text.starts_with('-')) && text.size() < 5;
  Scanner scan(text);
  return !text.empty() && !is_short && offset(scan).kind == Offset::Kind::given;
}

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
