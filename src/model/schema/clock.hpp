// The clock of a study: local time without daylight saving, so that every day has 24 hours.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "pirsim/error.hpp"
#include "pirsim/schedule.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

inline constexpr std::int64_t day_s = 86400;

/// Days since 1970-01-01 of "2026-03-02". Throws Error(input) for what is no date.
[[nodiscard]] std::int64_t day_number(const std::string& iso_date, const Where& where);
[[nodiscard]] bool is_working_day(std::int64_t day) noexcept;  ///< Monday to Friday
/// Hours of "08:30" or "08:30:15", up to "24:00"; none for any other text.
[[nodiscard]] std::optional<double> clock_hours(const std::string& text);
/// "8:30" of hours, up to "24:00"; after midnight it is the clock of the next day.
[[nodiscard]] std::string hours_text(double hours);
/// Seconds of "0:10:05", hours, minutes and seconds since something began; none for any other text.
[[nodiscard]] std::optional<double> elapsed_seconds(const std::string& text);
/// "2026-03-02T08:30:00" of a day and seconds into it.
[[nodiscard]] std::string clock_text(std::int64_t day, double seconds);

/// What time it is in a run.
struct RunClock {
  std::int64_t begin_s = 0;  ///< of the run, since 1970-01-01T00:00 of the same clock

  [[nodiscard]] std::int64_t begin_day() const noexcept;  ///< since 1970-01-01
  [[nodiscard]] double begin_second() const noexcept;     ///< of that day
  [[nodiscard]] std::string text(double run_s) const;     ///< "2026-03-02T08:30:00", whole seconds
  /// "08:30", with seconds and the date only where run_seconds() needs them to find the moment. run_s: whole seconds.
  [[nodiscard]] std::string shortest_text(double run_s) const;
  /// Of "06:45" and "06:45:30": the first such moment of a run that has no end. Of "2026-03-03T06:45": this one, below
  /// 0 if it is before the run. None for any other text.
  [[nodiscard]] std::optional<double> run_seconds(const std::string& text) const;
  bool operator==(const RunClock&) const = default;
};

/// Of a script's `begin`, "2026-03-02T07:00"; none for any other text.
[[nodiscard]] std::optional<RunClock> clock_from(const std::string& begin);
/// Of the trial's first replicate, by its schedule or else by the script's `begin`; none without either. Throws
/// Error(input) for a first day that is no date.
[[nodiscard]] std::optional<RunClock> clock_of(const ScriptSpec& script, const TrialSpec& trial);

/// "2026-03-02T08:30:00", or "30600 s" without a clock.
[[nodiscard]] std::string moment_text(const std::optional<RunClock>& clock, double run_s);
/// "2026-03-02T09:00:00 to 2026-03-02T09:20:00", or without a clock "0 to 1200 s".
[[nodiscard]] std::string span_text(const std::optional<RunClock>& clock, double from_s, double to_s);

// The times of day that a household has.

struct HouseholdClock {
  const char* key;  ///< the field's name, and the key in files
  ClockSpec HouseholdSpec::*clock;
};

inline constexpr std::array household_clocks{HouseholdClock{"wakes", &HouseholdSpec::wakes},
                                             HouseholdClock{"wakes_on_free_days", &HouseholdSpec::wakes_on_free_days},
                                             HouseholdClock{"goes_to_bed", &HouseholdSpec::goes_to_bed},
                                             HouseholdClock{"leaves", &HouseholdSpec::leaves},
                                             HouseholdClock{"comes_home", &HouseholdSpec::comes_home},
                                             HouseholdClock{"lunch", &HouseholdSpec::lunch},
                                             HouseholdClock{"dinner", &HouseholdSpec::dinner}};

}  // namespace pirsim
