// One attempt at a parametric room: everything is drawn and put where there is space for it, or the attempt fails.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "dataset/floor_plan.hpp"
#include "dataset/usable_scene.hpp"

namespace pirsim::dataset {

/// Which models a sensor of the group may be: its own, or the usual one for where it hangs.
[[nodiscard]] const std::vector<std::string>& models_of(const SensorGroupSpec& group);
/// A room that isn't checked yet. Sensors have their models' names, but not the models.
[[nodiscard]] std::variant<DrawnRoom, NoPlace> furnish(const RoomSpec& spec, Stream& stream);

}  // namespace pirsim::dataset
