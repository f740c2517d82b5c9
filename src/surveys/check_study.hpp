// A script for ordinary days of a room, to be run or edited.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/day_draw.hpp"

namespace pirsim::studies {

/// Staff, meetings or both; or residents.
struct OrdinaryDays {
  int staff = 0;  ///< who have a desk
  enum class Meetings { none, held } meetings = Meetings::none;
  int residents = 0;  ///< every other one goes to work
  int days = 5;
  std::string first_day = "2026-03-02";
  std::string from, to;  ///< times of day; empty: 00:00 and 24:00
  std::string cleaning;  ///< time of day, or "none"; empty: 19:00

  [[nodiscard]] bool is_office() const noexcept { return staff > 0 || meetings == Meetings::held; }
  [[nodiscard]] bool is_home() const noexcept { return residents > 0; }
};

/// The script as YAML. Nothing is checked: dates and times are put into it as they are.
[[nodiscard]] std::string script_text(const OrdinaryDays& days);

// What a schedule holds, told without running it.

/// One of the staff; times are seconds of the day.
struct ExpectedPerson {
  std::string id, seat;
  int days = 0;                                              ///< on which they come
  std::optional<double> first_arrival_s, first_departure_s;  ///< on the first of these days
  double mean_arrival_s = 0.0, mean_departure_s = 0.0, mean_present_s = 0.0;
};

struct ExpectedMeeting {
  std::int64_t day = 0;
  double begin_s = 0.0, end_s = 0.0;
  std::size_t people = 0;
  std::string area;  ///< or no text
};

/// Of the first trial's days, or its first ones.
struct ScheduleOutlook {
  std::int64_t first_day = 0;
  std::uint32_t days = 0, working_days = 0;
  std::vector<ExpectedPerson> staff;
  std::vector<ExpectedMeeting> meetings;
  std::optional<double> mean_cleaning_s;
  std::size_t most_at_once = 0;
  std::string most_when;           ///< "2026-03-02T10:15:00"
  std::vector<std::string> seats;  ///< that somebody is meant to sit on
};

/// Draws a thousand days at most, without walking. The first trial has a schedule.
[[nodiscard]] ScheduleOutlook outlook(const sim::CompiledStudy& study);

}  // namespace pirsim::studies
