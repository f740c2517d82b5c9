#include "io/text_input.hpp"

#include <fstream>

#include "pirsim/core/error.hpp"

namespace pirsim::io {

std::string read_text_file(const std::filesystem::path& path) {
  const Where where{path.string(), 0, 0};
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw Error(ErrorCode::io, where, "is a directory");
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const bool exists = std::filesystem::exists(path, ignored);
    throw Error(ErrorCode::io, where, exists ? "can't be read" : "no such file");
  }
  std::string text(max_text_file_bytes + 1, '\0');  // one more than allowed, so that endless devices end too
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw Error(ErrorCode::io, where, "can't be read");
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > max_text_file_bytes) throw Error(ErrorCode::input, where, "larger than 16 MB");
  return text;
}

}  // namespace pirsim::io
