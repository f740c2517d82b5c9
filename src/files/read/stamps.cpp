#include "files/read/stamps.hpp"

#include <date/date.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <locale>
#include <sstream>

#include "files/disk/file.hpp"

namespace pirsim::io {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes a text from its front.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  [[nodiscard]] bool at_end() const { return text_.empty(); }
  [[nodiscard]] std::string_view rest() const { return text_; }
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

Dates order_of_year_last(const Parts& parts) {
  if (parts.has_dots || parts.first > 12) return Dates::day_first;
  if (parts.second > 12) return Dates::month_first;
  return Dates::found;
}

/// A year of two digits may be the first number as well as the last.
Dates order_of(const Parts& parts) {
  constexpr int days = 31, months = 12;
  if (!parts.has_short_year || parts.second > months || parts.third > days) return order_of_year_last(parts);
  return parts.first > days ? Dates::year_first : Dates::found;
}

std::optional<std::int64_t> midnight(const Parts& parts, Dates order) {
  constexpr int century = 2000;
  int year = parts.first, month = parts.second, day = parts.third;
  if (parts.has_short_year && order == Dates::year_first) {
    year += century;
  } else if (parts.has_year_last) {
    if (order == Dates::found || parts.has_dots) order = order_of_year_last(parts);
    year = parts.third + (parts.has_short_year ? century : 0);
    month = order == Dates::day_first ? parts.second : parts.first;
    day = order == Dates::day_first ? parts.first : parts.second;
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
  const auto value = decimal_number(text);
  if (!value) return std::nullopt;
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

/// What the date library reads: dates with names of months, before a time of day, and whole times.
constexpr std::array date_patterns{"%d-%b-%y",  "%d-%b-%Y", "%d/%b/%Y",     "%d %b %Y",
                                   "%b %d, %Y", "%b %d %Y", "%a, %d %b %Y", "%a, %b %d, %Y"};
constexpr std::array moment_patterns{"%Y%m%d%H%M%S",    "%Y%m%dT%H%M%S",        "%Y%m%dT%H%M%SZ",
                                     "%Y%m%dT%H%M%S%z", "%a %b %d %H:%M:%S %Y", "%a %b %d %H:%M:%S %Z %Y"};
bool has_pattern(std::string_view format) { return format.find('%') != std::string_view::npos; }

constexpr std::array<std::pair<std::string_view, const char*>, 18> zone_names{{{"CET", "Europe/Berlin"},
                                                                               {"CEST", "Europe/Berlin"},
                                                                               {"MEZ", "Europe/Berlin"},
                                                                               {"MESZ", "Europe/Berlin"},
                                                                               {"EET", "Europe/Helsinki"},
                                                                               {"EEST", "Europe/Helsinki"},
                                                                               {"WET", "Europe/Lisbon"},
                                                                               {"WEST", "Europe/Lisbon"},
                                                                               {"BST", "Europe/London"},
                                                                               {"EST", "America/New_York"},
                                                                               {"EDT", "America/New_York"},
                                                                               {"CST", "America/Chicago"},
                                                                               {"CDT", "America/Chicago"},
                                                                               {"MST", "America/Denver"},
                                                                               {"MDT", "America/Denver"},
                                                                               {"PST", "America/Los_Angeles"},
                                                                               {"PDT", "America/Los_Angeles"},
                                                                               {"JST", "Asia/Tokyo"}}};

/// The zone's name at the end of a text, which is left out there; empty if there is none.
std::string_view take_zone_name(std::string_view& text) {
  const std::size_t space = text.find_last_of(' ');
  const std::string_view last = text.substr(space == std::string_view::npos ? 0 : space + 1);
  const auto known = std::ranges::find(zone_names, last, [](const auto& zone) { return zone.first; });
  const bool is_twice = space != std::string_view::npos && (last == "UTC" || known != zone_names.end());
  if (known == zone_names.end() && !is_twice) return {};
  text.remove_suffix(text.size() - (is_twice ? space : 0));
  return is_twice ? std::string_view() : known->first;  // Go's "+0000 UTC" says it twice
}

template <typename Time>
struct ByPattern {
  Time time{};
  std::string zone{};
  std::chrono::minutes ahead{std::chrono::minutes::min()};  ///< none
  std::string_view rest{};                                  ///< of the text
};
template <typename Time>
std::optional<ByPattern<Time>> by_pattern(std::string_view text, const char* pattern) {
  std::istringstream in{std::string(text)};
  in.imbue(std::locale::classic());
  ByPattern<Time> read;
  if (date::from_stream(in, pattern, read.time, &read.zone, &read.ahead).fail()) return std::nullopt;
  if (in.peek() != std::istringstream::traits_type::eof())
    read.rest = text.substr(static_cast<std::size_t>(in.tellg()));
  return read;
}

std::optional<Stamp> by_whole_pattern(std::string_view text, const char* pattern) {
  const auto read = by_pattern<date::local_time<std::chrono::nanoseconds>>(text, pattern);
  if (!read || !read->rest.empty()) return std::nullopt;
  const std::int64_t us = std::chrono::floor<std::chrono::microseconds>(read->time.time_since_epoch()).count();
  const bool is_utc = std::string_view(pattern).ends_with("SZ") || read->zone == "UTC" || read->zone == "GMT";
  const auto named = std::ranges::find(zone_names, read->zone, [](const auto& zone) { return zone.first; });
  if (read->ahead == std::chrono::minutes::min() && !is_utc)
    return Stamp{Stamp::Kind::local, us, 0, 0.0, named == zone_names.end() ? std::string_view() : named->first};
  const auto offset_s = is_utc ? 0 : static_cast<std::int32_t>(60 * read->ahead.count());
  return Stamp{Stamp::Kind::absolute, us - offset_s * us_per_s, offset_s, 0.0};
}

/// What follows a date: nothing, or a time of day, with an offset or the name of a zone.
std::optional<Stamp> behind_date(Scanner scan, std::int64_t day) {
  if (scan.at_end()) return Stamp{Stamp::Kind::date, day, 0, 0.0};
  const bool has_word = scan.take(',') || scan.take_word(" at ");  // JavaScript's "5/24/2019, 7:50:03 PM"
  if (!has_word && !scan.take_one_of("Tt _:")) return std::nullopt;
  scan.skip_spaces();
  const auto time = time_of_day(scan);
  scan.skip_spaces();
  if (!time) return std::nullopt;
  std::string_view rest = scan.rest();
  const std::string_view zone = take_zone_name(rest);
  scan = Scanner(rest);
  const Offset ahead = offset(scan);
  if (ahead.kind == Offset::Kind::wrong) return std::nullopt;
  if (ahead.kind == Offset::Kind::none) return Stamp{Stamp::Kind::local, day + *time, 0, 0.0, zone};
  return Stamp{Stamp::Kind::absolute, day + *time - ahead.s * us_per_s, ahead.s, 0.0};
}

/// With names of months, or digits alone.
std::optional<Stamp> by_patterns(std::string_view text) {
  constexpr std::string_view names = "jan feb mar apr may jun jul aug sep oct nov dec mon tue wed thu fri sat sun";
  constexpr std::size_t shortest = 8;
  if (text.size() < shortest) return std::nullopt;
  const auto is_letter = [](char c) { return lower(c) >= 'a' && lower(c) <= 'z'; };
  std::string word;
  const auto letter = std::ranges::find_if(text, is_letter);
  for (auto at = letter; at != text.end() && word.size() < 3; ++at) word += lower(*at);
  const bool has_name = word.size() == 3 && names.find(word) != std::string_view::npos && letter - text.begin() < 4;
  const bool is_compact = text.size() >= 14 && std::ranges::all_of(text.substr(0, 8), is_digit);
  if (!has_name && !is_compact) return std::nullopt;
  for (const char* pattern : moment_patterns) {
    if (const auto stamp = by_whole_pattern(text, pattern)) return stamp;
  }
  for (const char* pattern : date_patterns) {
    const auto read = by_pattern<date::sys_days>(text, pattern);
    if (!read || date::year_month_day(read->time).year() < date::year(100)) continue;
    const auto stamp = behind_date(Scanner(read->rest), us_per_day * read->time.time_since_epoch().count());
    if (stamp) return stamp;
  }
  return std::nullopt;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

std::string small_letters(std::string_view text) {
  std::string result(trimmed(text));
  std::ranges::transform(result, result.begin(), lower);
  return result;
}

std::optional<double> decimal_number(std::string_view text) {
  std::string with_point(text);
  if (const std::size_t comma = with_point.find(','); comma != std::string::npos) with_point[comma] = '.';
  const auto value = parse_number<double>(with_point);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> epoch_unit_us(double number) {
  const double size = std::abs(number);
  if (size < 1e8) return std::nullopt;
  return size < 1e11 ? 1e6 : size < 1e14 ? 1e3 : size < 1e17 ? 1.0 : 1e-3;  // 2001 is 1e9 s
}

std::optional<Stamp> parse_stamp(std::string_view text, Dates order) {
  text = trimmed(text);
  if (text.empty() || text.size() > 64) return std::nullopt;
  if (!is_digit(text.front()) && text.front() != '-' && text.front() != '+') return by_patterns(text);
  Scanner scan(text);
  const auto parts = date_parts(scan);
  if (!parts) {
    auto stamp = by_patterns(text);
    if (!stamp) stamp = as_time_of_day(text);
    return stamp ? stamp : as_number(text);
  }
  const auto day = midnight(*parts, order);
  const auto stamp = day ? behind_date(scan, *day) : std::nullopt;
  return stamp ? stamp : by_patterns(text);
}

std::optional<Stamp> parse_stamp(std::string_view text, Dates order, const std::string& format) {
  if (format.empty()) return parse_stamp(text, order);
  text = trimmed(text);
  return has_pattern(format) ? by_whole_pattern(text, format.c_str()) : as_number(text);
}

std::string zone_called(std::string_view name) {
  return std::ranges::find(zone_names, name, [](const auto& zone) { return zone.first; })->second;
}

std::optional<DateOrder> order_of_date(std::string_view text) {
  Scanner scan(trimmed(text));
  const auto parts = date_parts(scan);
  if (!parts || !parts->has_year_last) return std::nullopt;
  return DateOrder{order_of(*parts), order_of_year_last(*parts), parts->first, parts->third};
}

bool is_date_of_digits(std::string_view text) {
  const auto stamp = parse_stamp(std::string(trimmed(text)) + " 0:00", Dates::found);
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

}  // namespace pirsim::io
