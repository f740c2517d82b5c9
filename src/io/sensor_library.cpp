#include "pirsim/io.hpp"

#include "io/sensor_lookup.hpp"

namespace pirsim::io {

SensorModelSpec find_sensor_model(const std::string& model, const std::filesystem::path& scene_file,
                                  const SceneOptions& options) {
  const auto folders = detail::sensor_directories(options, scene_file.parent_path());
  const std::filesystem::path file = detail::find_sensor_file(model, folders);
  if (file.empty()) {
    throw Error(ErrorCode::input,
                "no sensor model '" + model + "'" + did_you_mean(model, detail::available_sensor_models(folders)));
  }
  return read_sensor_model(file);
}

}  // namespace pirsim::io
