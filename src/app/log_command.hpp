// A log as an input of commands that count people.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "pirsim/log.hpp"

namespace pirsim::app {

struct LogInputs {
  std::vector<std::filesystem::path> files;
  std::filesystem::path map;
  std::string time_zone;
};

/// --log, --map and --time-zone.
void offer_log(CLI::App& command, LogInputs& log);
/// As the user typed it: a command with these words reads the same.
[[nodiscard]] std::vector<std::string> words_of(const LogInputs& log);
/// Tells what is odd about it.
[[nodiscard]] Log read_log(const LogInputs& log, Verbosity verbosity);

}  // namespace pirsim::app
