// Logs from texts.
#pragma once

#include <string>
#include <vector>

#include "pirsim/log.hpp"
#include "support/temporary_folder.hpp"

/// A log of one file.
inline pirsim::Log read_log_text(const std::string& text, const pirsim::LogMap& map = {}) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("log.csv", text);
  return pirsim::io::read_log({&file, 1}, map);
}

inline std::vector<std::string> sensors_of(const pirsim::Log& log) {
  std::vector<std::string> names;
  for (const pirsim::LogTrack& track : log.sensors) names.push_back(track.name);
  return names;
}

/// Its windows, an entry a sensor: "0", "1", and "." where nothing is known.
inline std::vector<std::string> windows_of(const pirsim::Log& log, double window_s) {
  const pirsim::LogRows rows = pirsim::LogWindows(log, window_s).rows();
  std::vector<std::string> texts(rows.sensors.size());
  for (std::size_t i = 0; i < rows.n_windows(); ++i) {
    for (std::size_t sensor = 0; sensor < texts.size(); ++sensor) texts[sensor] += "01."[rows.at(i, sensor)];
  }
  return texts;
}
