// Pictures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace pirsim::io {

/// rgb: (height x width x 3), row by row from the top left, 8 bits a channel as sRGB. Atomically; Error(io) if it
/// can't be written, Error(usage) if the sizes don't match.
void write_png(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace pirsim::io
