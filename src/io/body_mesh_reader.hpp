// Bodies as glTF meshes, one a part. Private to io.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pirsim/script.hpp"

namespace pirsim::io::detail {

/// Reads each file once, however many people wear it.
class BodyMeshReader {
 public:
  /// folder: what file names are relative to.
  explicit BodyMeshReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The mesh of every node that has one; a node's name is its part's, a node's frame is its part's frame. Faults of
  /// the file go to `faults` with their place in it; a missing file is a fault at `where`.
  [[nodiscard]] BodyMeshes read(const std::string& file, const Where& where, Diagnostics& faults);
  [[nodiscard]] const std::vector<std::string>& files() const noexcept { return files_; }  ///< all that was read

 private:
  std::filesystem::path folder_;
  std::map<std::string, BodyMeshes> known_;
  std::vector<std::string> files_;
};

}  // namespace pirsim::io::detail
