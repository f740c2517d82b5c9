#include "schema/areas.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace pirsim {
namespace {

std::vector<FloorArea> outlines_of(const std::vector<AreaSpec>& areas) {
  std::vector<FloorArea> outlines;
  for (const AreaSpec& area : areas) outlines.push_back(area.outline);
  return outlines;
}

/// What is below a sensor or, of one on a wall, close before it: a border may run along the wall that it hangs on.
std::optional<std::size_t> area_before(const Frame& world_from_sensor, const std::vector<AreaSpec>& areas) {
  constexpr double first_m = 0.02, last_m = 0.5, step_m = 0.04;  // assumed: a thick wall (last: 0.3-1)
  constexpr double level = 0.1;  // assumed: a horizontal part of the axis that means a direction
  const Vec2 below = floor_point(world_from_sensor.origin), axis = floor_point(world_from_sensor.forward());
  const auto area_at = [&](const Vec2& point) -> std::optional<std::size_t> {
    const auto found = std::ranges::find_if(areas, [&](const AreaSpec& area) { return area.outline.contains(point); });
    if (found == areas.end()) return std::nullopt;
    return static_cast<std::size_t>(found - areas.begin());
  };
  if (glm::length(axis) < level) return area_at(below);
  const Vec2 direction = glm::normalize(axis);
  for (double away_m = first_m; away_m < last_m; away_m += step_m) {
    if (const auto area = area_at(below + away_m * direction)) return area;
  }
  return std::nullopt;
}

}  // namespace

Areas::Areas(const SceneSpec& scene) : parts_(scene.floor, outlines_of(scene.areas)), names_(ids_of(scene.areas)) {
  if (parts_.has_rest()) names_.emplace_back(elsewhere);
  for (const SensorSpec& sensor : scene.sensors) {
    const auto said = std::ranges::find(scene.areas, sensor.area.value_or(""), &AreaSpec::id);
    of_sensors_.push_back(said != scene.areas.end()
                              ? std::optional(static_cast<std::size_t>(said - scene.areas.begin()))
                              : area_before(sensor.world_from_sensor, scene.areas));
  }
}

std::string_view Areas::name_of_sensor(std::size_t sensor) const noexcept {
  if (empty()) return {};
  const std::optional<std::size_t> area = of_sensors_[sensor];
  return area ? std::string_view(names_[*area]) : elsewhere;
}

std::vector<std::size_t> Areas::sensors_of(std::size_t area) const {
  std::vector<std::size_t> sensors;
  for (std::size_t i = 0; i < of_sensors_.size(); ++i) {
    if (of_sensors_[i] == area) sensors.push_back(i);
  }
  return sensors;
}

}  // namespace pirsim
