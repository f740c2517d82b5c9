#include "pirsim/io.hpp"

#include "io/coverage_keys.hpp"
#include "io/yaml_map.hpp"

namespace pirsim::io {

NuisanceSpec read_nuisance(const std::filesystem::path& file) {
  const YamlNode root = YamlNode::load(file, {});
  Diagnostics faults;
  YamlMap map(root, faults, "nuisance");
  check_version(map, "pirsim_nuisance");
  NuisanceSpec spec;
  spec.seat_position_m = map.number("seat_position_m", spec.seat_position_m, {.min = 0.0, .max = 0.2});
  spec.sensor_yaw_deg = map.number("sensor_yaw_deg", spec.sensor_yaw_deg, {.min = 0.0, .max = 10.0});
  spec.sensor_tilt_deg = map.number("sensor_tilt_deg", spec.sensor_tilt_deg, {.min = 0.0, .max = 10.0});
  spec.body_size = map.number("body_size", spec.body_size, {.min = 0.0, .max = 0.2});
  spec.arm_amplitude = map.number("arm_amplitude", spec.arm_amplitude, {.min = 0.0, .max = 0.5});
  map.finish();
  faults.throw_if_errors();
  return spec;
}

}  // namespace pirsim::io
