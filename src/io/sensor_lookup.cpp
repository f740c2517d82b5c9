#include "io/sensor_lookup.hpp"

#include <cstdlib>
#include <set>

namespace pirsim::io::detail {

namespace fs = std::filesystem;

std::vector<fs::path> sensor_directories(const SceneOptions& options, const fs::path& scene_folder) {
  std::vector<fs::path> result = options.sensor_directories;
  result.push_back(scene_folder / "sensors");
  result.push_back(scene_folder / ".." / "sensors");
  if (const char* data = std::getenv("PIRSIM_DATA_DIR"); data != nullptr && *data != '\0') {
    result.push_back(fs::path(data) / "sensors");
  }
  for (const fs::path& data : options.data_directories) result.push_back(data / "sensors");
#ifdef PIRSIM_INSTALLED_DATA_DIR
  result.push_back(fs::path(PIRSIM_INSTALLED_DATA_DIR) / "sensors");
#endif
  return result;
}

fs::path find_sensor_file(const std::string& model, const std::vector<fs::path>& directories) {
  for (const fs::path& directory : directories) {
    std::error_code fault;
    if (const fs::path file = directory / (model + ".yaml"); fs::is_regular_file(file, fault)) return file;
  }
  return {};
}

std::vector<std::string> available_sensor_models(const std::vector<fs::path>& directories) {
  std::set<std::string> names;
  for (const fs::path& directory : directories) {
    std::error_code fault;
    for (fs::directory_iterator entry(directory, fault), end; !fault && entry != end; entry.increment(fault)) {
      if (entry->path().extension() == ".yaml") names.insert(entry->path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace pirsim::io::detail
