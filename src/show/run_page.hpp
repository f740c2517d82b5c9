// A page that plays one run: room and people in 3D, what the sensors see, and their rows as a time line. One HTML file
// that works without a network; three.js, which draws it, is built in (docs/formats/view.md).
#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "files/write/gltf_writer.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::io {

struct PagePlace {
  std::string name;
  Vec3 position{0.0};
};

struct PageArea {
  std::string name;
  Vec3 position{0.0};  ///< of the name
  std::vector<std::vector<Vec2>> loops;
};

struct PageSensor {
  std::string id;
  std::string model;
  Frame world_from_sensor;
  std::uint32_t first_zone = 0;          ///< zones are numbered over all sensors
  std::vector<std::uint32_t> zone_rays;  ///< (n_zones) beams of each zone, in the order of the glTF's lines
  std::vector<double> signal_v;          ///< (n_keys) of an analog sensor, else empty
  double positive_v = 0.0;               ///< thresholds of an analog sensor, above and below its offset
  double negative_v = 0.0;
};

struct PageArray {
  std::string id;
  std::string model;
  Frame world_from_sensor;
  int rows = 0, columns = 0;
  std::vector<std::vector<float>> celsius;  ///< (n_frames x rows * columns)
  std::vector<std::uint32_t> at_key;        ///< (n_keys) which of them
};

/// Squares of the floor and how often each sensor sees a moving target there.
struct PageMap {
  std::string name;
  Vec2 lower{0.0};  ///< corner with the least x and z
  double height_m = 0.0;
  double spacing_m = 1.0;
  std::size_t n_columns = 0, n_rows = 0;    ///< along x and z
  std::vector<std::vector<double>> shares;  ///< (n_sensors x n_rows * n_columns) in [0, 1]; negative off the floor
};

struct RunPage {
  std::string title;
  std::string about;  ///< trial, replicate, scene, script
  std::string made_by;
  std::string first_person;  ///< whose phase the rows tell; empty: of a schedule, nobody's
  double run_s = 0.0;        ///< of the whole run, of which the page shows a part
  double window_s = 1.0;
  ExportedRun run;  ///< beams of every sensor, in the order of `sensors`
  std::vector<PageSensor> sensors;
  std::vector<PageArray> arrays;
  std::vector<PagePlace> seats;
  std::vector<PagePlace> doors;
  std::vector<PageArea> areas;
  std::vector<std::string> counted;                      ///< whose people the rows count: areas, and the rest
  std::vector<std::vector<std::uint32_t>> active_zones;  ///< (n_keys)
  std::vector<Sample> rows;                              ///< from the first key to the last
  std::optional<PageMap> map;                            ///< of the same sensors
};

/// Throws as to_glb() does.
void write_run_page(std::ostream& out, const RunPage& page);

}  // namespace pirsim::io
