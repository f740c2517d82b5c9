#include "model/schema/clock.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "model/core/text.hpp"
#include "model/schema/check_script.hpp"

namespace pirsim {
namespace {

/// Of digits and nothing else, as many as there may be.
std::optional<int> whole_number(std::string_view digits, std::size_t fewest, std::size_t most) {
  if (digits.size() < fewest || digits.size() > most) return std::nullopt;
  if (digits.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  int value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

std::optional<std::int64_t> days_of(std::string_view date) {
  if (date.size() != 10 || date[4] != '-' || date[7] != '-') return std::nullopt;
  const auto year = whole_number(date.substr(0, 4), 4, 4), month = whole_number(date.substr(5, 2), 2, 2),
             day = whole_number(date.substr(8), 2, 2);
  if (!year || !month || !day) return std::nullopt;
  const std::chrono::year_month_day found{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                          std::chrono::day(static_cast<unsigned>(*day))};
  if (!found.ok()) return std::nullopt;
  return std::chrono::sys_days(found).time_since_epoch().count();
}

struct HoursAndMinutes {
  int hours = 0, minutes = 0;
  std::optional<int> seconds;  ///< where they are said
  [[nodiscard]] int in_seconds() const { return 3600 * hours + 60 * minutes + seconds.value_or(0); }
};

/// "8:30", "08:30" or "08:30:15".
std::optional<HoursAndMinutes> hours_and_minutes(std::string_view text) {
  constexpr std::size_t most_digits = 4;  // of hours; more than a run may last
  const std::size_t first = std::min(text.find(':'), text.size());
  const std::size_t second = std::min(text.find(':', first + 1), text.size());
  if (first == text.size()) return std::nullopt;
  const auto hours = whole_number(text.substr(0, first), 1, most_digits);
  const auto minutes = whole_number(text.substr(first + 1, second - first - 1), 2, 2);
  if (!hours || !minutes || *minutes >= 60) return std::nullopt;
  if (second == text.size()) return HoursAndMinutes{*hours, *minutes, {}};
  const auto seconds = whole_number(text.substr(second + 1), 2, 2);
  if (!seconds || *seconds >= 60) return std::nullopt;
  return HoursAndMinutes{*hours, *minutes, seconds};
}

/// Up to 24:00.
std::optional<HoursAndMinutes> time_of_day(std::string_view text) {
  const auto time = hours_and_minutes(text);
  return time && time->in_seconds() <= day_s ? time : std::nullopt;
}

/// Seconds since 1970-01-01T00:00 of "2026-03-02T08:30".
std::optional<std::int64_t> moment_of(std::string_view text) {
  constexpr std::size_t date_length = 10;
  if (text.size() <= date_length || (text[date_length] != 'T' && text[date_length] != ' ')) return std::nullopt;
  const auto day = days_of(text.substr(0, date_length));
  const auto time = time_of_day(text.substr(date_length + 1));
  if (!day || !time) return std::nullopt;
  return day_s * *day + time->in_seconds();
}

}  // namespace

std::int64_t day_number(const std::string& iso_date, const Where& where) {
  if (const auto day = days_of(iso_date)) return *day;
  throw Error(ErrorCode::input, where, "'" + iso_date + "' is no date: expected year-month-day, e.g. 2026-03-02");
}

bool is_working_day(std::int64_t day) noexcept {
  const std::chrono::weekday weekday{std::chrono::sys_days(std::chrono::days(day))};
  return weekday != std::chrono::Saturday && weekday != std::chrono::Sunday;
}

std::optional<double> clock_hours(const std::string& text) {
  const auto time = time_of_day(text);
  if (!time) return std::nullopt;
  return time->hours + time->minutes / 60.0 + time->seconds.value_or(0) / 3600.0;
}

std::string hours_text(double hours) {
  constexpr long day = 24L * 60L;
  const long minutes = std::lround(60.0 * hours), of_day = minutes > day ? minutes % day : minutes;
  return std::to_string(of_day / 60) + (of_day % 60 < 10 ? ":0" : ":") + std::to_string(of_day % 60);
}

std::optional<double> elapsed_seconds(const std::string& text) {
  const auto time = hours_and_minutes(text);
  return time && time->seconds ? std::optional<double>(time->in_seconds()) : std::nullopt;
}

std::string clock_text(std::int64_t day, double seconds) {
  const auto whole = static_cast<std::int64_t>(std::floor(seconds + 1e-9));
  const std::int64_t in_day = (whole % day_s + day_s) % day_s;  // before the day, too
  const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(day + (whole - in_day) / day_s))};
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), static_cast<int>(in_day / 3600),
                static_cast<int>(in_day / 60 % 60), static_cast<int>(in_day % 60));
  return text.data();
}

std::int64_t RunClock::begin_day() const noexcept { return (begin_s - (begin_s % day_s + day_s) % day_s) / day_s; }

double RunClock::begin_second() const noexcept { return static_cast<double>(begin_s - day_s * begin_day()); }

std::string RunClock::text(double run_s) const { return clock_text(begin_day(), begin_second() + run_s); }

std::string RunClock::shortest_text(double run_s) const {
  constexpr std::size_t time_at = 11, to_minutes = 16;
  std::string whole = text(run_s);
  if (whole.ends_with(":00")) whole.resize(to_minutes);
  const std::string time = whole.substr(time_at);
  return run_seconds(time) == run_s ? time : whole;
}

std::optional<double> RunClock::run_seconds(const std::string& text) const {
  if (const auto moment = moment_of(text)) return static_cast<double>(*moment - begin_s);
  const auto time = time_of_day(text);
  if (!time) return std::nullopt;
  const double today_s = time->in_seconds() - begin_second();
  return today_s < 0.0 ? today_s + day_s : today_s;
}

std::optional<RunClock> clock_from(const std::string& begin) {
  const auto moment = moment_of(begin);
  return moment ? std::optional(RunClock{*moment}) : std::nullopt;
}

std::optional<RunClock> clock_of(const ScriptSpec& script, const TrialSpec& trial) {
  if (trial.occupancy) return runs_of(*trial.occupancy, script.begin).clock;
  if (!trial.schedule) return clock_from(script.begin);
  const std::int64_t day = day_number(trial.schedule->first_day, trial.schedule->where);
  return RunClock{day_s * day + std::llround(3600.0 * trial.schedule->from_h)};  // times are whole minutes
}

std::string moment_text(const std::optional<RunClock>& clock, double run_s) {
  if (clock) return clock->text(run_s);
  return shortest_number(run_s) + " s";
}

std::string span_text(const std::optional<RunClock>& clock, double from_s, double to_s) {
  if (clock) return clock->text(from_s) + " to " + clock->text(to_s);
  return shortest_number(from_s) + " to " + shortest_number(to_s) + " s";
}

}  // namespace pirsim
