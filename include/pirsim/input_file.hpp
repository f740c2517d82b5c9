// A file that was read, and which bytes it had then.
#pragma once

#include <string>

namespace pirsim {

/// Of the very bytes that were parsed: the file may have changed since, or be a pipe, which is read once.
struct InputFile {
  std::string path;
  std::string sha256;
};

}  // namespace pirsim
