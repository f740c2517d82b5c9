// Pictures as PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace pirsim::io {

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< (height x width x 3), row by row from the top left, sRGB
};

/// The bytes of a PNG file; rgb as in Pixels. Throws Error(usage) if the sizes don't match.
[[nodiscard]] std::string to_png(int width, int height, std::span<const std::uint8_t> rgb);
/// Writes a PNG file, atomically; Error(io) if it can't be written, Error(usage) if the sizes don't match.
void write_png(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace pirsim::io
