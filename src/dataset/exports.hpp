// A room-day in the shapes that other tools read.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/script.hpp"
#include "pirsim/study.hpp"

namespace pirsim::dataset {

/// 30 s of rows: motion in any of them, and the people at their end.
struct Reading {
  std::string clock;  ///< of its end
  int people = 0;
  std::vector<int> people_of_areas;  ///< (n_areas) as a Sample's
  std::vector<std::uint8_t> bits;
  [[nodiscard]] bool any() const;
};
/// None if 30 s aren't a whole number of rows.
[[nodiscard]] std::optional<int> rows_per_reading(const SensingSpec& sensing);
[[nodiscard]] std::vector<Reading> readings(std::span<const Sample> rows, int rows_per_reading);

/// Shaped like UCI's Room Occupancy Estimation (864): Date,Time,<sensor>_PIR,...,Room_Occupancy_Count, and
/// <area>_Occupancy_Count of each area.
[[nodiscard]] std::string to_uci864(std::span<const Reading> readings, const std::vector<std::string>& sensors,
                                    const std::vector<std::string>& areas);
/// As io::CasasWriter has it.
[[nodiscard]] std::string to_casas(const RunResult& run, const std::vector<std::string>& sensors,
                                   const std::vector<std::string>& doors);

/// Hours of a day: share of the hour with anybody there, people on average.
struct DayProfile {
  std::array<double, 24> presence{}, people{};
};
struct RoomProfile {
  std::string room;
  /// (7) from Monday on: the days of this weekday that were simulated, in order.
  std::array<std::vector<DayProfile>, 7> weekdays;
};
/// For EnergyPlus' Schedule:File: a line of headings, then 8760 hours from 1 January of `year` (29 February left out),
/// columns `<room>_presence` and `<room>_people`. Each date takes the simulated days of its weekday by turns; a weekday
/// that wasn't simulated takes those of the other days of its kind, working or weekend, or is empty.
[[nodiscard]] std::string to_energyplus(std::span<const RoomProfile> rooms, int year);

}  // namespace pirsim::dataset
