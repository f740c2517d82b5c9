#include "io/pages/png.hpp"

#include <limits>
#include <string>
#include <utility>

#include "io/files/atomic_file.hpp"
#include "pirsim/error.hpp"

// Static, because tinygltf brings another copy.
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace pirsim::io {
namespace {

constexpr int channels = 3;

void append_chunk(void* text, void* data, int size) {
  static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

std::string to_png(int width, int height, std::span<const std::uint8_t> rgb) {
  const std::int64_t bytes = std::int64_t{width} * height * channels;
  if (width < 1 || height < 1 || bytes > std::numeric_limits<int>::max() || std::cmp_not_equal(bytes, rgb.size())) {
    throw Error(ErrorCode::usage, "the picture's width, height and pixels don't match");
  }
  std::string png;
  if (stbi_write_png_to_func(append_chunk, &png, width, height, channels, rgb.data(), width * channels) == 0) {
    throw Error(ErrorCode::internal, "the picture can't be encoded");
  }
  return png;
}

void write_png(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb) {
  write_text_file(path, to_png(width, height, rgb));
}

}  // namespace pirsim::io
