// What is wrong with the names of output files is told before any work is done.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/options.hpp"

namespace pirsim::app {

struct NamedOutput {
  std::string option;          ///< "--summary"
  std::filesystem::path file;  ///< empty: not asked for
  std::vector<std::string> endings;
};

/// ".csv", ".csv.gz", ".csv.zst"
[[nodiscard]] const std::vector<std::string>& table_endings();

/// Throws Error(usage) for an ending that isn't known (unless the file is there and no regular one, as /dev/stdout
/// is), for one file with two outputs, and for an output that is an input.
void check_outputs(const std::vector<NamedOutput>& outputs, const Inputs& inputs);

/// Would the file lie in that folder, however deep, or be the folder itself?
[[nodiscard]] bool is_below(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace pirsim::app
