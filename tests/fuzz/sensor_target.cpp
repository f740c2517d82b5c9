// Sensor models. What is accepted has zones with finite corners and ranges above zero, or pixels of a field.
#include <cmath>

#include "fuzz_target.hpp"
#include "pirsim/io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pirsim::test::read_as_file(data, size, ".yaml", [](const std::filesystem::path& file) {
    const pirsim::SensorModelSpec model = pirsim::io::read_sensor_model(file);
    if (model.array) {
      const pirsim::ArraySpec& array = *model.array;
      if (array.rows < 1 || array.columns < 1 || !(array.wide_deg > 0.0) || !(array.tall_deg > 0.0)) std::abort();
      return;
    }
    if (model.clusters.empty() || !(model.plane_m > 0.0)) std::abort();
    for (const pirsim::ClusterSpec& cluster : model.clusters) {
      if (!(cluster.range_m > 0.0) || !std::isfinite(cluster.range_m)) std::abort();
      for (const pirsim::ZoneSpec& zone : cluster.zones) {
        for (const pirsim::Vec2& corner : zone.corners) {
          if (!std::isfinite(corner.x) || !std::isfinite(corner.y)) std::abort();
        }
      }
    }
  });
}
