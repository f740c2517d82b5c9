// What error to expect: each room is calibrated and counted as if it were the real one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pirsim/calibrate.hpp"

namespace pirsim::calibrate {

/// (rooms) mean absolute errors of a counter made of the other rooms' models, weighed by the room's own log, or alike.
struct RoomErrors {
  std::vector<std::optional<double>> weighed, alike;
};
[[nodiscard]] RoomErrors errors_of_rooms(const counting::Counter& counter,
                                         std::span<const counting::LabelledRoom> rooms, unsigned threads);

/// Of the errors by weight: mean and interval.
void expect_error(const RoomErrors& errors, std::span<const double> weights, Calibration& made);

/// Readings that a score counts: from half an hour before the first person to half an hour after the last.
[[nodiscard]] std::vector<bool> in_use(const std::vector<int>& people, double step_s);

}  // namespace pirsim::calibrate
