#include "io/png.hpp"

#include <limits>
#include <ostream>
#include <utility>

#include "io/atomic_file.hpp"
#include "pirsim/error.hpp"

// Static, because tinygltf brings another copy.
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace pirsim::io {
namespace {

constexpr int channels = 3;

void write_chunk(void* stream, void* data, int size) {
  static_cast<std::ostream*>(stream)->write(static_cast<const char*>(data), size);
}

}  // namespace

void write_png(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb) {
  const std::int64_t bytes = std::int64_t{width} * height * channels;
  if (width < 1 || height < 1 || bytes > std::numeric_limits<int>::max() || std::cmp_not_equal(bytes, rgb.size())) {
    throw Error(ErrorCode::usage, Where{path.string()}, "the picture's width, height and pixels don't match");
  }
  AtomicFile file(path);
  if (stbi_write_png_to_func(write_chunk, &file.stream(), width, height, channels, rgb.data(), width * channels) == 0) {
    throw Error(ErrorCode::io, Where{path.string()}, "the picture can't be encoded");
  }
  file.commit();
}

}  // namespace pirsim::io
