// The shipped lenses, and each as if its file had been drawn by somebody who held it otherwise.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "pirsim/geometry.hpp"
#include "pirsim/io.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace pirsim::test {

/// Of the drawing: by quarters to the left, then perhaps mirrored left to right.
struct Turn {
  int quarters = 0;
  int mirror = 1;  ///< -1: mirrored
};
inline constexpr std::array all_turns{Turn{1, 1}, Turn{2, 1}, Turn{3, 1}, Turn{0, -1}, Turn{1, -1}};
inline std::string name(const Turn& turn) {
  return "turned by " + std::to_string(90 * turn.quarters) + " degrees" + (turn.mirror < 0 ? " and mirrored" : "");
}
inline Vec2 turned(Vec2 p, const Turn& turn) {
  for (int i = 0; i < turn.quarters; ++i) p = {-p.y, p.x};
  return {turn.mirror * p.x, p.y};
}
/// Of the same zones, elsewhere.
inline SensorModelSpec turned(SensorModelSpec model, const Turn& turn) {
  for (ClusterSpec& cluster : model.clusters) {
    cluster.centre = turned(cluster.centre, turn);
    for (ZoneSpec& zone : cluster.zones) {
      for (Vec2& corner : zone.corners) corner = turned(corner, turn);
    }
  }
  return model;
}

inline std::vector<std::string> shipped_lenses() {
  std::vector<std::string> ids;
  for (const auto& entry : std::filesystem::directory_iterator(data_dir() / "sensors")) {
    if (entry.path().extension() != ".yaml") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    const bool has_lens = text.str().find("\nkind:") == std::string::npos;  // no array, and no beam
    if (has_lens) ids.push_back(entry.path().stem().string());
  }
  std::ranges::sort(ids);
  return ids;
}

/// From a file whose facets are so turned (their zones are then laid anew by the facets' law), or of the zones of a
/// file that writes them out.
inline SensorModelSpec read_turned(const std::string& id, const Turn& turn) {
  const std::filesystem::path path = data_dir() / "sensors" / (id + ".yaml");
  std::ifstream file(path);
  std::ostringstream text;
  bool any = false;
  for (std::string line; std::getline(file, line); text << line << '\n') {
    const auto x_at = line.find("{x_m: "), y_at = line.find(", y_m: ");
    if (x_at == std::string::npos || y_at == std::string::npos) continue;
    const auto end = line.find_first_of(",}", y_at + 7);
    const Vec2 to = turned(Vec2(std::stod(line.substr(x_at + 6)), std::stod(line.substr(y_at + 7))), turn);
    std::ostringstream facet;
    facet.precision(17);
    facet << line.substr(0, x_at) << "{x_m: " << to.x << ", y_m: " << to.y << line.substr(end);
    line = facet.str();
    any = true;
  }
  if (!any) return turned(io::read_sensor_model(path), turn);
  const TemporaryFolder folder;
  const std::filesystem::path copy = folder.path() / (id + ".yaml");
  std::ofstream(copy) << text.str();
  return io::read_sensor_model(copy);
}

}  // namespace pirsim::test
