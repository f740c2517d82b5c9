// Which heights of seats a person can sit down on.
#pragma once

#include <optional>
#include <string>

#include "body/seating.hpp"

namespace pirsim::body {

/// What is wrong with the seat's height for this person, with the heights that would do; nothing if it can be sat on.
[[nodiscard]] std::optional<std::string> unfit_height(const Humanoid& humanoid, const SeatPlace& seat);

}  // namespace pirsim::body
