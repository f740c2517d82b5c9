// One attempt at a flat: rooms, what stands in them, and sensors.
#pragma once

#include <variant>

#include "pirsim/flat.hpp"
#include "rooms/flat_layout.hpp"
#include "rooms/floor_plan.hpp"

namespace pirsim::dataset {

/// A flat that isn't checked yet. Sensors have their models' names, but not the models.
struct FurnishedFlat {
  DrawnFlat flat;
  Demands demands;
  Origins origins;  ///< of a plan: where its seats and places come from
};
[[nodiscard]] std::variant<FurnishedFlat, NoPlace> furnish_flat(const FlatSpec& spec, int residents, Stream& stream);

/// As somebody has it. What stands where it can't is told to faults.
[[nodiscard]] std::variant<FurnishedFlat, NoPlace> furnish_flat(const HomePlanSpec& own, const FlatPlan& plan,
                                                                Stream& stream, Diagnostics& faults);

/// Which models a sensor that hangs so may be: the spec's, or the usual one.
[[nodiscard]] const std::vector<std::string>& models_of(const FlatSpec& spec, SensorsAt at, Mount mount);

/// One in each room.
void hang_in_rooms(const FlatSpec& spec, const FlatPlan& plan, double height_m, Stream& stream, SceneSpec& scene);
/// Where a plan says; one in a corner of each room of which it says nothing.
void hang_sensors(const HomePlanSpec& own, const FlatPlan& plan, const FlatSpec& usual, Stream& stream,
                  DrawnFlat& flat);
/// One above each doorway, on the side to which no leaf turns, looking down.
void hang_at_doorways(const FlatSpec& spec, const FlatPlan& plan, Stream& stream, SceneSpec& scene);
/// Walls, floor, ceiling, entrance, doors and areas.
void build_shell(const FlatPlan& plan, double height_m, SceneSpec& scene);

}  // namespace pirsim::dataset
