#include "io/text_input.hpp"

#include <array>
#include <fstream>

#include "pirsim/error.hpp"

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
  // In blocks, since most files are small; one byte more than allowed, so that endless devices end too.
  std::string text;
  std::array<char, 1U << 16U> block;
  while (text.size() <= max_text_file_bytes && file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw Error(ErrorCode::io, where, "can't be read");
  if (text.size() > max_text_file_bytes) throw Error(ErrorCode::input, where, "larger than 16 MB");
  return text;
}

}  // namespace pirsim::io
