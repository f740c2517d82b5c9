// Sets of sensors to compare, and where a better set may be looked for, as plain data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pirsim/schema/coverage_spec.hpp"
#include "pirsim/schema/scene_spec.hpp"

namespace pirsim {

struct SensorSetSpec {
  std::string id;
  std::vector<SensorSpec> sensors;  ///< none: those of the scene
};

/// A straight line on a wall or the ceiling on which sensors may hang, all facing alike.
struct MountingLineSpec {
  Vec3 from{0.0}, to{0.0};
  double yaw_deg = 0.0;    ///< 0 facing -Z, positive turning left
  double tilt_deg = 20.0;  ///< downwards
};

struct PlacementSearchSpec {
  int n_sensors = 1;
  std::string model;
  std::vector<MountingLineSpec> lines;
  int evaluations = 200;  ///< sensor sets that are tried
};

struct PlacementSpec {
  CoverageSpec coverage;  ///< by which sets are judged
  std::vector<SensorSetSpec> sets;
  std::optional<PlacementSearchSpec> search;
};

/// World frame of a sensor that looks along a heading, tilted down.
[[nodiscard]] Frame mounted(const Vec3& position, double yaw_deg, double tilt_deg);

}  // namespace pirsim
