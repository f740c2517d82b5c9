#include "files/write/frame_writer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "model/core/random.hpp"
#include "model/core/text.hpp"

namespace pirsim::io {

std::string file_part(const std::string& name, std::string_view also) {
  constexpr std::string_view digits = "0123456789ABCDEF", reserved = "/\\%:*?\"<>|";  // of one system or another
  constexpr std::size_t longest = 100, n_digits = 16;  // a file's whole name may have 255 bytes
  std::string part;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_reserved = reserved.find(c) != std::string_view::npos || also.find(c) != std::string_view::npos;
    const bool is_kept = byte > ' ' && byte != 127 && !is_reserved;
    part += is_kept ? std::string(1, c) : std::string{'%', digits[byte >> 4U], digits[byte & 15U]};
  }
  return part.size() <= longest ? part : part.substr(0, longest) + "%." + sha256(name).substr(0, n_digits);
}

std::string frame_file(const std::string& array, const std::string& trial, int replicate) {
  return file_part(array, "_") + '_' + file_part(trial) + '_' + std::to_string(replicate) + ".npy";
}

std::string to_npy(const FrameStack& frames) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(frames.times_s.size()) +
                       ", " + std::to_string(frames.rows) + ", " + std::to_string(frames.columns) + "), }";
  constexpr std::size_t preamble = 10, alignment = 64;  // before the header; of the data
  header.append(alignment - 1 - (preamble + header.size()) % alignment, ' ') += '\n';
  std::string bytes = "\x93NUMPY";
  const auto add = [&](std::uint32_t value, int n_bytes) {
    for (int i = 0; i < n_bytes; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
  };
  add(1, 2);
  add(static_cast<std::uint32_t>(header.size()), 2);
  bytes += header;
  bytes.reserve(bytes.size() + 4 * frames.celsius.size());
  for (const float value : frames.celsius) add(std::bit_cast<std::uint32_t>(value), 4);
  return bytes;
}

std::string frame_to_csv(const FrameStack& frames, double time_s) {
  const auto n_read = std::ranges::upper_bound(frames.times_s, time_s) - frames.times_s.begin();
  std::string text;
  if (n_read == 0) return text;
  const auto columns = static_cast<std::size_t>(frames.columns);
  const std::size_t first = static_cast<std::size_t>(n_read - 1) * static_cast<std::size_t>(frames.rows) * columns;
  for (std::size_t i = 0; i < static_cast<std::size_t>(frames.rows) * columns; ++i) {
    const float value = frames.celsius[first + i];
    text += std::isnan(value) ? "" : fixed(static_cast<double>(value), 2);
    text += (i + 1) % columns == 0 ? '\n' : ',';
  }
  return text;
}

}  // namespace pirsim::io
