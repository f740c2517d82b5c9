// The people that a schedule adds to a trial, and its calendar.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/schedule.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// What somebody of a schedule is there for.
enum class SchedulePart { staff, guest, cleaner };

struct ScheduledPerson {
  SchedulePart part = SchedulePart::staff;
  Role role = Role::staff;  ///< of staff
  std::string seat;         ///< own desk, of staff
  PersonSpec person;        ///< without actions
};

/// Staff in their order, then guests of meetings, then who cleans. Bodies are drawn from the study's seed and are the
/// same on all days. Throws Error(input) for more staff than seats, and for seats and entrances that the scene lacks.
[[nodiscard]] std::vector<ScheduledPerson> people_of(const ScheduleSpec& schedule, const SceneSpec& scene,
                                                     std::uint64_t seed);

/// Where meetings are held: the seats that are asked for, or those that are nobody's own desk.
[[nodiscard]] std::vector<std::string> meeting_seats(const MeetingsSpec& meetings, const SceneSpec& scene,
                                                     const ScheduleSpec& schedule);

/// Days since 1970-01-01 of "2026-03-02". Throws Error(input) for what is no date.
[[nodiscard]] std::int64_t day_number(const std::string& iso_date, const Where& where);
[[nodiscard]] bool is_working_day(std::int64_t day) noexcept;  ///< Monday to Friday
/// "2026-03-02T08:30:00" of a day and seconds into it.
/// Hours of "08:30" or "08:30:15", up to "24:00"; none for any other text.
[[nodiscard]] std::optional<double> clock_hours(const std::string& text);
[[nodiscard]] std::string clock_text(std::int64_t day, double seconds);

}  // namespace pirsim
