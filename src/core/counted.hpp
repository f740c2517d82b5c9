// Numbers of things in sentences.
#pragma once

#include <cstddef>
#include <string>

namespace pirsim {

/// "1 seat", "5 seats"; plural: where it isn't the name and an s.
[[nodiscard]] inline std::string counted(std::size_t n, const std::string& name, const std::string& plural = {}) {
  return std::to_string(n) + ' ' + (n == 1 ? name : plural.empty() ? name + 's' : plural);
}

}  // namespace pirsim
