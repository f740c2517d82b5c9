// How outputs treat their paths. Private to io.
#pragma once

#include <filesystem>

namespace pirsim::io {

/// A link is followed, so that the file that it names is replaced and not the link.
[[nodiscard]] inline std::filesystem::path resolved(const std::filesystem::path& path) {
  std::error_code fault;
  const std::filesystem::path target = std::filesystem::canonical(path, fault);
  return fault ? path : target;
}

}  // namespace pirsim::io
