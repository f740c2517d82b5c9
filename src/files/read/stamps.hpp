// What a text says about time: of a log's rows, a script's tables and options.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "pirsim/dates.hpp"

namespace pirsim::io {

inline constexpr std::int64_t us_per_ms = 1'000, us_per_s = 1'000'000, us_per_day = 86'400 * us_per_s;

/// To a multiple of b, which is above 0.
[[nodiscard]] inline std::int64_t rounded_down(std::int64_t a, std::int64_t b) { return a - ((a % b) + b) % b; }

// What a text says about time.

[[nodiscard]] inline char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
/// Without the spaces around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// In small letters, without the spaces around it.
[[nodiscard]] std::string small_letters(std::string_view text);
/// A finite number, also with a decimal comma; none of any other text.
[[nodiscard]] std::optional<double> decimal_number(std::string_view text);
/// Microseconds of the unit in which a number of this size counts from 1970: seconds, milli-, micro- or nanoseconds.
/// None of one that is too small to count from there.
[[nodiscard]] std::optional<double> epoch_unit_us(double number);

struct Stamp {
  enum class Kind {
    number,       ///< of seconds or parts of them, since something
    time_of_day,  ///< microseconds since midnight
    date,         ///< its midnight
    local,        ///< date and time as clocks on the wall show them
    absolute      ///< with an offset from UTC
  };
  Kind kind = Kind::number;
  std::int64_t us = 0;        ///< since 1970-01-01T00:00: UTC if absolute, else of the local clock
  std::int32_t offset_s = 0;  ///< of an absolute one: so much is local time ahead
  double number = 0.0;
  std::string_view zone_name{};  ///< "CET", of a local one: says which zone it may be, but not its summer time
};

/// ISO 8601, what spreadsheets make of it, and JavaScript's local times: "2025-04-06T18:00:01.5Z", "2025/04/06 18:00",
/// "12/22/2017 10:49:41 AM", "5/24/2019, 7:50:03 PM", "20190524 19:50:03", "0:00:34", "1743962401"; with names of
/// months "25-Feb-2008 00:20:14", "March 02, 2026 at 03:28:42 PM"; none for any other text. `order` counts where the
/// year has two digits or comes last; months come first if neither it nor the numbers say otherwise. Days that don't
/// exist, as 2025-02-30, are none.
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text, Dates order);
/// By strptime's pattern, "%d.%m.%Y %H.%M"; all of it. Empty: as above; a pattern without % is a number's.
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text, Dates order, const std::string& format);
/// "Europe/Berlin" of "CET", as an example.
[[nodiscard]] std::string zone_called(std::string_view name);

/// What a text with a date tells of the order of dates; none: it has no date, or one that begins with a year of four
/// digits.
struct DateOrder {
  Dates order = Dates::found;      ///< found: it leaves that open
  Dates year_last = Dates::found;  ///< the same, if the year is known to be last
  int first = 0, last = 0;         ///< its numbers
};
[[nodiscard]] std::optional<DateOrder> order_of_date(std::string_view text);

/// "20260514": eight digits that are a date.
[[nodiscard]] bool is_date_of_digits(std::string_view text);
/// "AM", "p.m."
[[nodiscard]] bool is_half_of_day(std::string_view text);
/// "UTC", "Z", "+0200", "-05:30": but not "+02".
[[nodiscard]] bool is_offset(std::string_view text);

}  // namespace pirsim::io
