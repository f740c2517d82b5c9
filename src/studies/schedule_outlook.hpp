// What a schedule holds, told without running it.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "sim/compiled_study.hpp"
#include "sim/day_draw.hpp"

namespace pirsim::studies {

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

/// Of one trial's days, or its first ones.
struct ScheduleOutlook {
  std::int64_t first_day = 0;
  int days = 0, working_days = 0;
  std::vector<ExpectedPerson> staff;
  std::vector<ExpectedMeeting> meetings;
  std::optional<double> mean_cleaning_s;
  std::size_t most_at_once = 0;
  std::string most_when;           ///< "2026-03-02T10:15:00"
  std::vector<std::string> seats;  ///< that somebody is meant to sit on
};

/// trial: index of one with a schedule. Draws at most so many days, without walking.
[[nodiscard]] ScheduleOutlook outlook(const sim::CompiledStudy& study, std::size_t trial, int most_days = 1000);
void print(std::ostream& out, const ScheduleOutlook& outlook, const sim::CompiledStudy& study);

}  // namespace pirsim::studies
