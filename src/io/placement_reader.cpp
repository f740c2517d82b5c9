#include "pirsim/io.hpp"

#include <set>

#include "io/coverage_keys.hpp"

namespace pirsim::io {
namespace {

Vec3 read_point(YamlMap& map, const std::string& key) {
  const std::vector<double> p = map.required_numbers(key, 3, {.min = -1e4, .max = 1e4});
  return {p[0], p[1], p[2]};
}

SensorSpec read_sensor(const YamlNode& node, std::size_t index, Diagnostics& faults) {
  YamlMap map(node, faults, "sensor");
  SensorSpec sensor;
  sensor.id = map.text("id", "PIR" + std::to_string(index + 1));
  sensor.model = map.required_text("model");
  const Vec3 position = read_point(map, "position_m");
  const double yaw_deg = map.number("yaw_deg", 0.0, {.min = -360.0, .max = 360.0});
  sensor.world_from_sensor = mounted(position, yaw_deg, map.number("tilt_deg", 20.0, {.min = -90.0, .max = 90.0}));
  map.finish();
  return sensor;
}

SensorSetSpec read_set(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "set");
  SensorSetSpec set;
  set.id = map.required_text("id");
  for (const YamlNode& sensor : map.list("sensors"))
    set.sensors.push_back(read_sensor(sensor, set.sensors.size(), faults));
  map.finish();
  return set;
}

PlacementSearchSpec read_search(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "search");
  PlacementSearchSpec search;
  search.n_sensors = map.required_integer("n_sensors", {.min = 1, .max = 20});
  search.model = map.required_text("model");
  search.evaluations = map.integer("evaluations", search.evaluations, {.min = 1, .max = 100000});
  for (const YamlNode& item : map.required_list("lines")) {
    YamlMap line(item, faults, "line");
    MountingLineSpec& spec = search.lines.emplace_back();
    spec.from = read_point(line, "from_m");
    spec.to = read_point(line, "to_m");
    spec.yaw_deg = line.number("yaw_deg", 0.0, {.min = -360.0, .max = 360.0});
    spec.tilt_deg = line.number("tilt_deg", spec.tilt_deg, {.min = -90.0, .max = 90.0});
    line.finish();
  }
  map.finish();
  return search;
}

}  // namespace

PlacementSpec read_placements(const std::filesystem::path& file, std::span<const std::string> overrides) {
  const YamlNode root = YamlNode::load(file, overrides);
  Diagnostics faults;
  YamlMap map(root, faults, "placement study");
  check_version(map, "pirsim_placements");
  PlacementSpec spec;
  spec.coverage.name = map.text("name", file.stem().string());
  read_coverage_keys(map, spec.coverage);
  std::set<std::string> ids;
  for (const YamlNode& set : map.list("sets")) {
    spec.sets.push_back(read_set(set, faults));
    if (!ids.insert(spec.sets.back().id).second)
      faults.error(set.where(), "a second set '" + spec.sets.back().id + "'");
  }
  if (const auto search = map.child("search")) spec.search = read_search(*search, faults);
  map.finish();
  faults.throw_if_errors();
  return spec;
}

}  // namespace pirsim::io
